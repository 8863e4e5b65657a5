"""Recovery of the workflow from killed runs, two runs at once, and missing, damaged or replaced products."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from rocking._datasets.cube import read_dataset
from tests.sampling import sample
from tests.workflow.killed_runs import KILLED, content, interrupt, project
from tests.workflow.killed_runs import reproduce as make_reproduce
from tests.workflow_fixtures import PROJECT, rules_to_run, snakemake
from workflow.records import forget_false_records, processor, records_of
from workflow.run_lock import RunningError, _held, acquire
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
    (CUBE, deleted, "spectra/sine-0.85"), (CUBE, flipped, "spectra/sine-0.85"), (CUBE, replaced, "spectra/sine-0.85"),
    (FIGURE, deleted, "figures/figure-04"), (FIGURE, flipped, "figures/figure-04"),
    (FIGURE, replaced, "figures/figure-04"), (DATA, emptied, "figures/figure-07"), ("claims.md", deleted, "claims"),
    ("claims.json", flipped, "claims"), ("manifest.json", deleted, "manifest"), ("manifest.json", emptied, "manifest"),
    ("manifest.json", replaced, "manifest"), ("manifest.json", flipped, "manifest"),
    ("checks.txt", deleted, "check_results"), ("checks.txt", flipped, "check_results"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "spoil", "job"), FAULTS, ids=lambda value: getattr(value, "__name__", None))
def test_wrong_product_is_named_and_its_record_deleted(
    name: str, spoil: Callable[[Path], None], job: str, run: Path
) -> None:
    records = set((run / "results/.records").rglob("*.json"))
    assert [*problems(run)] == []
    assert [*forget_false_records(run)] == []
    of_job = records_of(run, job)
    assert len(of_job) == 1
    spoil(run / "results" / name)
    (line,) = problems(run)
    assert line.startswith(f"{run / 'results' / name}: ")
    assert [*forget_false_records(run)] == [line]
    assert records - set((run / "results/.records").rglob("*.json")) == set(of_job)


def test_values_are_compared_with_another_manifest(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    manifest = json.loads((run / "results/manifest.json").read_text())
    entry = manifest["products"][CUBE]
    assert entry["content_sha256"] == read_dataset(run / "results" / CUBE).attrs["content_sha256"]
    assert entry["processor"] == processor()
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
        f"{CUBE}: other values; processors: {processor()} here, generic there",
    ]
    command = [sys.executable, "-m", "workflow.verify", run, "--against", other]
    done = subprocess.run(command, cwd=PROJECT, capture_output=True, check=False)
    assert done.returncode == 1
    assert b"2 found" in done.stderr


@pytest.mark.parametrize("spoil", [flipped, emptied])
def test_damaged_record_is_deleted(spoil: Callable[[Path], None], run: Path) -> None:
    (record,) = records_of(run, "figures/figure-04")
    spoil(record)
    assert [*forget_false_records(run)] != []
    assert not record.exists()


def test_damaged_part_is_made_again(run: Path) -> None:
    flipped(run / "results/.parts/spectra/sine-0.85.nc")
    (line,) = forget_false_records(run)
    assert line.endswith("spectra/sine-0.85.nc: its bytes are not the recorded ones")
    assert records_of(run, "parts/sine-0.85") == []


def test_each_missing_product_or_record_is_planned(run: Path) -> None:
    for path in (*(run / "results" / name for name in (CUBE, FIGURE, "claims.md")),
                 *records_of(run, "figures/figure-07"), *records_of(run, "check_results")):  # fmt: skip
        path.unlink()
    planned = rules_to_run(snakemake(run, "--dry-run").stdout)
    of_cube = {"spectra", "figure_scale_law", "claims", "check_data_sets"}
    assert planned == of_cube | {"figure_04", "figure_07", "manifest", "check_results", "all"}


@pytest.mark.slow
def test_one_command_remakes_what_is_missing_damaged_or_replaced_after_killed_runs(
    smoke_run: Path, tmp_path: Path
) -> None:
    folder = project(tmp_path / "project")
    for part in ("results", "logs", ".snakemake"):
        shutil.copytree(smoke_run / part, folder / part)
    before = content(folder)
    cube = "spectra/cosine/eta-0.85.nc"  # on which no figure and no claim depends
    spoiled = {cube: flipped, FIGURE: deleted, "manifest.json": replaced}
    for name, spoil in spoiled.items():
        spoil(folder / "results" / name)
    assert {line.partition(": ")[0] for line in problems(folder)} == {
        str(folder / "results" / name) for name in spoiled
    }
    verified = subprocess.run(
        [sys.executable, "-m", "workflow.verify", folder], cwd=PROJECT, capture_output=True, text=True, check=False
    )
    assert verified.returncode == 1
    assert f"{len(spoiled)} found; `make reproduce`" in verified.stderr
    for what in sample(KILLED, 1):
        assert "spectra" in interrupt(folder, what, lambda jobs: "spectra" in jobs)
    left = folder / "results/spectra/cosine/.eta-0.85.nc.abc.partial"
    left.touch()
    recovered = make_reproduce(folder)
    assert recovered.returncode == 0, recovered.stdout
    assert content(folder) == before
    assert [*problems(folder)] == []


def test_temporary_files_of_jobs_lie_in_the_folder_of_the_run_and_are_deleted_by_the_next_run(tmp_path: Path) -> None:
    job = "import tempfile; print(tempfile.mkstemp()[1])"
    (tmp_path / "Snakefile").write_text(f"rule all:\n    shell: {f'{sys.executable} -c {job!r}'!r}\n")
    command = [sys.executable, "-m", "workflow.run", "--cores", "1", "--quiet", "all", "--directory", tmp_path / "run"]
    environment = {**os.environ, "PYTHONPATH": str(PROJECT)}
    found = []
    for _ in range(2):
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        found.append(Path(done.stdout.strip()))
        assert [*(tmp_path / "run/.snakemake/tmp").iterdir()] == found[-1:]
    assert found[0] != found[1]


@pytest.fixture(autouse=True)
def no_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROCKING_RUN_NUMBER", raising=False)


@pytest.fixture
def holder(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    program = (
        "import sys, time, pathlib; from workflow.run_lock import acquire; acquire(pathlib.Path(sys.argv[1])); "
        "print('held', flush=True); time.sleep(600)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program, tmp_path], cwd=PROJECT, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        yield process
        process.kill()


def test_second_run_is_refused_until_the_first_has_ended(
    holder: subprocess.Popen[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("workflow.run_lock.LOCK_TIMEOUT", 0.1)
    with pytest.raises(RunningError, match=rf"another run \(process {holder.pid}\) is active here"):
        acquire(tmp_path)
    for module in ("workflow.run", "snakemake"):
        refused = snakemake(tmp_path, module=module)
        assert refused.returncode == 1
        assert f"another run (process {holder.pid}) is active here" in refused.stdout
    assert not (tmp_path / "results").exists()
    holder.send_signal(signal.SIGKILL)
    holder.wait()
    acquire(tmp_path)
    _held.pop(tmp_path.resolve()).close()  # a run keeps it open until its process ends


def test_job_ends_with_its_run_and_locks_the_folder_until_then(tmp_path: Path) -> None:
    (tmp_path / ".snakemake").mkdir()
    job = (
        "import time; from workflow.run_lock import join_run; join_run(); print('joined', flush=True); time.sleep(600)"
    )
    run = (
        "import os, subprocess, sys; os.environ['ROCKING_RUN'] = str(os.getpid()); "
        "subprocess.run([sys.executable, '-c', sys.argv[1]])"
    )
    next_run = "import pathlib; from workflow.run_lock import acquire; acquire(pathlib.Path())"
    place = {"cwd": tmp_path, "env": {**os.environ, "PYTHONPATH": str(PROJECT)}, "text": True}
    with (
        subprocess.Popen([sys.executable, "-c", run, job], stdout=subprocess.PIPE, **place) as first,
        subprocess.Popen([sys.executable, "-c", "input();" + next_run], stdin=subprocess.PIPE, **place) as second,
    ):
        assert first.stdout is not None
        assert first.stdout.readline() == "joined\n"
        assert second.stdin is not None
        second.stdin.write("\n")
        second.stdin.flush()
        with pytest.raises(subprocess.TimeoutExpired):
            second.wait(1.0)  # the job is at work
        first.kill()
        assert second.wait(60) == 0
        assert first.stdout.read() == ""  # closed by the job too


def test_job_of_a_killed_run_ends_if_another_run_has_begun(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = []
    for _ in range(2):
        acquire(tmp_path)
        numbers.append(os.environ["ROCKING_RUN_NUMBER"])
        _held.pop(tmp_path.resolve()).close()
    job = "from workflow.run_lock import join_run; join_run()"
    monkeypatch.setenv("ROCKING_RUN", str(os.getpid()))
    monkeypatch.setenv("PYTHONPATH", str(PROJECT))
    ended = []
    for number in numbers:
        monkeypatch.setenv("ROCKING_RUN_NUMBER", number)
        ended.append(
            subprocess.run([sys.executable, "-c", job], cwd=tmp_path, capture_output=True, text=True, check=False)
        )
    assert "another one has begun" in ended[0].stderr
    assert [one.returncode for one in ended] == [1, 0]
