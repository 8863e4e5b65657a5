"""One run at a time in a folder: locks of the operating system, which end with the process that holds them.

A run holds `run.lock` alone. Each of its jobs shares `jobs.lock`, and ends as soon as the run is gone. Whoever gets
both is alone in the folder, also after a run was killed, and nobody will finish what is unfinished there.
"""

from __future__ import annotations

import fcntl
import os
import select
import threading
import time
from pathlib import Path
from typing import IO

from rocking.datasets.checksum import PARTIAL

RUN_ID = "ROCKING_RUN"
"""Environment variable with the process that a process ends with: a job with its run, a run with its make."""

FOLDER = Path(".snakemake")
"""Where the locks lie, and Snakemake's own files."""

PATIENCE = 3.0
"""How long a lock is tried [s]: the system needs a moment to end a process that was killed."""

_held: dict[Path, IO[str]] = {}


class RunningError(RuntimeError):
    """Another run is at work in the folder."""


def acquire(folder: Path) -> None:
    """Hold a folder until this process ends, and remove what killed jobs left unfinished in it.

    Jobs of a run that was killed alone are waited for; they end by themselves within moments.

    Raises
    ------
    RunningError
        If another live run holds it.
    """
    folder = folder.resolve()
    if folder in _held:
        return
    (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    run = (folder / FOLDER / "run.lock").open("a+")
    if not _locked(run, PATIENCE):
        run.seek(0)
        process = run.read().strip()
        run.close()
        raise RunningError(f"{folder}: another run (process {process}) is at work here; wait for its end, or stop it")
    run.truncate(0)
    run.write(f"{os.getpid()}\n")
    run.flush()
    _held[folder] = run
    with (folder / FOLDER / "jobs.lock").open("a") as jobs:
        if not _locked(jobs, PATIENCE):
            print("Waiting for jobs of an interrupted run to end ...", flush=True)
            fcntl.flock(jobs, fcntl.LOCK_EX)
        # Snakemake's copies of the scripts that it ran, and unfinished data sets
        for left in (*(folder / FOLDER / "scripts").glob("tmp*.py"), *(folder / "results").rglob(f".*{PARTIAL}")):
            left.unlink()


def _locked(file: IO[str], patience: float) -> bool:
    """Lock a file for this process alone, if that can be had within some seconds."""
    end = time.monotonic() + patience
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > end:
                return False
            time.sleep(0.05)
        else:
            return True


def join_run() -> None:
    """In a job: share the folder with the run until the job ends, and end with the run."""
    jobs = _held[FOLDER] = (FOLDER / "jobs.lock").open("a")
    fcntl.flock(jobs, fcntl.LOCK_SH)
    end_with(int(os.environ[RUN_ID]))  # asked after the lock is held: a later run waits for this job, or it ends here


def end_with(process: int) -> None:
    """End this process as soon as another one is gone, at once if it is gone already."""
    if not hasattr(os, "pidfd_open"):  # elsewhere than on Linux a job goes on, and the next run waits for it
        return
    try:
        other = os.pidfd_open(process)
    except ProcessLookupError:
        os._exit(1)
    if select.select([other], [], [], 0.0)[0]:  # killed, its parent has not noticed yet
        os._exit(1)
    threading.Thread(target=_end_after, args=(other,), daemon=True).start()


def _end_after(process: int) -> None:
    select.select([process], [], [])
    os._exit(1)
