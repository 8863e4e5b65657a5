"""An installation from the wheel behaves as this checkout, and starts without reading the packages beside it."""

import json
import subprocess
from pathlib import Path

import pytest

from benchmarks.cost.first_call import README_COMMAND
from benchmarks.installation import PACKAGES
from tests.sampling import ALL, number
from tests.wheel_fixtures import Installation

ROOT = Path(__file__).parents[2]

COUNT = """
import atexit, json, os, sys
opened = []
listed = []
def seen(event, arguments):
    if event == "open" and isinstance(arguments[0], str):
        opened.append(arguments[0])
    elif event in ("os.listdir", "os.scandir"):
        listed.append(str(arguments[0]))
def write():
    counts = opened[:], listed[:]
    with open(f"{os.environ['COUNTS']}/{os.getpid()}.json", "w") as file:
        json.dump(counts, file)
atexit.register(write)
sys.addaudithook(seen)
"""
"""Counts what each process of the installation opens and lists."""

PYTHON = ["-c", "import rocking; rocking.peak_response('sine', slenderness=0.4, frequency_ratio=5.0, restitution=0.85)"]
COMMAND = ["-m", "rocking._cli", *README_COMMAND]

LIMITS = {"source files of other packages": 10, "files": 1600, "folders": 450}
"""Measured, at most: 1, 1,362 and 326; where imports of other packages were followed 4,050, 5,100 and 553,000."""

SAMPLE = (
    "tests/cli/test_cli.py::test_response_in_three_formats",
    "tests/cli/test_cli.py::test_options_name_their_units_and_shells_complete_names",
    "tests/cli/test_cli.py::test_help_and_version_import_nothing_heavy",
    "tests/api/test_service_page.py::test_pages_of_the_built_guide",
    "tests/api/test_api_state.py::test_an_installation_serves_an_example_where_no_data_are",
)
INSIDE = number(SAMPLE, ("tests/cli", "tests/api", "--ignore=tests/api/explorer"))
"""Tests of the command line and of the service that run in the installation."""

NOT_INSIDE = {"api", "assessment", "rocking", "build", "results", "atlas", "atlas-small", ".git", ".venv"}
"""What a copy of this checkout beside an installation lacks."""


@pytest.fixture
def counted(installed: Installation, kernels: Path, tmp_path: Path) -> dict[str, str]:
    """Environment of a process that counts; its kernels are there, but not yet known as those of this package."""
    (tmp_path / "sitecustomize.py").write_text(COUNT)
    (tmp_path / "counts").mkdir()
    counts = str(tmp_path / "counts")
    return installed.environment(PYTHONPATH=str(tmp_path), COUNTS=counts, NUMBA_CACHE_DIR=str(kernels))


def assert_few_files(environment: dict[str, str], packages: Path) -> None:
    own = tuple(str(packages / name) for name in PACKAGES)
    for path in Path(environment["COUNTS"]).iterdir():
        opened, listed = json.loads(path.read_text())
        sources = [one for one in opened if one.endswith(".py") and not one.startswith(own)]
        found = dict(zip(LIMITS, (len(sources), len(opened), len(listed)), strict=True))
        assert all(found[name] <= limit for name, limit in LIMITS.items()), found


@pytest.mark.long
@pytest.mark.parametrize("first", [PYTHON, COMMAND], ids=["python", "command"])
def test_a_first_answer_reads_few_files(
    installed: Installation, counted: dict[str, str], tmp_path: Path, first: list[str]
) -> None:
    subprocess.run([installed.python, *first], env=counted, cwd=tmp_path, check=True, capture_output=True)
    assert_few_files(counted, installed.packages)


def test_the_tests_of_command_line_and_service_pass_in_the_installation(
    installed: Installation, kernels: Path, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """In a folder with all of this checkout but the packages. A sample of them; `make test-all` runs all."""
    for path in ROOT.iterdir():
        if path.name not in NOT_INSIDE:
            (tmp_path / path.name).symlink_to(path)
    made = {"ROCKING_SMOKE_RUN": str(request.getfixturevalue("smoke_run"))} if ALL else {}
    environment = installed.environment(NUMBA_CACHE_DIR=str(kernels), **made)
    where = "import rocking, rocking_api; print(rocking.__file__, rocking_api.__file__)"
    program = f"{where}; import sys, pytest; sys.exit(pytest.main(sys.argv[1:]))"
    options = ["-q", "-p", "no:cacheprovider", "-n", "0", "-m", "not alone"]
    command = [installed.python, "-P", "-c", program, *options, *INSIDE]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert all(path.startswith(str(installed.packages)) for path in done.stdout.splitlines()[0].split())
