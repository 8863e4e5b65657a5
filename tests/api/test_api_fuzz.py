"""Random requests: no 5xx, and every response as described."""

import asyncio
import os

import hypothesis
import pytest
from hypothesis import HealthCheck, given, settings
from rocking_api.app import create_app
from rocking_api.settings import Settings

from tests.api.fuzzer import ask_all
from tests.sampling import number, sample

CASES = number(120, 5500)
SEED = os.environ.get("FUZZ_SEED")

# All routes but the tracing of curves, which takes seconds for each new restitution.
OPERATIONS = [
    ("/v1/response", "GET"),
    ("/v1/response", "POST"),
    ("/v1/thresholds", "GET"),
    ("/v1/spectrum", "GET"),
    ("/v1/map", "GET"),
    ("/v1/history", "GET"),
    ("/v1/blocks/response", "GET"),
    ("/v1/datasets", "GET"),
    ("/v1/datasets/{name}", "GET"),
    ("/v1/datasets/{name}.nc", "GET"),
    ("/v1/datasets/{name}.zarr/{key}", "GET"),
    ("/health", "GET"),
    ("/metrics", "GET"),
]


# Bodies of text, which the schema does not describe further; `fuzzer.py` sends better ones.
BODIES = [("/v1/blocks/response", "POST"), *((f"/v1/records/{name}", "POST") for name in ("response", "history"))]


@pytest.fixture(scope="module")
def schema(results):
    """The description of one service for all routes."""
    import schemathesis  # noqa: PLC0415  (takes two seconds in each process that collects this file)

    return schemathesis.openapi.from_asgi("/openapi.json", create_app(Settings(results=results, max_samples=2000)))


@pytest.mark.slow
@pytest.mark.parametrize(("path", "method"), sample([*OPERATIONS, *BODIES], 3))
def test_generated_requests(schema, path, method):
    from schemathesis.checks import not_a_server_error  # noqa: PLC0415
    from schemathesis.specs.openapi.checks import (  # noqa: PLC0415
        content_type_conformance,
        response_schema_conformance,
        status_code_conformance,
    )

    checks = [not_a_server_error, content_type_conformance, response_schema_conformance, status_code_conformance]

    # state, counts and catalogue take no parameters: nothing to generate
    share = 2 if path in ("/health", "/metrics", "/v1/datasets") else CASES // (len(OPERATIONS) - 3) + 1

    @settings(max_examples=share, suppress_health_check=list(HealthCheck), derandomize=SEED is None)
    @given(case=schema[path][method].as_strategy())
    def check_case(case):
        case.call_and_validate(checks=checks, timeout=100)  # more than the time limit of the service

    if SEED is not None:
        check_case = hypothesis.seed(int(SEED))(check_case)
    check_case()


@pytest.mark.alone
@pytest.mark.slow
def test_random_requests(results):
    statuses, faults = asyncio.run(ask_all(results, seed=2, first=0, count=number(250, 9000)))
    assert not faults
    assert {"200", "304", "404", "405", "413", "415", "422"} <= set(statuses)
