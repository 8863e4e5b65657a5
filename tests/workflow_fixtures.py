"""The products of a real run of the smallest configuration, shared by all tests of a session."""

from __future__ import annotations

import fcntl
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[1]
SMOKE = PROJECT / "workflow/config/smoke.yaml"


def snakemake(
    directory: Path,
    *arguments: str,
    configuration: Path = SMOKE,
    project: Path = PROJECT,
    module: str = "snakemake",
) -> subprocess.CompletedProcess[str]:
    """Run the workflow of `project` in `directory` as a user would; stderr is included in stdout."""
    command: Sequence[str | Path] = (
        sys.executable, "-m", module, "--snakefile", project / "Snakefile", "--directory", directory,
        "--configfile", configuration, "--nocolor", *arguments,
    )  # fmt: skip
    return subprocess.run(
        command, cwd=project, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=1200, check=False
    )


def reproduce(directory: Path) -> subprocess.CompletedProcess[str]:
    """Run what `make reproduce` runs."""
    return snakemake(directory, module="workflow.run")


def rules_to_run(output: str) -> set[str]:
    """Return the rule names in the job table of a dry run."""
    table = output.partition("Job stats:")[2].partition("total")[0]
    return set(re.findall(r"^(\w+) +\d+$", table, flags=re.MULTILINE))


@pytest.fixture(scope="session")
def smoke_run(tmp_path_factory: pytest.TempPathFactory, testrun_uid: str) -> Path:
    """Folder in which the workflow ran with smoke.yaml; tests must not change it.

    The first worker process of a test run that needs it runs the workflow; the others wait.
    """
    if made := os.environ.get("ROCKING_SMOKE_RUN"):  # by the test run that started this one
        return Path(made)
    base = tmp_path_factory.getbasetemp()
    if os.environ.get("PYTEST_XDIST_WORKER"):
        base = base.parent  # shared by all workers
    directory = base / f"smoke-{testrun_uid}"
    with (base / "smoke.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (base / "smoke.complete").exists():
            finished = reproduce(directory)
            assert finished.returncode == 0, finished.stdout
            (base / "smoke.complete").touch()
    return directory


@pytest.fixture(scope="session")
def smoke_results(smoke_run: Path) -> Path:
    """The results of that run: spectra, overturning, figures, claims and manifest.json."""
    return smoke_run / "results"
