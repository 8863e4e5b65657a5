"""Jobs of Snakemake as forks of one process that has imported what most of their time is: numba, xarray, matplotlib.

A script imports 2 to 3 s of processor time of libraries. `command` is that of a process that stands for `python`: it
sends its arguments, folder, variables and files to the server, and ends as the fork that runs the script. Runs that are
killed (`killed_runs.py`) have jobs of their own.
"""

import array
import atexit
import json
import os
import runpy
import shlex
import shutil
import socket
import subprocess
import sys
import tempfile
import traceback
from contextlib import suppress
from functools import cache
from pathlib import Path


@cache
def command() -> str:
    """Start the server of this process, and return the words of a shell that run a script by it."""
    address = f"{tempfile.mkdtemp(prefix='jobs-')}/socket"
    variables = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    server = subprocess.Popen([sys.executable, "-P", __file__, address], stdin=subprocess.PIPE, env=variables)
    atexit.register(end, server)
    return shlex.join([sys.executable, "-I", "-S", __file__, address])


def end(server: "subprocess.Popen[bytes]") -> None:
    """End the server: it listens to its standard input, too."""
    server.communicate()


def ask(address: str, arguments: list[str]) -> int:
    """Have a script run; returns its exit status."""
    with socket.socket(socket.AF_UNIX) as connection:
        connection.connect(address)
        request = json.dumps([arguments, str(Path.cwd()), dict(os.environ)]).encode()
        files = array.array("i", [0, 1, 2])
        connection.sendmsg([len(request).to_bytes(4, "big")], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, files)])
        connection.sendall(request)
        return int(connection.recv(4) or 1)


def serve(address: str) -> None:
    """Fork for each request until standard input ends, as it does with the process that started this one."""
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(address)
        listener.listen(64)
        import select  # noqa: PLC0415

        import matplotlib.backends.backend_agg  # noqa: F401, PLC0415
        import matplotlib.backends.backend_svg  # noqa: F401, PLC0415
        import netCDF4  # noqa: F401, PLC0415
        import numba  # noqa: F401, PLC0415
        import scipy.integrate  # noqa: F401, PLC0415
        import scipy.optimize  # noqa: F401, PLC0415
        import xarray  # noqa: F401, PLC0415

        while sys.stdin not in select.select([listener, sys.stdin], [], [])[0]:
            connection, _ = listener.accept()
            if os.fork() == 0:
                listener.close()
                work(connection)
            connection.close()
            with suppress(ChildProcessError):
                while os.waitpid(-1, os.WNOHANG)[0]:  # those that have ended
                    pass
    shutil.rmtree(Path(address).parent)


def work(connection: socket.socket) -> None:
    """Run the script of a request as `python` would, send its exit status, and end."""
    head, controls, _, _ = connection.recvmsg(4, socket.CMSG_SPACE(12))
    files = array.array("i", controls[0][2])
    request = b""
    while len(request) < int.from_bytes(head, "big"):
        request += connection.recv(1 << 16)
    arguments, folder, variables = json.loads(request)
    for own, given in enumerate(files):
        os.dup2(given, own)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(variables)
    own = [str(Path(arguments[0]).parent), *filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))]
    sys.path[:0], sys.argv = own, arguments
    status = 0
    try:
        runpy.run_path(arguments[0], run_name="__main__")
    except SystemExit as error:
        status = error.code if isinstance(error.code, int) else int(error.code is not None)
    except BaseException:  # noqa: BLE001  (as the interpreter does)
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    sys.stderr.flush()
    connection.send(str(status).encode())
    os._exit(0)


if __name__ == "__main__":
    if len(sys.argv) == 2:
        serve(sys.argv[1])
    else:
        sys.exit(ask(sys.argv[1], sys.argv[2:]))
