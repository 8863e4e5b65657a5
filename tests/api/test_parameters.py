"""Reading of parameters: the query, a JSON body, and both together."""

import json
from typing import Annotated

import pytest
from fastapi import APIRouter, FastAPI, Query, Request
from fastapi.testclient import TestClient
from rocking_api.http.errors import add_handlers
from rocking_api.http.parameters import ParamsRoute, check_json, query_parameters, read_json
from rocking_api.models.answer import Answer
from rocking_api.models.params import Params

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError
from rocking._numba.cancellation import StopFlag
from tests.api.conftest import assert_problem


class Window(Params):
    low: float
    high: float = 2.0
    open: bool = False


class WindowBody(Window):
    points: list[float]


class Found(Answer):
    values: list[str]


@pytest.fixture(scope="module")
def client():
    router = APIRouter(route_class=ParamsRoute)

    @router.get("/items/{name}")
    async def get_item(name: str, service: object) -> Found:
        return Found(values=[name, service])

    @router.get("/window")
    async def get_window(params: Annotated[Window, Query()], request: Request) -> Found:
        return Found(values=[str(params.low), str(params.high), request.method])

    @router.post("/window")
    async def post_window(request: Request) -> Found:
        body = await request.body()
        found = read_json(WindowBody, body, query_parameters(request), Window, StopFlag())
        return Found(values=[str(found.low)])

    app = FastAPI()
    app.state.service = "the service"
    app.include_router(router)
    add_handlers(app)
    return TestClient(app)


def test_path_parameters_and_service_become_arguments(client):
    assert client.get("/items/a").json()["values"] == ["a", "the service"]


def test_a_model_takes_all_query_parameters(client):
    assert client.get("/window?low=1").json()["values"] == ["1.0", "2.0", "GET"]
    assert_problem(client.get("/window?low=1&width=3"), 422, "width")
    assert_problem(client.get("/window"), 422, "low")
    assert assert_problem(client.get("/window?low=a"), 422, "low")["value"] == "a"


def test_a_parameter_that_is_given_twice_is_refused(client):
    problem = assert_problem(client.get("/window?low=1&low=2"), 422, "low")
    assert problem["value"] == "1 and 2"


def test_the_response_has_a_tag_by_which_it_is_revalidated(client):
    first = client.get("/window?low=1")
    again = client.get("/window?low=1", headers={"If-None-Match": first.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")


def read(body, **query):
    return read_json(WindowBody, json.dumps(body).encode(), query, Window, StopFlag())


def test_a_body_and_the_query_hold_the_same_fields():
    whole = {"low": 1.5, "high": 3.0, "open": True, "points": [1.0]}
    expected = WindowBody(**whole)
    assert read(whole) == expected
    assert read({"points": [1.0]}, low="1.5", high="3", open="true") == expected
    assert read({"points": [1.0], "low": 1.5}, high="3.0", open="1") == expected
    assert read(whole, low="1.50", open="yes") == expected  # the same values


@pytest.mark.parametrize(("name", "text"), [("low", "1.6"), ("high", "2.0"), ("open", "false")])
def test_two_values_of_a_parameter_are_refused(name, text):
    with pytest.raises(InvalidArgumentError, match=f"`{name}` = .* in the query and .* in the body.*one value"):
        read({"low": 1.5, "high": 3.0, "open": True, "points": []}, **{name: text})


@pytest.mark.parametrize(
    ("body", "key", "line"),
    [
        (b'{"low": 1, "points": [1.0], "low": 1}', "low", 1),
        (b'{"low": 1,\n "points": [1.0],\n "\\u006cow" : 2}', "low", 3),
        (b'{"low": 1, "points": [], "a\\"b": {"points": "}"}, "a\\"b": 2}', 'a"b', 1),
        (b'[{"low": 1}, {"low": 1, "high": {"x": [{"y": 1, "y": 1}]}}]', "y", 1),
        (b'{"": 1, "": 1}', "", 1),
    ],
)
def test_two_values_of_one_key_are_refused(body, key, line):
    with pytest.raises(InvalidArgumentError) as raised:
        check_json(body, StopFlag())
    assert raised.value.parameter == key
    assert raised.value.value.endswith(f"in line {line}")
    if body[:1] == b"{" and key == "low":
        with pytest.raises(InvalidArgumentError, match="`low` = 'two values"):
            read_json(WindowBody, body, {}, Window, StopFlag())


def test_a_key_of_several_objects_is_no_repetition():
    check_json(b'{"a": {"a": "\\"a\\":", "b": [{"a": 1}, {"a": 1}]}, "b": "a", "c": ["a", "a"]}', StopFlag())


def test_malformed_json_is_400_with_its_place(client):
    for body, place in (('{"low": 1,\n "high" 2}', "line 2 column 9"), ("", "line 1 column 0"), ("[1, 2", "line 1")):
        problem = assert_problem(client.post("/window", content=body), 400, "body")
        assert place in problem["value"]
        assert problem["type"] == "/problems#malformed-json"


def test_a_route_without_parameters_refuses_them(client):
    problem = assert_problem(client.get("/items/a?page=2"), 422, "page")
    assert problem["allowed"] == "none, in the query"


def test_the_query_holds_no_content_and_nothing_unknown():
    for name in ("points", "width"):
        with pytest.raises(InvalidArgumentError, match=f"`{name}`.*one of low, high, open, in the query"):
            read({"low": 1.0, "points": [1.0]}, **{name: "1"})
    for body in ([], None, 3, {"points": [1.0]}, {"low": 1, "points": "a"}):
        for query in ({}, {"high": "3"}):
            with pytest.raises(SeveralArgumentsError):
                read(body, **query)
