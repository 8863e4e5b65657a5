"""Settings of all tests: the same random examples in every run, one run of the workflow."""

from hypothesis import HealthCheck, settings

# Derandomized: a failure can be repeated. No deadline: the first call of a kernel compiles it.
settings.register_profile(
    "rocking", derandomize=True, deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("rocking")

pytest_plugins = ["tests.workflow_fixtures"]
