"""Jobs of a local run as forks of one server: they end, fail and are reported as processes of their own."""

from __future__ import annotations

import json
import os
import select
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from tests.sampling import but_long
from tests.workflow_fixtures import PROJECT
from workflow.job_server import PLACE

CLIENT = PROJECT / "workflow/job_client.py"

SNAKEFILE = """
from workflow import job_server
if {forks}:
    onstart: job_server.start()
rule all:
    input: expand("{{name}}.txt", name=["good", "another", "leaves", "raises", "killed"])
rule job:
    output: "{{name}}.txt"
    script: "job.py"
"""
JOB = """
import json, os, pathlib, signal, sys
name = snakemake.wildcards.name
parent = pathlib.Path(f"/proc/{os.getppid()}/cmdline").read_text()
found = {"parent": parent, "arguments": sys.argv, "folder": os.getcwd(), "threads": os.environ["OMP_NUM_THREADS"],
         "earlier": getattr(sys, "earlier", None), "numba": "numba" in sys.modules}
sys.earlier = name
pathlib.Path(f"{name}.json").write_text(json.dumps(found))
if name == "leaves":
    sys.exit(3)
if name == "raises":
    raise ValueError("as it is")
if name == "killed":
    os.kill(os.getpid(), signal.SIGKILL)
pathlib.Path(snakemake.output[0]).touch()
"""


@pytest.fixture(scope="module", params=but_long([True, False], True), ids=["forks", "processes"])
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, bool]:
    """Folder and messages of a run of five jobs, one after the other, and whether they are forks."""
    if request.param and sys.platform != "linux":
        pytest.skip("forks are made on Linux only")
    folder = tmp_path_factory.mktemp("run")
    (folder / "Snakefile").write_text(SNAKEFILE.format(forks=request.param))
    (folder / "job.py").write_text(JOB)
    command = [sys.executable, "-m", "workflow.run", "--cores", "1", "--nocolor", "--keep-going"]
    environment = {**os.environ, "PYTHONPATH": str(PROJECT)}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    return folder, done.stderr, request.param


def test_jobs_are_forks_that_inherit_libraries_but_no_state_of_another_job(run: tuple[Path, str, bool]) -> None:
    folder, _, forks = run
    for name in ("good", "another", "leaves", "raises", "killed"):
        found = json.loads((folder / f"{name}.json").read_text())
        assert ("workflow.job_server" in found["parent"]) == found["numba"] == forks
        assert (found["folder"], found["threads"], found["earlier"]) == (str(folder), "1", None)
        (script,) = found["arguments"]
        assert script.endswith(".job.py")
    assert not (folder / PLACE).exists()


def test_jobs_that_fail_are_reported_as_processes_of_their_own(run: tuple[Path, str, bool]) -> None:
    folder, messages, _ = run
    assert {path.stem for path in folder.glob("*.txt")} == {"good", "another"}
    assert "returned non-zero exit status 3" in messages
    assert "returned non-zero exit status 1" in messages
    assert "ValueError: as it is" in messages
    assert "died with <Signals.SIGKILL: 9>" in messages


@pytest.mark.parametrize("arguments", [["-c", "print(6 * 7)"], ["answer.py"]])
def test_without_a_server_the_client_is_python(arguments: list[str], tmp_path: Path) -> None:
    (tmp_path / "answer.py").write_text("print(42)")
    command = [sys.executable, "-I", "-S", CLIENT, PLACE / "socket", *arguments]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=True).stdout == b"42\n"


@pytest.mark.skipif(sys.platform != "linux", reason="forks are made on Linux only")
def test_server_of_a_killed_run_ends_without_the_files_of_the_next_run(tmp_path: Path) -> None:
    program = (
        "import os, pathlib, signal\nfrom workflow import job_server\njob_server.start()\n"
        "children = pathlib.Path(f'/proc/self/task/{os.getpid()}/children').read_text()\n"
        "pathlib.Path('server').write_text(children)\nos.kill(os.getpid(), signal.SIGKILL)\n"
    )
    (tmp_path / PLACE.parent).mkdir()
    environment = {**os.environ, "PYTHONPATH": str(PROJECT)}
    killed = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, env=environment, check=False)
    assert killed.returncode == -signal.SIGKILL
    shutil.rmtree(tmp_path / PLACE)  # as the next run does, while the server still imports
    (tmp_path / PLACE).mkdir()
    with suppress(ProcessLookupError):
        select.select([os.pidfd_open(int((tmp_path / "server").read_text()))], [], [])
    assert (tmp_path / PLACE).exists()
