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
    """Return the digests of all files that a run left, except those that contain times or the commit of a checkout."""
    found = (path for top in ("results", "logs", ".snakemake") for path in (folder / top).rglob("*") if path.is_file())
    names = {path.relative_to(folder).as_posix(): path for path in found}
    return {
        name: "" if name.startswith((*WITH_TIMES, "results/.records/manifest.")) else digest(path)
        for name, path in sorted(names.items())
        if not name.startswith((".snakemake/log", ".snakemake/run.lock", ".snakemake/iocache"))
    }


def digest(path: Path) -> str:
    return hashlib.sha256(re.sub(rb'\n "commit": "\w+",', b"", path.read_bytes())).hexdigest()


def reproduce(folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        COMMAND, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, timeout=1800
    )


def processes(group: int) -> dict[int, str]:
    found = {}
    for place in Path("/proc").glob("[0-9]*"):
        try:
            if os.getpgid(int(place.name)) == group:
                found[int(place.name)] = (place / "cmdline").read_text().replace("\0", " ")
        except (ProcessLookupError, FileNotFoundError):  # it has ended in the meantime
            continue
    return found


def jobs(commands: Iterable[str]) -> list[str]:
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
    return "after its end"
