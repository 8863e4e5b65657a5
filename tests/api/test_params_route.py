"""The route class: dependencies, query and path parameters."""

from typing import Annotated

import pytest
from fastapi import APIRouter, Depends, FastAPI, Query, Request
from fastapi.testclient import TestClient
from rocking_api.http.errors import add_handlers
from rocking_api.http.params_route import ParamsRoute
from rocking_api.models.answer import Answer
from rocking_api.models.params import Params

from tests.api.conftest import assert_problem


class Window(Params):
    low: float
    high: float = 2.0


class Found(Answer):
    values: list[str]


async def user(request: Request) -> str:
    return request.headers["x-user"]


async def greeting(name: Annotated[str, Depends(user)], word: str = "hello") -> str:
    return f"{word} {name}"


@pytest.fixture(scope="module")
def client():
    router = APIRouter(route_class=ParamsRoute)

    @router.get("/items/{name}/{count}")
    async def get_item(
        name: str,
        count: int,
        text: Annotated[str, Depends(greeting)],
        version: Annotated[str | None, Query()] = None,
    ) -> Found:
        return Found(values=[name, str(count + 1), text, str(version)])

    @router.get("/window")
    async def get_window(window: Annotated[Window, Query()], request: Request) -> Found:
        return Found(values=[str(window.low), str(window.high), request.method])

    app = FastAPI()
    app.include_router(router)
    add_handlers(app)
    return TestClient(app)


def test_dependencies_query_and_path_parameters_become_arguments(client):
    found = client.get("/items/a/1?version=2&word=good+day", headers={"X-User": "b"}).json()["values"]
    assert found == ["a", "2", "good day b", "2"]
    found = client.get("/items/a/1", headers={"X-User": "b"}).json()["values"]
    assert found == ["a", "2", "hello b", "None"]


def test_a_model_takes_all_query_parameters(client):
    assert client.get("/window?low=1").json()["values"] == ["1.0", "2.0", "GET"]
    assert_problem(client.get("/window?low=1&width=3"), 422, "width")
    assert_problem(client.get("/window"), 422, "low")


def test_a_value_of_the_wrong_type_is_named(client):
    problem = assert_problem(client.get("/items/a/b", headers={"X-User": "b"}), 422, "count")
    assert problem["value"] == "b"


def test_a_parameter_that_is_given_twice_is_refused(client):
    problem = assert_problem(client.get("/window?low=1&low=2"), 422, "low")
    assert problem["value"] == "1 and 2"


def test_the_response_has_a_tag_by_which_it_is_revalidated(client):
    first = client.get("/window?low=1")
    again = client.get("/window?low=1", headers={"If-None-Match": first.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")
