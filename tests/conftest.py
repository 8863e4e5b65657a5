"""Settings of all tests: the same random examples in every run, one run of the workflow."""

import contextlib
import gc
import importlib.util
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.sampling import ALL, number

# Derandomized: a failure can be repeated. No deadline: the first call of a kernel compiles it.
settings.register_profile(
    "rocking",
    max_examples=number(30, 100),
    derandomize=True,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("rocking")

FIRST = (
    "tests/workflow/test_claims.py",  # with the shared run of the workflow
    "tests/solver/test_plain_numba.py",
    "tests/workflow/test_workflow_recovery.py",  # needs the shared run
    "tests/repository/test_docs.py",  # needs it
    "tests/workflow/test_suite.py",
    "tests/api/test_api_fuzz.py",
    "tests/api/explorer/",  # together: the files share a browser and a service, which end with the last of them
    "tests/benchmarks/test_benchmarks.py",
    "tests/workflow/test_workflow.py",
    "tests/api/test_uploads.py",
    "tests/boundary/test_boundary.py",
    "tests/base/test_kernel_cache.py",
    "tests/assessment/evidence/test_free_rocking.py",
    "tests/base/test_compilation.py",
    "tests/repository/test_types.py",
    "tests/solver/test_stages.py",
)
"""Beginnings of the names of files that run first: long ones, so that no process is left idle by one at the end."""


ASSESSMENT = importlib.util.find_spec("trimesh") is not None
"""Whether the extra `assessment` is installed."""


USE_ASSESSMENT = (
    "tests/benchmarks/test_shaking_table.py",
    "tests/repository/test_public_names.py",
    "tests/repository/test_docs.py",
    "tests/repository/test_readme.py",
    "tests/repository/test_tutorials.py",
    "tests/repository/test_repository.py::test_settings_are_for_files_that_exist",
    "tests/api/test_uploads.py",
    "tests/api/test_service_page.py",
    "tests/api/test_api_bodies.py::test_parameters_in_the_body_and_in_the_query",
    "tests/cli/test_cli_full_disk.py",
    "tests/cli/test_cli.py::test_a_file_that_is_missing_is_no_such_file",
)
"""Beginnings of the names of tests that use the assessment through a command, a route, a page or another module."""


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out the files that use the assessment where its extra is not installed."""
    if ASSESSMENT or collection_path.suffix != ".py":
        return None
    name = collection_path.relative_to(config.rootpath).as_posix()
    uses = name in USE_ASSESSMENT or "rocking_assessment" in collection_path.read_text(encoding="utf-8")
    return True if uses else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what is long; move these files to the front, in their order, where several processes run them."""
    if not ALL:
        long = [item for item in items if item.get_closest_marker("long")]
        items[:] = [item for item in items if not item.get_closest_marker("long")]
        config.hook.pytest_deselected(items=long)
    if not ASSESSMENT:
        items[:] = [item for item in items if not item.nodeid.startswith(USE_ASSESSMENT)]
    if hasattr(config, "workerinput"):
        items.sort(key=lambda item: [not item.nodeid.startswith(start) for start in FIRST])


# A fifth of the time of imports and collection was a search for garbage among what stays.
gc.disable()


def pytest_collection_finish() -> None:
    """Collect garbage from here on, but not among what was imported and collected."""
    gc.freeze()
    gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """While a test marked `alone` runs, the other processes of the test run wait before their next test.

    A test run that a test starts has one process and does not wait: the test that started it would never end.
    """
    others = hasattr(item.config, "workerinput") and sys.platform != "win32"
    with _turn(item.get_closest_marker("alone") is not None) if others else contextlib.nullcontext():
        return (yield)


@contextlib.contextmanager
def _turn(alone: bool) -> Iterator[None]:
    import fcntl  # noqa: PLC0415  (not on every system)

    with Path(__file__).open() as queue, Path(__file__).with_name("__init__.py").open() as running:
        fcntl.flock(queue, fcntl.LOCK_EX)  # so that those that came later do not overtake one that waits to be alone
        fcntl.flock(running, fcntl.LOCK_EX if alone else fcntl.LOCK_SH)
        fcntl.flock(queue, fcntl.LOCK_UN)
        try:
            yield
        finally:
            fcntl.flock(running, fcntl.LOCK_UN)  # also for processes that have inherited it


@pytest.fixture(scope="session")
def once(tmp_path_factory: pytest.TempPathFactory, testrun_uid: str) -> Callable[[str, Callable[[Path], None]], Path]:
    """Make a folder by the first process of the run that needs it; the others wait. Tests must not change it."""
    import fcntl  # noqa: PLC0415  (not on every system)

    base = tmp_path_factory.getbasetemp()
    if os.environ.get("PYTEST_XDIST_WORKER"):
        base = base.parent  # shared by all workers

    def made(name: str, make: Callable[[Path], None]) -> Path:
        folder, complete = base / f"{name}-{testrun_uid}", base / f"{name}-{testrun_uid}.complete"
        with (base / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not complete.exists():
                make(folder)
                complete.touch()
        return folder

    return made


pytest_plugins = ["tests.wheel_fixtures", "tests.workflow_fixtures"]
