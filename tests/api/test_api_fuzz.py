"""Random requests: no 5xx, and every response as described; extreme numbers, in a process of its own with 2 GB."""

import asyncio
import subprocess
import sys
from pathlib import Path

import hypothesis
import pytest
from hypothesis import HealthCheck, given, settings
from rocking_api.app import create_app
from rocking_api.settings import Settings

from tests.api.fuzzer import ask_all
from tests.sampling import ALL, SEED, number, sample


@pytest.mark.slow
def test_generated_requests(results):
    import schemathesis  # noqa: PLC0415  (takes two seconds in each process that collects this file)
    from schemathesis.checks import not_a_server_error  # noqa: PLC0415
    from schemathesis.specs.openapi.checks import (  # noqa: PLC0415
        content_type_conformance,
        response_schema_conformance,
        status_code_conformance,
    )

    checks = [not_a_server_error, content_type_conformance, response_schema_conformance, status_code_conformance]
    app = create_app(Settings(results=results, max_samples=2000))
    schema = schemathesis.openapi.from_asgi("/openapi.json", app)
    operations = [
        (path, method.upper(), one) for path, all_ in app.openapi()["paths"].items() for method, one in all_.items()
    ]
    for path, method, operation in sample(operations, 3):
        if path == "/v1/overturning":
            continue  # each new restitution is traced for seconds
        share = number(12, 500) if operation.get("parameters") or "requestBody" in operation else 2

        @settings(max_examples=share, suppress_health_check=list(HealthCheck))
        @given(case=schema[path][method].as_strategy())
        def check_case(case):
            case.call_and_validate(checks=checks, timeout=100)  # more than the time limit of the service

        hypothesis.seed(SEED if ALL else 1)(check_case)()


@pytest.mark.alone
@pytest.mark.slow
def test_random_requests(results):
    statuses, faults = asyncio.run(ask_all(results, seed=2, first=0, count=number(250, 9000)))
    assert not faults
    assert {"200", "304", "404", "405", "413", "415", "422"} <= set(statuses)


ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="limits the memory of a process as Linux does")
@pytest.mark.parametrize("part", number(["all"], ["python", "commands"]))
def test_every_number_is_answered_or_refused(results, part):
    argv = [sys.executable, "-m", "tests.api.extreme_numbers", str(results), "--part", part]
    argv += [] if ALL else ["--sample", str(SEED)]
    done = subprocess.run(argv, cwd=ROOT, capture_output=True, text=True, check=False, timeout=1200)
    assert done.returncode == 0, f"{argv[2:]}\n{done.stdout[-5000:]}{done.stderr[-2000:]}"
    assert " answered" in done.stdout
