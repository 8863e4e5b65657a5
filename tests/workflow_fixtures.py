"""The finished products of a real run of the smallest configuration, shared by all tests of a session."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[1]
SMOKE = PROJECT / "workflow/config/smoke.yaml"


def snakemake(
    directory: Path, *arguments: str, configuration: Path = SMOKE, project: Path = PROJECT
) -> subprocess.CompletedProcess[str]:
    """Run the workflow of `project` in `directory` as a user would; stdout and stderr are joined in stdout."""
    command: Sequence[str | Path] = (
        sys.executable, "-m", "snakemake", "--snakefile", project / "Snakefile", "--directory", directory,
        "--configfile", configuration, "--nocolor", *arguments,
    )  # fmt: skip
    return subprocess.run(
        command, cwd=project, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=600, check=False
    )


@pytest.fixture(scope="session")
def smoke_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder in which the workflow ran with smoke.yaml; do not change anything in it."""
    directory = tmp_path_factory.mktemp("smoke")
    finished = snakemake(directory)
    assert finished.returncode == 0, finished.stdout
    return directory


@pytest.fixture(scope="session")
def smoke_results(smoke_run: Path) -> Path:
    """The results of that run: spectra, overturning, figures, claims and manifest.json."""
    return smoke_run / "results"
