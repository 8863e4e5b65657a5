"""Make data sets through Slurm and compare all bytes with those of a local run: `python -m stress.slurm`, `make slurm`.

With `--kills 6` the run through Slurm is killed six times at random moments: a job of the cluster, the main
process, or everything. Killed jobs are repeated by the run; where it was killed itself the same command follows.

Where `sinfo` finds no cluster, one of one node is started on this machine, from the packages of Debian, which root
installs if they are missing, and ended afterwards. Where that is not possible the program says why, and ends without an
error. The executor plugin comes from the extra `slurm` of the project.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from stress.kills import PROJECT
from workflow.records import digest

CONFIGURATION = "workflow/config/smoke.yaml"
TARGETS = (
    "results/spectra/sine/eta-0.85.nc", "results/spectra/cosine/eta-0.85.nc", "results/figures/figure-scale-law.nc",
)  # fmt: skip
"""Its products that are made: boundaries, cubes and a figure, by jobs of the cluster and by local ones."""

PACKAGES = ("slurmctld", "slurmd", "slurm-client", "munge")
SETTINGS = Path("/etc/slurm/slurm.conf")
"""Where job steps look for the settings of the cluster."""

MUNGE = Path("/run/munge")
"""Folder of the socket of munged, which Slurm uses for authentication."""

PLUGIN = PROJECT / "build/slurm"
"""Folder of the executor plugin, see the target `slurm` of the Makefile."""

SLURM = ("--workflow-profile", "profiles/slurm", "--slurm-no-account", "--slurm-status-command", "squeue")

KILLED = ("job", "main", "job", "all")
"""What is killed, in turn: a job of the cluster, the main process with its local jobs, or everything."""

KILL_INTERVAL = 10.0, 50.0
"""Time between two kills, lowest and highest [s]: the first job is sent after some five."""

START_TIMEOUT = 60.0
"""Time for which the cluster may start [s]."""


class UnavailableError(RuntimeError):
    """Slurm cannot be used on this machine."""


def settings(host: str, folder: Path) -> str:
    """Return the settings of a cluster of one node, without control groups and without accounting."""
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") * 0.9 / 2**20
    return f"""\
ClusterName=rocking
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={len(os.sched_getaffinity(0))} RealMemory={memory:.0f} State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def succeeds(*command: str) -> bool:
    """Return whether a command exists and ends without an error."""
    return bool(shutil.which(command[0])) and subprocess.run(command, capture_output=True, check=False).returncode == 0


def install() -> None:
    """Install the packages of Debian that are missing.

    Raises
    ------
    UnavailableError
        Without apt, or if it fails.
    """
    if all(map(shutil.which, ("slurmctld", "slurmd", "sbatch", "munged"))):
        return
    if not shutil.which("apt-get"):
        raise UnavailableError(f"no Slurm, and no apt-get to install {', '.join(PACKAGES)}")
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    command = ["apt-get", "install", "--yes", "--no-install-recommends", *PACKAGES]
    installed = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if installed.returncode != 0:
        raise UnavailableError(f"{' '.join(command)} failed: {installed.stderr.strip().splitlines()[-1:]}")


@contextmanager
def cluster(folder: Path) -> Iterator[None]:
    """Use the cluster of this machine, or one that runs for the time of the context.

    Raises
    ------
    UnavailableError
        If there is none and it cannot be started.
    """
    if succeeds("sinfo", "--noheader"):
        yield
        return
    if SETTINGS.exists():
        raise UnavailableError(f"{SETTINGS} exists, but its cluster does not answer")
    if os.geteuid() != 0:
        raise UnavailableError("only root can start a cluster")
    install()
    for name in ("state", "spool"):
        (folder / name).mkdir()
    with ExitStack() as stack:
        SETTINGS.write_text(settings(socket.gethostname().partition(".")[0], folder), encoding="utf-8")
        stack.callback(SETTINGS.unlink)
        if not succeeds("munge", "--no-input"):
            MUNGE.mkdir(exist_ok=True)
            shutil.chown(MUNGE, "munge", "munge")
            stack.enter_context(service(folder, "munged", "--foreground", user="munge"))
            wait_for(("munge", "--no-input"))
        stack.enter_context(service(folder, "slurmctld", "-D"))
        stack.enter_context(service(folder, "slurmd", "-D"))
        wait_for(("srun", "--immediate=5", "true"))
        yield


@contextmanager
def service(folder: Path, *command: str, user: str | None = None) -> Iterator[None]:
    """Run a program in the background, with a log in the folder, for the time of the context."""
    with (
        (folder / f"{command[0]}.log").open("wb") as log,
        subprocess.Popen(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL, user=user) as process,
    ):
        try:
            yield
        finally:
            process.terminate()


