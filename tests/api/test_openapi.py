"""The OpenAPI description: every property is described, and every example succeeds and has the answer described."""

import json
import re
from collections.abc import Iterator
from typing import Annotated
from urllib.parse import quote

import pytest
import rocking_api.app  # and with it all models
from pydantic import TypeAdapter, ValidationError
from rocking_api.models.params import Params

from tests.api.conftest import health_of

JSON = "application/json"

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

    def lists(schema, place):
        if (name := schema.get("$ref", "").rpartition("/")[2]) and name not in seen:
            seen.add(name)
            yield from lists(schemas[name], name)
        if schema.get("type") == "array":
            yield place, schema.get("maxItems")
        for part in (*schema.get("anyOf", ()), *schema.get("oneOf", ()), *schema.get("prefixItems", ())):
            yield from lists(part, place)
        for key, part in (("items", schema.get("items")), *schema.get("properties", {}).items()):
            if isinstance(part, dict):
                yield from lists(part, f"{place}.{key}")

    bodies = [one["requestBody"]["content"] for *_, one in operations(description) if "requestBody" in one]
    found = [one for content in bodies for media in content.values() for one in lists(media["schema"], "body")]
    assert len(found) > 10
    assert [place for place, most in found if most is None] == []


def test_every_answer_states_its_model_or_where_it_is_stated(client, description):
    lists = {"/v1/pulses", "/v1/metadata", "/v1/suites", "/v1/datasets", "/v1/datasets/{name}"}
    found = {}
    for path, _, operation in operations(description):
        schema = operation["responses"]["200"].get("content", {}).get(JSON, {}).get("schema")
        if path.startswith("/v1/") and path not in lists and schema:
            for model in schema.get("anyOf", [schema]):
                named = description["components"]["schemas"][model["$ref"].rpartition("/")[2]]["properties"]
                found.setdefault(tuple(sorted({"metadata", "metadata_url"} & set(named))), set()).add(path)
    assert set(found) == {("metadata",), ("metadata_url",)}
    assert found[("metadata",)] == {
        path for path in description["paths"] if path.startswith(("/v1/blocks", "/v1/records"))
    } | {"/v1/suites/{name}"}
    point = {"pulse": "sine", "slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85}
    answers = [client.get("/v1/response", params=point).json(), client.post("/v1/response", json=point).json()]
    for answer in answers:
        stated = client.get(answer["metadata_url"]).json()
        assert [one["number"] for one in stated["equations"]] == ["2.1", "2.2", "2.3", "2.4", "3.1"]
        assert stated["disclaimer"]


def example_of(parameter):
    """What a documentation page fills in: the example, the default, or the first of the allowed values."""
    schema = parameter["schema"]
    for examples in (parameter.get("examples"), schema.get("examples")):
        if examples:
            return examples[0] if isinstance(examples, list) else next(iter(examples.values()))["value"]
    if schema.get("default") is not None:
        return schema["default"]
    return schema["enum"][0] if parameter.get("required") and "enum" in schema else None


@pytest.fixture(scope="module")
def asked(client, description):
    """Each example of the description: path, operation, query, arguments of the request, and its response."""
    health_of(client)
    found = []
    for path, method, operation in operations(description):
        url, query = path, {}
        for parameter in operation.get("parameters", []):
            value = example_of(parameter)
            assert value is not None or not parameter["required"], f"{path}: {parameter['name']} has no example"
            if parameter["in"] == "path":
                url = url.replace(f"{{{parameter['name']}}}", quote(value, safe="/."))
            elif value is not None:
                query[parameter["name"]] = value
        bodies = operation.get("requestBody", {}).get("content", {None: {}})
        for media_type, body in bodies.items():
            if media_type and body.get("schema", {}).get("format") == "binary":
                continue
            sent = {}
            if media_type:
                assert "example" in body, f"{path}: {media_type} has no example"
                content = body["example"] if media_type != JSON else json.dumps(body["example"])
                sent = {"content": content, "headers": {"content-type": media_type}}
            texts = {name: str(value).lower() if isinstance(value, bool) else value for name, value in query.items()}
            found.append((path, operation, query, sent, client.request(method, url, params=texts, **sent)))
    return found


def test_every_example_succeeds_as_it_stands(asked):
    failed = [(path, sent, found.text[:300]) for path, _, _, sent, found in asked if found.status_code != 200]
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
    tried = set()
    for path, operation, query, sent, response in asked:
        schema = operation["responses"]["200"].get("content", {}).get(JSON, {}).get("schema")
        if schema is None or response.headers["content-type"] != JSON:
            continue
        answer = response.json()
        assert answer["query"] | query == answer["query"], path
        assert isinstance(answer["warnings"], list), path
        assert answer["version"] == description["info"]["version"], path
        method, _, url = answer["url"].rpartition(" ")
        assert client.request(method or "GET", url, **sent).json() == answer, path
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


def kinds_of(kind: type[Params]) -> Iterator[type[Params]]:
    for one in kind.__subclasses__():
        yield one
        yield from kinds_of(one)


def test_every_range_that_a_schema_states_is_checked():
    """Nested alternatives hide a range from the checks: `Scale | None` once did."""
    assert rocking_api.app
    stated = 0
    for kind in {*kinds_of(Params)}:
        for name, field in kind.model_json_schema()["properties"].items():
            if re.search(r'"(exclusiveM|m)(in|ax)imum"', json.dumps(field)):
                stated += 1
                declared = kind.model_fields[name]
                bad = 1e300 if '"maximum"' in json.dumps(field) else -1e300
                with pytest.raises(ValidationError):
                    TypeAdapter(Annotated[declared.annotation, declared]).validate_python(bad)
    assert stated > 100
