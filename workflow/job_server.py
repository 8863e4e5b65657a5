"""Starts the jobs of a local run as forks of one process, the server, which has imported their libraries and kernels.

A job in a process of its own imports and loads kernels for 2.4 s of processor time; a fork needs none of that.
Snakemake starts a script by the path in `sys.executable`. `start` sets it to the path of a file that stands for Python
(`job_client.py`): it sends the script and its standard files to the server, waits for the fork, and ends with its
status. Where there is no server, and for any other use of Python, the file runs Python itself.

The server runs no thread, and no job before a fork: a job inherits modules and compiled kernels, and no state of
another job. It ends with the run, the fork of a job with its client and with the run.
"""

import atexit
import gc
import importlib
import os
import runpy
import select
import shlex
import shutil
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

from workflow.run_lock import FOLDER, end_with

PLACE = FOLDER / "server"  # relative to the folder of the run: an absolute path may be too long for a socket
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Variables that Snakemake sets for a job; libraries read them when they are imported."""

PREPARED = (
    *("snakemake.iocontainers", "snakemake.logging", "netCDF4", "dask.array", "scipy.integrate", "scipy.optimize"),
    # xarray asks for a cluster at each file that it writes
    *("distributed", "matplotlib.backends.backend_agg", "matplotlib.backends.backend_svg", "PIL.PngImagePlugin"),
    *(
        f"workflow.scripts.{name}"
        for name in ("overturning", "spectrum_part", "spectra", "figure", "claims", "check_data_sets")
    ),
)
"""Modules that jobs import; of libraries those that they import late."""


def start() -> None:
    """Start a server for the jobs that this process, Snakemake, starts in its working folder. Linux only."""
    stand_in = PLACE.resolve() / "python"
    if sys.platform != "linux" or shlex.quote(str(stand_in)) != str(stand_in):
        return
    shutil.rmtree(PLACE, ignore_errors=True)
    PLACE.mkdir(mode=0o700)  # who can write to the socket can run commands
    with socket.socket(socket.AF_UNIX) as listener:
        try:
            listener.bind(str(PLACE / "socket"))
        except OSError:  # a file system without sockets
            return
        listener.listen(64)
        words = [sys.executable, "-I", "-S", str(Path(__file__).with_name("job_client.py")), str(PLACE / "socket")]
        stand_in.write_text(f'#!/bin/sh\nexec {shlex.join(words)} "$@"\n', encoding="utf-8")
        stand_in.chmod(0o700)
        server = subprocess.Popen(
            [sys.executable, "-P", "-m", "workflow.job_server", str(listener.fileno())],
            stdin=subprocess.PIPE,
            pass_fds=[listener.fileno()],
            env=os.environ | ONE_THREAD,
        )
    atexit.register(shutil.rmtree, stand_in.parent, ignore_errors=True)  # a killed run leaves it to the next one
    atexit.register(server.communicate)  # runs first: closes its standard input, and waits for its end
    sys.executable = str(stand_in)


def serve(listener: socket.socket) -> None:
    """Fork for each connection until standard input ends, as it does with the process that started this one."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the run ends, and so does its server
    prepare()
    jobs: dict[int, tuple[int, socket.socket]] = {}  # descriptor that reports the end of a fork -> its id, its client
    while True:
        ready = select.select([listener, sys.stdin, *jobs], [], [])[0]
        for ended in jobs.keys() & {*ready}:
            fork, client = jobs.pop(ended)
            client.send(b"%d" % os.waitstatus_to_exitcode(os.waitpid(fork, 0)[1]))
            client.close()
            os.close(ended)
        if sys.stdin in ready:
            break
        if listener in ready:
            client, _ = listener.accept()
            if (fork := os.fork()) == 0:
                listener.close()
                run(client)
                return
            jobs[os.pidfd_open(fork)] = fork, client


def prepare() -> None:
    """Import what the jobs import, and load the compiled kernels."""
    for name in PREPARED:
        with suppress(ImportError):  # a job that needs it says so
            importlib.import_module(name)
    importlib.import_module("rocking.precompile").load_kernels()
    gc.collect()
    gc.freeze()  # what forks share is not written to


def run(client: socket.socket) -> None:
    """Run the script that a client names, as Python would."""
    _, files, _, _ = socket.recv_fds(client, 1, 3)
    request = b"".join(iter(lambda: client.recv(1 << 16), b"")).split(b"\0")
    process, folder, script, *variables = map(os.fsdecode, request)
    end_with(int(process))
    for own, given in enumerate(files):
        os.dup2(given, own)
        os.close(given)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(variable.split("=", 1) for variable in variables)
    sys.path.insert(0, str(Path(script).parent))
    sys.argv = [script]
    runpy.run_path(script, run_name="__main__")


if __name__ == "__main__":
    serve(socket.socket(fileno=int(sys.argv[1])))
