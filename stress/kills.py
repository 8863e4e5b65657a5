"""Kill runs of the workflow at random moments; each must recover by one `make reproduce`: `python -m stress.kills`.

A finished run of `smoke.yaml` is made first. For each trial some of its jobs are undone, and `make reproduce` is
started and killed (`kill -9`) at a random moment: the whole process group in every other trial, otherwise only `make`
or only the process that runs Snakemake. The same command is then run once. It must succeed, with the same bytes in
every product and no file that an undisturbed run does not leave.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path

PROJECT = Path(__file__).parents[1]
COMMAND = ("make", "--assume-old=.venv/project", "reproduce", "CONFIG=workflow/config/smoke.yaml")
"""As documented, but the copy of the project is never installed into the environment of this checkout."""
KILLED = ("group", "make", "run")
"""What is killed: every process, the command alone, the process that runs Snakemake alone."""

IN_TURN = ("group", "make", "group", "run")

TOO_LATE = "after its end"

STAGES = (
    ("overturning/*",), ("overturning/sine-*",), ("spectra/*",), ("spectra/cosine-*",), ("figures/figure-1*",),
    ("figures/figure-0*", "claims"), ("claims",), ("figures/table-1",), ("manifest",), ("checks/*",),
    ("check_results",),
)  # fmt: skip
"""Jobs that a trial undoes, by their records; the jobs that depend on them run again too."""

WITH_TIMES = (".snakemake/log", ".snakemake/metadata", "logs")
"""Folders whose files contain times."""


def project(folder: Path) -> Path:
    """Copy what the commands of this checkout read to a folder that has its own results."""
    folder.mkdir()
    for name in ("Makefile", "Snakefile", "environment.lock", "pyproject.toml"):
        shutil.copy2(PROJECT / name, folder)
    for name in ("rocking", "workflow", "profiles"):  # with the compiled kernels
        shutil.copytree(PROJECT / name, folder / name)
    (folder / ".venv").symlink_to(PROJECT / ".venv")
    return folder


def content(folder: Path) -> dict[str, str]:
    """Return the digests of all files that a run left, except those that contain times."""
    found = (path for top in ("results", "logs", ".snakemake") for path in (folder / top).rglob("*") if path.is_file())
    names = {path.relative_to(folder).as_posix(): path for path in found}
    return {
        name: "" if name.startswith(WITH_TIMES) else hashlib.sha256(path.read_bytes()).hexdigest()
        for name, path in sorted(names.items())
        if not name.startswith((".snakemake/log", ".snakemake/run.lock", ".snakemake/iocache"))
    }


def reproduce(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run the documented command once."""
    return subprocess.run(
        COMMAND, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, timeout=1800
    )


def processes(group: int) -> dict[int, str]:
    """Return the processes of a group, with their commands."""
    found = {}
    for place in Path("/proc").glob("[0-9]*"):
        try:
            if os.getpgid(int(place.name)) == group:
                found[int(place.name)] = (place / "cmdline").read_text().replace("\0", " ")
        except (ProcessLookupError, FileNotFoundError):  # it has ended in the meantime
            continue
    return found


def jobs(commands: Iterable[str]) -> list[str]:
    """Return the names of the running scripts, from Snakemake's copies of them."""
    return sorted(found[1] for command in commands if (found := re.search(r"scripts/tmp\w+\.(\w+)\.py", command)))


def interrupt(folder: Path, what: str, condition: Callable[[list[str]], bool]) -> str:
    """Start the command and kill `what` as soon as `condition(running jobs)` holds; return which jobs were running."""
    with tempfile.TemporaryFile() as log:
        command = subprocess.Popen(COMMAND, cwd=folder, stdout=log, stderr=log, start_new_session=True)
        while command.poll() is None:
            found = processes(command.pid)
            if condition(jobs(found.values())):
                runs = [one for one, command_line in found.items() if command_line.startswith("python -m workflow.run")]
                if what == "group":
                    os.killpg(command.pid, signal.SIGKILL)
                else:
                    os.kill(runs[0] if what == "run" and runs else command.pid, signal.SIGKILL)
                command.wait()
                return f"in {', '.join(jobs(found.values())) or 'no job'}"
            time.sleep(0.02)
    return TOO_LATE


def kill_at_random(folder: Path, stage: Iterable[str], what: str, draw: random.Random) -> str:
    """Undo the jobs of a stage and kill the run that repeats them; try again where the kill came too late."""
    latest, where = 40.0, TOO_LATE
    while where == TOO_LATE:
        for pattern in stage:
            for record in (folder / "results/.records").glob(f"{pattern}.*.json"):
                record.unlink()
        moment = time.monotonic() + draw.uniform(0.5, latest)
        where, latest = interrupt(folder, what, lambda _, end=moment: time.monotonic() > end), 0.7 * latest
    return where


def trial(folder: Path, expected: dict[str, str], what: str, draw: random.Random) -> tuple[bool, str]:
    """Kill a run and recover; return whether that succeeded, and a description."""
    stage = draw.choice(STAGES)
    where = kill_at_random(folder, stage, what, draw)
    unfinished = sum(1 for _ in (folder / "results").rglob(".*.partial"))
    start = time.perf_counter()
    recovered = reproduce(folder)
    found = content(folder)
    wrong = sorted(name for name in expected.keys() | found.keys() if expected.get(name) != found.get(name))
    seconds = time.perf_counter() - start
    description = (
        f"{what:5} killed {where}, {unfinished} unfinished; {' '.join(stage)} undone; recovered in {seconds:.0f} s"
    )
    if recovered.returncode != 0:
        return False, f"{description}\n{recovered.stdout}"
    return not wrong, description + (f"; differs: {', '.join(wrong)}" if wrong else "")


def main() -> None:
    """Command line; exit status 1 unless every trial recovers."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--finished", type=Path, help="folder of a finished run of smoke.yaml, instead of a new one")
    options = parser.parse_args()
    draw = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as name:
        folder = project(Path(name) / "project")
        if options.finished:
            for part in ("results", "logs", ".snakemake"):
                shutil.copytree(options.finished / part, folder / part)
        first = reproduce(folder)
        if first.returncode != 0:
            sys.exit(first.stdout)
        expected, failed = content(folder), 0
        for number in range(options.trials):
            recovered, description = trial(folder, expected, IN_TURN[number % len(IN_TURN)], draw)
            failed += not recovered
            print(f"{number + 1:3} {'ok  ' if recovered else 'FAIL'} {description}", flush=True)
    sys.exit(f"{failed} of {options.trials} did not recover" if failed else 0)


if __name__ == "__main__":
    main()
