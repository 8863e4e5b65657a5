"""Runs of `make reproduce` in a copy of the project that are killed (`kill -9`) at a chosen moment."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path

PROJECT = Path(__file__).parents[2]
COMMAND = ("make", "--assume-old=.venv/project", "reproduce", "CONFIG=workflow/config/smoke.yaml")
"""As documented, but the copy of the project is never installed into the environment of this checkout."""
KILLED = ("group", "make", "run")
"""What is killed: every process, the command alone, the process that runs Snakemake alone."""


def project(folder: Path) -> Path:
    """Copy what the commands of this checkout read to a folder that has its own results."""
    folder.mkdir()
    (folder / "docs").mkdir()
    for name in ("Makefile", "Snakefile", "environment.lock", "pyproject.toml", "CITATION.cff", "docs/equations.md"):
        shutil.copy2(PROJECT / name, folder / name)
    for name in ("rocking", "workflow", "profiles", "benchmarks"):  # with the compiled kernels
        shutil.copytree(PROJECT / name, folder / name)
    (folder / ".venv").symlink_to(PROJECT / ".venv")
    return folder


def content(folder: Path) -> dict[str, str]:
    """Return the digests of all results, without the commit of a checkout."""
    paths = (path for path in sorted((folder / "results").rglob("*")) if path.is_file())
    return {path.relative_to(folder).as_posix(): digest(path) for path in paths}


def digest(path: Path) -> str:
    return hashlib.sha256(re.sub(rb'\n "commit": "\w+",', b"", path.read_bytes())).hexdigest()


def reproduce(folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        COMMAND, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, timeout=1800
    )


def processes(group: int) -> dict[int, str]:
    commands = {}
    for place in Path("/proc").glob("[0-9]*"):
        try:
            if os.getpgid(int(place.name)) == group:
                commands[int(place.name)] = (place / "cmdline").read_text().replace("\0", " ")
        except (ProcessLookupError, FileNotFoundError):  # it has ended in the meantime
            continue
    return commands


def jobs(commands: Iterable[str]) -> list[str]:
    return sorted(match[1] for command in commands if (match := re.search(r"scripts/tmp\w+\.(\w+)\.py$", command)))


def interrupt(folder: Path, what: str, condition: Callable[[list[str]], bool]) -> str:
    """Start the command and kill `what` as soon as `condition(running jobs)` holds; return which jobs were running."""
    with tempfile.TemporaryFile() as log:
        command = subprocess.Popen(COMMAND, cwd=folder, stdout=log, stderr=log, start_new_session=True)
        while command.poll() is None:
            running = processes(command.pid)
            if condition(jobs(line.strip() for line in running.values())):
                runs = [
                    process for process, line in running.items() if re.match(r"\S*python\S* \S*bin/snakemake ", line)
                ]
                if what == "group":
                    os.killpg(command.pid, signal.SIGKILL)
                else:
                    os.kill(runs[0] if what == "run" else command.pid, signal.SIGKILL)
                command.wait()
                return f"in {', '.join(jobs(line.strip() for line in running.values())) or 'no job'}"
            time.sleep(0.02)
    return "after its end"
