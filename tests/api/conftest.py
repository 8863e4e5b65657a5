"""A small results folder, and the service over it."""

import json
import shutil
import time
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote, urlencode

import numpy as np
import pytest
from fastapi.testclient import TestClient
from prometheus_client.parser import text_string_to_metric_families
from rocking_api.app import create_app
from rocking_api.settings import EXAMPLE, Settings

import rocking
from rocking._boundary.tracing import overturning_boundary
from rocking._datasets.cube import AXES, describe, scalar_coordinates, write_dataset
from rocking._datasets.zarr_store import write_pulse_store
from rocking._spectra.cubes import spectrum
from rocking.suites.fragility import fragility_of_outcomes
from rocking.suites.margins import with_margins
from rocking.suites.outcomes import check_suite, suite_outcomes
from rocking.suites.sensitivity import suite_sensitivity
from tests.suites.motions import noise

CUBES = {("sine", 0.85), ("cosine", 0.90)}
NAMES = {f"spectra/{pulse}/eta-{eta:.2f}" for pulse, eta in CUBES} | {
    "overturning/sine/eta-0.85",
    *(f"suites/demonstration/{name}" for name in ("fragility", "outcomes", "sensitivity")),
}  # fmt: skip
"""Names of the data sets in the results."""


HISTORY = "python -m tests.api.conftest"  # the attribute of the files

JSON, CSV, NC = "application/json", "text/csv", "application/x-netcdf"

NAPA = Path(__file__).parents[2] / "workflow/motions/napa_HNE.csv"
"""A record of the workflow."""


POINT = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}
BLOCK = {"pulse": "sine", "width": 0.4, "height": 1.6, "peak_acceleration": 4.0, "period": 0.5}


def of_point(*left_out, **more):
    """The parameters of the point but some, and others."""
    return {name: value for name, value in POINT.items() if name not in left_out} | more


QUERIES = {
    "/v1/response": POINT,
    "/v1/blocks/response": BLOCK | {"method": "solver"},
    "/v1/thresholds": of_point("slenderness"),
    "/v1/spectrum": of_point("frequency_ratio", points=20),
    "/v1/history": of_point(samples=20, duration=9.0),
    "/v1/overturning": of_point("slenderness", "frequency_ratio"),
    "/v1/map": of_point("slenderness", "frequency_ratio", columns=3, rows=3),
}
"""An ordinary query of each route that computes the response to a pulse."""


@pytest.fixture(scope="session")
def results(once):
    """Two cubes, one set of boundary curves, and a suite of four made-up records, as the workflow writes them."""
    return once("results", make_results)


def make_results(folder, cubes=CUBES, nodes=91, suite_name="demonstration", title="Fragility under noise"):
    """Write the results; `python -m tests.api.conftest` those that an installation serves where it has no others."""
    for pulse, eta in cubes:
        cube = spectrum(
            pulse,
            restitution=eta,
            slenderness=np.linspace(0.05, 0.95, nodes),
            frequency_ratio=np.geomspace(0.5, 12.0, nodes),
        )
        write_dataset(cube, folder / "spectra" / pulse / f"eta-{eta:.2f}.nc")
    for pulse in {pulse for pulse, _ in cubes} - {"cosine"}:
        write_pulse_store(sorted((folder / "spectra" / pulse).glob("eta-*.nc")), folder / "zarr" / f"{pulse}.zarr")
    curves = overturning_boundary("sine", restitution=0.85, nodes=101)
    curves["alpha"] = "curve", np.zeros(curves.sizes["curve"]), AXES["alpha"]
    curves = curves.drop_attrs(deep=False).assign_coords(scalar_coordinates("sine", 0.85))
    about = {"title": "Boundary curves of overturning under the sine", "history": HISTORY}
    write_dataset(describe(curves, **about), folder / "overturning" / "sine" / "eta-0.85.nc")
    motions, blocks = [noise(seed) for seed in range(4)], [rocking.Block(0.5, 2.0), rocking.Block(0.8, 4.0)]
    suite = check_suite(motions, blocks, np.geomspace(1.0, 40.0, 12), "pga", "momentum")
    outcomes = with_margins(suite_outcomes(suite), suite)
    fragility = fragility_of_outcomes(outcomes, ["overturning", 0.5])
    fragility = fragility.assign_attrs(confidence=0.95)
    sensitivity = suite_sensitivity(motions, blocks, intensity=[4.0, 9.0])
    for name, dataset in (("outcomes", outcomes), ("fragility", fragility), ("sensitivity", sensitivity)):
        about = {"title": title, "history": HISTORY}
        write_dataset(describe(dataset, **about), folder / "suites" / suite_name / f"{name}.nc")


