"""Random parameters of every GET route: an answer or a refusal, never a fault of the service."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rocking_api.app import create_app
from rocking_api.settings import Settings

from tests.api.conftest import client_of, health_of, parts_of, texts, until
from tests.sampling import number

DESCRIPTION = create_app(Settings()).openapi()
ROUTES = sorted(path for path, methods in DESCRIPTION["paths"].items() if "get" in methods)
REFUSALS = {404, 413, 422, 504}
ODD = ["", "nan", "-inf", "1e999", "0", "-0.0", "9" * 400, "1 m", "null", "[]", "\0", "\ud7ff", "é" * 300]
NAMED = {"points", "name"}  # of limits and of paths
NAMES = ["spectra/sine/eta-0.85", "overturning/sine/eta-0.85", "demonstration", "sine", "../..", ".zmetadata"]


@pytest.fixture(scope="module")
def limited(results):
    """A client of a service that gives up early."""
    with client_of(results, max_seconds=2.0, max_samples=2000, max_points=20_000) as client:
        until(lambda: client.get("/ready").status_code == 200, 200)  # the kernels are compiled
        yield client


def values_of(parameter):
    """Values of a parameter as a strategy: of its schema, near it and odd ones."""
    if parameter["in"] == "path":
        return st.sampled_from(NAMES)
    found = [st.sampled_from(ODD)]
    for schema in parts_of(parameter["schema"], DESCRIPTION["components"]["schemas"]):
        found += [st.sampled_from(schema[key]) for key in ("enum", "examples") if schema.get(key)]
        if schema.get("type") == "integer":
            found.append(st.integers(-3, 300))
        if schema.get("type") == "number":
            found += [st.floats(0.01, 10.0), st.floats()]
        if schema.get("type") == "boolean":
            found.append(st.booleans())
    return st.one_of(found[::-1])


def requests(path):
    """Addresses and queries of a route; of optional parameters some are left out."""
    parameters = DESCRIPTION["paths"][path]["get"].get("parameters", [])
    required = {one["name"]: values_of(one) for one in parameters if one["required"]}
    optional = {one["name"]: values_of(one) for one in parameters if not one["required"]}
    return st.fixed_dictionaries(required, optional=optional)


@pytest.mark.parametrize("path", ROUTES)
def test_random_parameters_are_answered_or_refused(limited, path):
    described = DESCRIPTION["paths"][path]["get"].get("parameters", [])
    parameters = {one["name"] for one in described}
    in_path = {one["name"] for one in described if one["in"] == "path"}

    @settings(max_examples=number(20, 300))
    @given(requests(path))
    def ask(values):
        address = path.format(**{name.partition(":")[0]: values[name] for name in in_path})
        query = texts({name: value for name, value in values.items() if name not in in_path})
        response = limited.get(address, params=query)
        assert response.status_code == 200 or response.status_code in REFUSALS, (address, query, response.text)
        if response.status_code != 200:
            problem = json.loads(response.content)
            assert problem["status"] == response.status_code
            assert problem["detail"]
            named = [one["name"] for one in problem.get("errors", ())] or [problem.get("parameter", "name")]
            assert {name.partition("[")[0] for name in named} <= {*values, *parameters, *NAMED}, problem

    ask()
    assert health_of(limited)["status"] == "ok"
