"""Stands for Python where Snakemake starts the script of a job: a fork of the server runs it (`job_server.py`).

The arguments are the path of the socket of the server and those of Python. It imports little, as each job starts it.
"""

import os
import signal
import socket
import sys


def main(address: str, arguments: list[str]) -> None:
    """Have the server run a script, or become Python."""
    connection = socket.socket(socket.AF_UNIX)
    try:
        if len(arguments) != 1 or not arguments[0].endswith(".py"):
            raise ValueError("not the script of a job")
        connection.connect(address)
    except (OSError, ValueError):
        os.execv(sys.executable, [sys.executable, *arguments])
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # the job reports it
    variables = (name + b"=" + value for name, value in os.environb.items())
    folder = os.getcwdb()  # noqa: PTH109  (pathlib takes as long to import as all else)
    request = b"\0".join([b"%d" % os.getpid(), folder, os.fsencode(arguments[0]), *variables])
    socket.send_fds(connection, [b"\0"], [0, 1, 2])
    connection.sendall(request)
    connection.shutdown(socket.SHUT_WR)
    status = int(connection.recv(4) or -signal.SIGKILL)  # nothing if the server was killed
    if status < 0:
        os.kill(os.getpid(), -status)  # as the job ended
    sys.exit(status)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