@pytest.fixture(scope="session")
def client(results):
    """A client of the service over the results; internal exceptions become responses."""
    with TestClient(create_app(Settings(results=results)), raise_server_exceptions=False) as client:
        yield client


@pytest.fixture
def own_results(results, tmp_path):
    """A copy of the results that a test may change."""
    return shutil.copytree(results, tmp_path / "results")


def until(condition, seconds=20):
    """Wait for what another thread does."""
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.01)
    assert condition()


def client_of(results, **settings):
    """A client of another service."""
    return TestClient(create_app(Settings(results=results, **settings)), raise_server_exceptions=False)


def health_of(client):
    """The response of /health once every data set was checked."""
    deadline = time.monotonic() + 30
    while (health := client.get("/health").json())["unchecked"] and time.monotonic() < deadline:
        time.sleep(0.01)
    return health


def post(client, route, content, media_type=JSON, **query):
    """The response to a body; the route may have a query of its own."""
    address = f"{route}{'&' if '?' in route else '?'}{urlencode(query)}"
    return client.post(address, content=content, headers={"content-type": media_type})


def metrics_of(client):
    """Samples by name and labels."""
    text = client.get("/metrics").text
    return {
        (sample.name, *sorted(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def assert_problem(response, status, parameter=None):
    """Assert a problem+json response with status, parameter and allowed values."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert problem["status"] == status
    assert problem["title"]
    assert problem["detail"]
    if parameter is not None:
        assert problem["parameter"] == parameter
        assert problem["allowed"]
    return problem


def parts_of(schema, schemas, seen=None):
    """Yield a schema of the description and all within it, also those that it names, once."""
    seen = set() if seen is None else seen
    name = schema.get("$ref", "").rpartition("/")[2] if isinstance(schema, dict) else ""
    if name and name not in seen:
        seen.add(name)
        yield from parts_of(schemas[name], schemas, seen)
    if isinstance(schema, dict):
        yield schema
    for one in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        yield from parts_of(one, schemas, seen)


class Example(NamedTuple):
    """An example of the description of the service."""

    path: str
    operation: dict
    method: str
    url: str
    query: dict
    media_type: str | None
    body: str


def examples_of(description):
    """Yield all of them: of a parameter what a page fills in, of a body each of its types."""
    for path, methods in description["paths"].items():
        for method, operation in methods.items():
            url, query = path, {}
            for parameter in operation.get("parameters", []):
                value, name = example_of(parameter), parameter["name"]
                assert value is not None or not parameter["required"], f"{path}: {name} has no example"
                if parameter["in"] == "path":
                    url = url.replace(f"{{{name}}}", quote(value, safe="/."))
                elif value is not None:
                    query[name] = value
            for media_type, body in operation.get("requestBody", {}).get("content", {None: {"example": ""}}).items():
                if body.get("schema", {}).get("format") != "binary":
                    example = body["example"] if "example" in body else example_of_model(body["schema"], description)
                    content = json.dumps(example) if media_type == JSON else example
                    beside = {} if media_type == JSON else query  # JSON holds all parameters
                    yield Example(path, operation, method.upper(), url, beside, media_type, content)


def example_of_model(schema, description):
    """What a page fills in for a body of a model: the examples of its required fields."""
    model = description["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    pulse = {"acceleration": [0.0, 1.0, 0.0], "name": "triangle"}
    required = {name: model["properties"][name] for name in model["required"] if name != "pulse"}
    return {"pulse": pulse} | {name: part["examples"][0] for name, part in required.items()}


def texts(query):
    """The values of a query as they are in an address."""
    return {name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in query.items()}


def example_of(parameter):
    """The example, the default, or the first of the allowed values."""
    schema = parameter["schema"]
    for examples in (parameter.get("examples"), schema.get("examples")):
        if examples:
            return examples[0] if isinstance(examples, list) else next(iter(examples.values()))["value"]
    if schema.get("default") not in (None, []):  # an empty list is no parameter
        return schema["default"]
    return schema["enum"][0] if parameter.get("required") and "enum" in schema else None


if __name__ == "__main__":
    shutil.rmtree(EXAMPLE)
    make_results(EXAMPLE, [("cosine", 0.90)], 31, "example", "Example: two blocks under four made-up records")
