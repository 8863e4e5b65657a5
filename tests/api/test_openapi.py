"""The OpenAPI description: every property is described, and every example succeeds and has the answer described."""

import re

import pytest

from tests.api.conftest import JSON, POINT, examples_of, health_of, parts_of, texts
from tests.sampling import sample

VARIABLE = re.compile(r"^(coordinates|variables|dimensions)\.[^.]+")
"""What the description of a data set holds by the name of a variable or dimension."""


@pytest.fixture(scope="module")
def description(client):
    return client.get("/openapi.json").json()


def operations(description):
    for path, methods in description["paths"].items():
        for method, operation in methods.items():
            yield path, method, operation


def test_every_property_and_parameter_is_described(description):
    missing = [
        f"{name}.{key}"
        for name, model in description["components"]["schemas"].items()
        for key, value in model.get("properties", {}).items()
        if not value.get("description")
    ]
    for path, _, operation in operations(description):
        assert operation["summary"], path
        missing += [
            f"{path} {parameter['name']}"
            for parameter in operation.get("parameters", [])
            if not (parameter.get("description") or parameter["schema"].get("description"))
        ]
    assert missing == []


def test_every_list_of_a_request_has_a_limit(description):
    schemas, seen = description["components"]["schemas"], set()
    bodies = [one["requestBody"]["content"] for *_, one in operations(description) if "requestBody" in one]
    media = [one["schema"] for content in bodies for one in content.values()]
    lists = [one for schema in media for one in parts_of(schema, schemas, seen) if one.get("type") == "array"]
    assert len(lists) > 10
    assert [one for one in lists if "maxItems" not in one] == []


def test_every_answer_states_its_model_or_where_it_is_stated(client, description):
    unsolved = {
        "/v1/pulses",
        "/v1/metadata",
        "/v1/suites",
        "/v1/datasets",
        "/v1/datasets/{name}",
        "/v1/records/preview",
    }
    for path, _, operation in operations(description):
        schema = operation["responses"]["200"].get("content", {}).get(JSON, {}).get("schema")
        if path.startswith("/v1/") and path not in unsolved and schema:
            for model in schema.get("anyOf", [schema]):
                named = description["components"]["schemas"][model["$ref"].rpartition("/")[2]]["properties"]
                assert len({"metadata", "metadata_url"} & set(named)) == 1, path
    for answer in (client.get("/v1/response", params=POINT).json(), client.post("/v1/response", json=POINT).json()):
        stated = client.get(answer["metadata_url"]).json()
        assert stated["equations"][0]["number"] == "2.1"
        assert stated["disclaimer"]


@pytest.fixture(scope="module")
def asked(client, description):
    """Each example of the description and its response."""
    health_of(client)
    return [
        (one, client.request(one.method, one.url, params=texts(one.query), **sent(one)))
        for one in examples_of(description)
    ]


def sent(one):
    return {"content": one.body, "headers": {"content-type": one.media_type}} if one.media_type else {}


def test_every_example_succeeds_as_it_stands(asked):
    failed = [(one.path, one.body, found.text[:300]) for one, found in asked if found.status_code != 200]
    assert failed == []
    assert len(asked) > 20


def numbers(value, path=()):
    """Paths of the numbers in an answer."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from numbers(part, (*path, key))
    elif isinstance(value, list):
        for part in value:
            yield from numbers(part, path)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield ".".join(path)


def fields(schemas, schema, path=()):
    """Paths of the fields that a schema describes."""
    schema = schemas[schema["$ref"].rpartition("/")[2]] if "$ref" in schema else schema
    for name, part in schema.get("properties", {}).items():
        yield ".".join((*path, name))
        yield from fields(schemas, part, (*path, name))
    for part in (*schema.get("anyOf", ()), schema.get("items"), schema.get("additionalProperties")):
        if isinstance(part, dict):
            yield from fields(schemas, part, path)


def test_every_json_answer_holds_question_units_warnings_version_and_address(client, description, asked):
    schemas = description["components"]["schemas"]
    tried, repeated = set(), [one for one, _ in sample(asked, 9)]
    for one, response in asked:
        path, query = one.path, one.query
        schema = one.operation["responses"]["200"].get("content", {}).get(JSON, {}).get("schema")
        if schema is None or response.headers["content-type"] != JSON:
            continue
        answer = response.json()
        assert answer["query"] | query == answer["query"], path
        assert isinstance(answer["warnings"], list), path
        assert answer["version"] == description["info"]["version"], path
        method, _, url = answer["url"].rpartition(" ")
        if one in repeated:
            assert client.request(method or "GET", url, **sent(one)).json() == answer, path
        found = {VARIABLE.sub(r"\1", name) for name in numbers(answer) if not re.search(r"\battributes\.", name)}
        assert found <= set(answer["units"]), path
        assert set(answer["units"]) <= found | set(fields(schemas, schema)), path
        assert all(answer["units"].values()), path
        tried.add((method or "GET", path))
    assert tried == {
        (method.upper(), path)
        for path, method, operation in operations(description)
        if operation["responses"]["200"].get("content", {}).get(JSON, {}).get("schema")
    }
