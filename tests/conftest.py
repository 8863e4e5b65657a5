"""Settings shared by all tests: the same random examples on every run, one run of the workflow."""

from hypothesis import HealthCheck, settings

# Derandomized: a failure seen once is seen by everybody. No deadline: the first call of a kernel compiles it.
settings.register_profile(
    "rocking", derandomize=True, deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("rocking")

pytest_plugins = ["tests.workflow_fixtures"]
