"""The OpenAPI description: every property is described, and every example succeeds as it stands."""

import json
from urllib.parse import quote

import pytest

JSON = "application/json"


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


def test_every_schema_that_is_referred_to_exists(description):
    text = json.dumps(description)
    names = {part.split('"')[0] for part in text.split("#/components/schemas/")[1:]}
    assert names <= set(description["components"]["schemas"])


def test_the_service_names_its_license_contact_and_server(description):
    info = description["info"]
    assert info["license"] == {"name": "BSD-3-Clause", "identifier": "BSD-3-Clause"}
    assert info["contact"]["name"]
    assert description["servers"][0]["url"] == "/"


def test_every_answer_states_its_model_or_where_it_is_stated(client, description):
    lists = {"/v1/pulses", "/v1/metadata", "/v1/suites", "/v1/datasets", "/v1/datasets/{name}"}
    found = {}
    for path, _, operation in operations(description):
        schema = operation["responses"]["200"].get("content", {}).get(JSON, {}).get("schema")
        if path.startswith("/v1/") and path not in lists and schema:
            for one in schema.get("anyOf", [schema]):
                fields = description["components"]["schemas"][one["$ref"].rpartition("/")[2]]["properties"]
                found.setdefault(tuple(sorted({"metadata", "metadata_url"} & set(fields))), set()).add(path)
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


def test_every_example_succeeds_as_it_stands(client, description):
    failed, tried = [], 0
    for path, method, operation in operations(description):
        query = {}
        for parameter in operation.get("parameters", []):
            value = example_of(parameter)
            assert value is not None or not parameter["required"], f"{path}: {parameter['name']} has no example"
            if parameter["in"] == "path":
                path = path.replace(f"{{{parameter['name']}}}", quote(value, safe="/."))  # noqa: PLW2901
            elif value is not None:
                query[parameter["name"]] = str(value).lower() if isinstance(value, bool) else value
        bodies = operation.get("requestBody", {}).get("content", {None: {}})
        for media_type, body in bodies.items():
            if media_type and body.get("schema", {}).get("format") == "binary":
                continue
            content = None
            if media_type:
                assert "example" in body, f"{path}: {media_type} has no example"
                content = body["example"] if media_type != JSON else json.dumps(body["example"])
            headers = {"content-type": media_type} if media_type else {}
            response = client.request(method, path, params=query, content=content, headers=headers)
            tried += 1
            if response.status_code != 200:
                failed.append((path, media_type, response.text[:300]))
    assert failed == []
    assert tried > 20
