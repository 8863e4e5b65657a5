"""Settings of all tests: the same random examples in every run, one run of the workflow."""

import pytest
from hypothesis import HealthCheck, settings

# Derandomized: a failure can be repeated. No deadline: the first call of a kernel compiles it.
settings.register_profile(
    "rocking", derandomize=True, deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("rocking")

LONGEST = (
    "tests/workflow/test_claims.py",  # with the shared run of the workflow
    "tests/api/test_memory_budget.py",  # mostly waits, while that run needs all processors
    "tests/api/test_api_kernels.py",
    "tests/workflow/test_suite.py",
    "tests/workflow/test_workflow_recovery.py",  # needs the shared run
    "tests/workflow/test_workflow.py",
    "tests/benchmarks/test_benchmarks.py",
    "tests/base/test_compilation.py",
    "tests/boundary/test_boundary.py",
    "tests/solver/test_stages.py",
)
"""Files whose tests run first: a long one at the end would leave the other processes of the test run idle."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Move the longest files to the front, in their order."""
    order = {name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: order.get(item.nodeid.partition("::")[0], len(order)))


pytest_plugins = ["tests.wheel_fixtures", "tests.workflow_fixtures"]
