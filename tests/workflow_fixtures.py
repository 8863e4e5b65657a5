"""The products of a real run of the smallest configuration, shared by all tests of a session."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[1]
SMOKE = PROJECT / "workflow/config/smoke.yaml"


def snakemake(
    directory: Path,
    *arguments: str,
    configuration: Path = SMOKE,
    project: Path = PROJECT,
) -> subprocess.CompletedProcess[str]:
    """Run the workflow of `project` in `directory` as a user would; stderr is included in stdout."""
    command: Sequence[str | Path] = (
        sys.executable, "-m", "snakemake", "--snakefile", project / "Snakefile", "--directory", directory,
        "--configfile", configuration, "--nocolor", *arguments,
    )  # fmt: skip
    return subprocess.run(
        command, cwd=project, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=1200, check=False
    )


AFTERWARDS = {"manifest", "ro_crate", "check_results", "all"}  # rules that follow whatever makes a product again


def rules_to_run(output: str) -> set[str]:
    table = output.partition("Job stats:")[2].partition("total")[0]
    return set(re.findall(r"^(\w+) +\d+$", table, flags=re.MULTILINE))


@pytest.fixture(scope="session")
def smoke_run(once: Callable[[str, Callable[[Path], None]], Path]) -> Path:
    """Folder in which the workflow ran with smoke.yaml; tests must not change it."""
    if made := os.environ.get("ROCKING_SMOKE_RUN"):  # by the test run that started this one
        return Path(made)

    def make(folder: Path) -> None:
        finished = snakemake(folder)
        assert finished.returncode == 0, finished.stdout

    return once("smoke", make)


@pytest.fixture(scope="session")
def smoke_results(smoke_run: Path) -> Path:
    return smoke_run / "results"