def wait_for(command: Sequence[str]) -> None:
    """Wait until a command succeeds.

    Raises
    ------
    UnavailableError
        If it does not within `START_TIMEOUT`.
    """
    end = time.monotonic() + START_TIMEOUT
    while not succeeds(*command):
        if time.monotonic() > end:
            raise UnavailableError(f"`{' '.join(command)}` did not succeed within {START_TIMEOUT:g} s")
        time.sleep(0.5)


def start(directory: Path, configuration: str | None, *options: str) -> subprocess.Popen[bytes]:
    """Start the workflow in a directory, in a process group of its own, with its output in a file."""
    command = [
        sys.executable, "-m", "workflow.run", *options, "--configfile", configuration or CONFIGURATION,
        "--directory", directory, "--nocolor", "--", *(() if configuration else TARGETS),
    ]  # fmt: skip
    path = os.pathsep.join(filter(None, [str(PLUGIN), os.environ.get("PYTHONPATH")]))
    with output(directory).open("wb") as log:
        return subprocess.Popen(
            command, cwd=PROJECT, env={**os.environ, "PYTHONPATH": path}, start_new_session=True,
            stdout=log, stderr=subprocess.STDOUT,
        )  # fmt: skip


def output(directory: Path) -> Path:
    """Return the file of the output of the last run in a directory."""
    return directory.with_suffix(".log")


def finish(run: subprocess.Popen[bytes], directory: Path) -> None:
    """Wait for a run, and end this program with its output if it fails."""
    if run.wait() != 0:
        sys.exit(output(directory).read_text())


def make(directory: Path, configuration: str | None, *options: str) -> float:
    """Run the workflow in a directory; return the time it took [s]."""
    begin = time.perf_counter()
    finish(start(directory, configuration, *options), directory)
    return time.perf_counter() - begin


def make_with_kills(directory: Path, configuration: str | None, kills: int) -> float:
    """Run the workflow through Slurm, killed so many times unless it ends before; return the time it took [s]."""
    begin, draw = time.perf_counter(), random.Random(1)
    run = start(directory, configuration, *SLURM)
    for number in range(kills):
        try:
            run.wait(draw.uniform(*KILL_INTERVAL))
        except subprocess.TimeoutExpired:
            if kill(run, directory, KILLED[number % len(KILLED)]):
                run.wait()
                run = start(directory, configuration, *SLURM)
        else:
            print(f"ended after {number} kills", flush=True)
            break
    finish(run, directory)
    return time.perf_counter() - begin


def kill(run: subprocess.Popen[bytes], directory: Path, what: str) -> bool:
    """Kill `what` of a run through Slurm (SIGKILL); return whether the run has ended thereby."""
    jobs = running_jobs(directory)
    chosen = {"job": jobs[:1], "main": [], "all": jobs}[what]
    if what != "job":
        os.killpg(run.pid, signal.SIGKILL)
    if chosen:
        subprocess.run(["scancel", "--full", "--signal=KILL", *chosen], check=True)
    print(f"{what} killed: {len(chosen)} of {len(jobs)} jobs of the cluster", flush=True)
    return what != "job"


def running_jobs(directory: Path) -> list[str]:
    """Return the numbers of the jobs of the cluster that run for a directory."""
    command = ["squeue", "--noheader", "--states=running", "--format=%A %Z"]
    listed = subprocess.run(command, capture_output=True, text=True, check=True)
    rows = (line.split(maxsplit=1) for line in listed.stdout.splitlines())
    return [number for number, folder in rows if Path(folder).resolve() == directory.resolve()]


def digests(directory: Path) -> dict[str, str]:
    """Return the sha256 of every file that a run left in its results."""
    files = (path for path in (directory / "results").rglob("*") if path.is_file())
    return {path.relative_to(directory).as_posix(): digest(path)["sha256"] for path in sorted(files)}


def main() -> None:
    """Command line; exit status 1 unless all files are equal."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--configuration", help="make everything of this one, instead of some products of smoke.yaml")
    parser.add_argument("--kills", type=int, default=0, help="kill the run through Slurm so many times")
    options = parser.parse_args()
    configuration = options.configuration
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        try:
            with cluster(folder):
                through_slurm = make_with_kills(folder / "slurm", configuration, options.kills)
        except UnavailableError as error:
            print(f"skipped: {error}")
            return
        local = make(folder / "local", configuration, "--cores", "all")
        expected, found = digests(folder / "local"), digests(folder / "slurm")
        differing = sorted(name for name in expected.keys() | found.keys() if expected.get(name) != found.get(name))
    print(f"{len(expected)} files; {local:.0f} s local, {through_slurm:.0f} s through Slurm")
    sys.exit(f"different: {', '.join(differing)}" if differing else 0)


if __name__ == "__main__":
    main()
