"""Missing, damaged or replaced products, killed runs, and two runs at once."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import llvmlite.binding
import pytest

from rocking._datasets.cube import read_dataset
from tests.sampling import sample
from tests.workflow.killed_runs import COMMAND, KILLED, content, interrupt, project
from tests.workflow.killed_runs import reproduce as make_reproduce
from tests.workflow_fixtures import AFTERWARDS, PROJECT, rules_to_run, snakemake
from workflow.verify import compare, problems

CUBE, FIGURE, DATA = "spectra/sine/eta-0.85.nc", "figures/figure-04.svg", "figures/figure-07.nc"


@pytest.fixture
def run(smoke_run: Path, tmp_path: Path) -> Path:
    """A finished run that a test may spoil; times of files are kept, or Snakemake would build all of them again."""
    return Path(shutil.copytree(smoke_run, tmp_path / "run"))


def deleted(path: Path) -> None:
    path.unlink()


def flipped(path: Path) -> None:
    """One bit of it, with the size and the time that it had."""
    stat, content = path.stat(), bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))


def emptied(path: Path) -> None:
    path.write_bytes(b"")


def replaced(path: Path) -> None:
    other = path.with_name(path.name.replace("figure-04", "figure-03").replace("0.85", "0.90"))
    path.write_bytes(other.read_bytes() if other != path else b'{"title": "Smoke run", "products": {}}')


FAULTS = [
    (CUBE, deleted), (CUBE, flipped), (CUBE, replaced), (FIGURE, deleted), (FIGURE, flipped), (FIGURE, replaced),
    (DATA, emptied), ("claims.md", deleted), ("claims.json", flipped), ("manifest.json", deleted),
    ("manifest.json", emptied), ("zarr/sine.zarr/outcome/0.0.0.0", flipped),
]  # fmt: skip


@pytest.mark.parametrize(("name", "spoil"), FAULTS, ids=lambda value: getattr(value, "__name__", None))
def test_wrong_product_is_named(name: str, spoil: Callable[[Path], None], run: Path) -> None:
    assert [*problems(run)] == []
    spoil(run / "results" / name)
    (line,) = problems(run)
    product = "zarr/sine.zarr" if name.startswith("zarr") else name
    assert line.startswith(f"{run / 'results' / product}: ")


def test_values_are_compared_with_another_manifest(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    manifest = json.loads((run / "results/manifest.json").read_text())
    entry = manifest["products"][CUBE]
    assert entry["content_sha256"] == read_dataset(run / "results" / CUBE).attrs["content_sha256"]
    processor = os.environ.get("NUMBA_CPU_NAME") or llvmlite.binding.get_host_cpu_name()
    assert entry["processor"] == processor
    other = tmp_path / "other.json"
    shutil.copy(run / "results/manifest.json", other)
    compare(run, other)
    assert "the values of all" in capsys.readouterr().out
    entry |= {"code_sha256": "0" * 64, "sha256": "0" * 64}  # made by other code, with the same values
    other.write_text(json.dumps(manifest))
    compare(run, other)
    entry |= {"content_sha256": "0" * 64, "processor": "generic"}
    del manifest["products"][DATA]
    other.write_text(json.dumps(manifest))
    with pytest.raises(SystemExit) as ended:
        compare(run, other)
    assert str(ended.value).splitlines()[:2] == [
        f"{DATA}: not in the other manifest",
        f"{CUBE}: other values; processors: {processor} here, generic there",
    ]
    command = [sys.executable, "-m", "workflow.verify", run, "--against", other]
    done = subprocess.run(command, cwd=PROJECT, capture_output=True, check=False)
    assert done.returncode == 1
    assert b"2 found" in done.stderr


def test_each_missing_product_is_planned(run: Path) -> None:
    for name in (CUBE, FIGURE, "claims.md", "checks.txt"):
        (run / "results" / name).unlink()
    planned = rules_to_run(snakemake(run, "--dry-run").stdout)
    of_cube = {"spectra", "restitution_errors", "zarr_store", "figures_scale_law", "claims", "check_data_sets"}
    assert planned == of_cube | {"figures_boundaries", "stac", *AFTERWARDS}


@pytest.mark.slow
def test_one_command_continues_killed_runs_and_gives_the_same_bytes(smoke_run: Path, tmp_path: Path) -> None:
    folder = project(tmp_path / "project")
    for part in ("results", "logs", ".snakemake"):
        shutil.copytree(smoke_run / part, folder / part)
    before = content(folder)
    # a cube on which no figure and no claim depends; what `make verify` names is deleted
    for name in ("spectra/cosine/eta-0.85.nc", FIGURE, "manifest.json"):
        (folder / "results" / name).unlink()
    for what in sample(KILLED, 1):
        assert "spectra" in interrupt(folder, what, lambda jobs: "spectra" in jobs)
    (folder / "results/spectra/cosine/.rocking-abc.partial").touch()
    recovered = make_reproduce(folder)
    assert recovered.returncode == 0, recovered.stdout
    assert content(folder) == before
    assert [*problems(folder)] == []


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("flock") is None, reason="needs flock of util-linux")
def test_a_second_run_waits_for_the_first(tmp_path: Path) -> None:
    """And a lock of Snakemake that a killed run left does not stop it."""
    (tmp_path / "Snakefile").write_text("rule all:\n    output: 'made'\n    shell: 'sleep 1; touch made'\n")
    for name in ("Makefile", "pyproject.toml", "environment.lock"):
        shutil.copy(PROJECT / name, tmp_path)
    (tmp_path / ".venv").symlink_to(PROJECT / ".venv")
    (tmp_path / "profiles/default").mkdir(parents=True)
    (tmp_path / "profiles/default/config.yaml").write_text("cores: 1\n")
    locks = tmp_path / ".snakemake/locks"
    locks.mkdir(parents=True)
    (locks / "0.input.lock").write_text("made\n")
    (locks / "0.output.lock").write_text("made\n")
    command = [*COMMAND[:3], "CONFIG="]
    runs = [
        subprocess.Popen(command, cwd=tmp_path, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        for _ in range(2)
    ]
    texts = sorted(run.communicate()[0] for run in runs)
    assert [run.returncode for run in runs] == [0, 0], texts
    assert sum("Nothing to be done" in text for text in texts) == 1, texts
