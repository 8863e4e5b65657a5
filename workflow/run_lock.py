"""One run at a time in a folder, by file locks of the operating system, which end with the process that holds them.

A run holds `run.lock` exclusively. Its jobs share `jobs.lock` and end as soon as the run has ended. A process that
obtains both locks is the only one in the folder, also after a run was killed; unfinished files there are then stale.

A cluster may start a job of a killed run long after another run has begun: it finds the number of the other run in
`run.lock`, and ends.
"""

import fcntl
import os
import select
import threading
import time
import uuid
from pathlib import Path
from typing import IO

from rocking._base.output_file import PARTIAL

RUN_ID = "ROCKING_RUN"
"""Environment variable: id of the process with which a process ends, the run for a job and make for a run."""

RUN_NUMBER = "ROCKING_RUN_NUMBER"  # environment variable: random number of the run of a job
FOLDER = Path(".snakemake")  # folder of the locks and of the files of Snakemake
LOCK_TIMEOUT = 3.0  # time for which a lock is tried [s]: the system needs a moment to end a process that was killed

_held: dict[Path, IO[str]] = {}


class RunningError(RuntimeError):
    """Another run is active in the folder."""


def acquire(folder: Path) -> None:
    """Lock a folder until this process ends, and remove unfinished files of killed jobs. Raises `RunningError` if it is
    locked.

    If only the run was killed, this waits for its jobs, which end by themselves within moments.
    """
    folder = folder.resolve()
    if folder in _held:
        return
    (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    run = (folder / FOLDER / "run.lock").open("a+", encoding="utf-8")
    if not _locked(run, LOCK_TIMEOUT):
        run.seek(0)
        process = run.readline().strip()
        run.close()
        raise RunningError(f"{folder}: another run (process {process}) is active here; wait for its end, or stop it")
    run.truncate(0)
    os.environ[RUN_NUMBER] = uuid.uuid4().hex
    run.write(f"{os.getpid()}\n{os.environ[RUN_NUMBER]}\n")
    run.flush()
    _held[folder] = run
    with (folder / FOLDER / "jobs.lock").open("a", encoding="utf-8") as jobs:
        if not _locked(jobs, LOCK_TIMEOUT):
            print("Waiting for jobs of an interrupted run to end ...", flush=True)
            fcntl.flock(jobs, fcntl.LOCK_EX)
        # Snakemake's copies of the scripts that it ran, and unfinished data sets
        for left in (*(folder / FOLDER / "scripts").glob("tmp*.py"), *(folder / "results").rglob(f".*{PARTIAL}")):
            left.unlink(missing_ok=True)  # Snakemake removes the copies of a job some time after its script has ended


def _locked(file: IO[str], timeout: float) -> bool:
    """Try to lock a file exclusively for some seconds; whether that succeeded."""
    end = time.monotonic() + timeout
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
    """In a job: share the lock of the folder until the job ends; end with the run, or at once if another has begun."""
    jobs = _held[FOLDER] = (FOLDER / "jobs.lock").open("a", encoding="utf-8")
    fcntl.flock(jobs, fcntl.LOCK_SH)
    number = os.environ.get(RUN_NUMBER)  # a cluster may not pass it on
    if number and number not in (FOLDER / "run.lock").read_text(encoding="utf-8"):
        raise RunningError("the run that sent this job was killed, and another one has begun")
    end_with(int(os.environ[RUN_ID]))  # with the lock held: a later run waits for this job, or the job ends here


def end_with(process: int) -> None:
    """End this process as soon as another one has ended, immediately if it has ended already."""
    if not hasattr(os, "pidfd_open"):  # other systems than Linux: the job continues, and the next run waits for it
        return
    try:
        other = os.pidfd_open(process)
    except ProcessLookupError:
        os._exit(1)
    if select.select([other], [], [], 0.0)[0]:  # killed, but not yet reaped by its parent
        os._exit(1)
    threading.Thread(target=_end_after, args=(other,), daemon=True).start()


def _end_after(process: int) -> None:
    select.select([process], [], [])
    os._exit(1)
