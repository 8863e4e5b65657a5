"""Requests for one block bypass the router of FastAPI, with the same response."""

import pytest
from rocking_api.http.params_route import FastPath

from tests.api.conftest import assert_problem, client_of

POINT = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}
QUESTIONS = [POINT, POINT | {"slenderness": 1.5}, POINT | {"slenderness": -1}, POINT | {"slendernes": 1}, {}]
QUESTIONS += [POINT | {"pulse": "sinus"}, POINT | {"method": "cube", "frequency_ratio": 40}]


@pytest.fixture(scope="module")
def usual(results):
    """The service without the fast path."""
    client = client_of(results)
    client.app.outer_layers = [layer for layer in client.app.outer_layers if layer.cls is not FastPath]
    with client:
        yield client


@pytest.mark.parametrize("query", QUESTIONS)
def test_the_fast_path_has_the_same_response(client, usual, query):
    short, long = (one.get("/v1/response", params=query) for one in (client, usual))
    assert (short.status_code, short.content) == (long.status_code, long.content)
    assert {**short.headers, "x-request-id": ""} == {**long.headers, "x-request-id": ""}


def test_the_router_is_not_called_for_one_block(client, monkeypatch):
    monkeypatch.setattr(type(client.app.router), "__call__", lambda *_: 1 / 0)
    assert client.get("/v1/response", params=POINT).status_code == 200
    assert client.get("/health").status_code == 500


@pytest.mark.parametrize("method", ["HEAD", "PUT", "DELETE", "OPTIONS"])
def test_other_methods_are_refused_as_everywhere(client, method):
    response = client.request(method, "/v1/response", params=POINT)
    assert response.status_code == 405
    assert response.headers["allow"] == "GET, POST"


def test_other_origins_may_read_the_answer_if_they_are_allowed(results):
    with client_of(results, cors_origins=("https://a.example",)) as client:
        response = client.get("/v1/response", params=POINT, headers={"Origin": "https://a.example"})
        refused = client.get("/v1/response", headers={"Origin": "https://a.example"})
    assert response.headers["access-control-allow-origin"] == "https://a.example"
    assert "ETag" in response.headers["access-control-expose-headers"]
    assert_problem(refused, 422)
    assert refused.headers["access-control-allow-origin"] == "https://a.example"
