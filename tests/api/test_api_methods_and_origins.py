"""Methods and origins of requests for one block."""

import pytest

from tests.api.conftest import assert_problem, client_of

POINT = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}


@pytest.mark.parametrize("method", ["HEAD", "PUT", "DELETE", "OPTIONS"])
def test_other_methods_are_refused_as_everywhere(client, method):
    response = client.request(method, "/v1/response", params=POINT)
    assert response.status_code == 405
    assert response.headers["allow"] == "GET, POST"


@pytest.mark.parametrize(
    ("path", "allowed"),
    [
        ("/objects", "GET, POST"),
        ("/object", "GET, POST"),
        ("/health", "GET, HEAD"),
        ("/v1/suites/demonstration", "GET"),
        ("/v1/datasets/spectra/sine/eta-0.85", "GET"),
        ("/v1/datasets/spectra/sine/eta-0.85.nc", "GET, HEAD"),
        ("/v1/datasets/spectra/sine/eta-0.85.zarr/.zgroup", "GET, HEAD"),
        ("/static/docs.js", "GET, HEAD"),
    ],
)
def test_all_methods_of_a_path_are_named(client, path, allowed):
    response = client.put(path)
    assert_problem(response, 405)
    assert response.headers["allow"] == allowed


def test_other_origins_may_read_the_answer_if_they_are_allowed(client, results):
    closed = client.get("/health", headers={"Origin": "https://a.example"})
    assert "access-control-allow-origin" not in closed.headers
    with client_of(results, cors_origins=("https://a.example",)) as client:
        response = client.get("/v1/response", params=POINT, headers={"Origin": "https://a.example"})
        refused = client.get("/v1/response", headers={"Origin": "https://a.example"})
    assert response.headers["access-control-allow-origin"] == "https://a.example"
    assert "ETag" in response.headers["access-control-expose-headers"]
    assert_problem(refused, 422)
    assert refused.headers["access-control-allow-origin"] == "https://a.example"


def test_an_unknown_path_is_answered_without_the_description_of_all_routes(results):
    """It takes a second to make."""
    with client_of(results) as client:
        assert_problem(client.get("/v1/nothing"), 404)
        assert client.app.openapi_schema is None
        assert client.delete("/v1/response").headers["allow"] == "GET, POST"
        assert client.app.openapi_schema is None
