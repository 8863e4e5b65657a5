"""Slow and greedy clients of the service behind nginx as `deploy/nginx.conf` configures it, and of the service alone.

`python -m tests.api.check_deployment`: 500 clients whose headers do not end, 20 whose bodies of 60 MB do not end and 16
that do not read responses of 14 MB hold their connections; requests for one block must take less than 0.2 s meanwhile,
and the memory of the service may grow by at most 200 MB. Each client has an address of its own on the loopback, as the
proxy limits the connections of one. The time that client and service wait for a processor is subtracted.
"""

import os
import shutil
import socket
import ssl
import sys
import tempfile
import threading
import time
from contextlib import ExitStack, suppress
from pathlib import Path

from tests.api.servers import Stopwatch, proxy, serving

POINT = "/v1/response?pulse=sine&slenderness=0.6&frequency_ratio=6&restitution=0.85"
HISTORY = "/v1/history?pulse=sine&slenderness=0.4&frequency_ratio=5&restitution=0.85&samples=100000"
BODY_BYTES = 60_000_000
LOADS = {"500 slow headers": 500, "20 unfinished bodies": 20, "16 unread responses": 16}
MAX_SECONDS, MAX_MEGABYTES = 0.2, 200.0


def connect(port, encrypted, client=1):
    """A connection from an address of its own, with a small receive buffer."""
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    connection.bind((f"127.0.{1 + client // 200}.{1 + client % 200}", 0))
    connection.settimeout(60)
    connection.connect(("127.0.0.1", port))
    if not encrypted:
        return connection
    trust = ssl.create_default_context()
    trust.check_hostname, trust.verify_mode = False, ssl.CERT_NONE
    return trust.wrap_socket(connection)


def burden(connection, load):
    """Do what the clients of a load do, and keep the connection."""
    if load.endswith("headers"):
        connection.sendall(b"GET /health HTTP/1.1\r\nHost: x\r\nX-Slow: ")
    elif load.endswith("responses"):
        connection.sendall(f"GET {HISTORY} HTTP/1.1\r\nHost: x\r\n\r\n".encode())
    else:
        connection.sendall(b"POST /v1/response HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % BODY_BYTES)
        with suppress(OSError):  # refused meanwhile
            for _ in range(BODY_BYTES // 1_000_000 - 1):
                connection.sendall(b" " * 1_000_000)
                time.sleep(0.1)  # 10 MB a second: encryption takes the same processors


def seconds_of_a_point(server, port, encrypted):
    """Time of a request for one block on a new connection [s]."""
    stopwatch = Stopwatch(os.getpid(), server.process.pid)
    with connect(port, encrypted) as connection:
        connection.sendall(f"GET {POINT} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n".encode())
        received = b""
        while part := connection.recv(65536):
            received += part
    assert received.startswith(b"HTTP/1.1 200 "), received[:200]
    return stopwatch.seconds()


def megabytes(process):
    """Resident memory [MB]."""
    lines = Path(f"/proc/{process.pid}/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmRSS")).split()[1]) / 1024


def measure(server, port, encrypted, load):
    """Longest time of a request [s] and added memory [MB] under a load."""
    before = most = megabytes(server.process)
    times = []
    with ExitStack() as stack:
        clients = [stack.enter_context(connect(port, encrypted, 2 + k)) for k in range(LOADS[load])]
        threads = [threading.Thread(target=burden, args=(client, load)) for client in clients]
        for thread in threads:
            thread.start()
        until = time.monotonic() + 5.0
        while time.monotonic() < until or any(thread.is_alive() for thread in threads):
            times.append(seconds_of_a_point(server, port, encrypted))
            most = max(most, megabytes(server.process))
            time.sleep(0.05)
    return max(times), most - before


def main():
    """Measure, print; the exit status is 1 if a limit is exceeded."""
    proxied = None not in map(shutil.which, ("nginx", "openssl"))
    if not proxied:
        print("nginx or openssl is not installed: only the service alone is checked")  # noqa: T201
    failed = False
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with serving(folder, folder / "log") as server, ExitStack() as stack:
            ways = {"service alone": (server.port, False)}
            if proxied:
                ways["behind nginx"] = (stack.enter_context(proxy(server.port, folder))[0], True)
            for way, (port, encrypted) in ways.items():
                seconds_of_a_point(server, port, encrypted)  # the kernels are loaded
                for load in LOADS:
                    longest, added = measure(server, port, encrypted, load)
                    print(f"{way:14} {load:22} a request takes at most {longest:.3f} s, {added:4.0f} MB are added")  # noqa: T201
                    failed |= longest > MAX_SECONDS or added > MAX_MEGABYTES
                    time.sleep(4.0)  # responses that nobody reads are given up
    sys.exit(failed)


if __name__ == "__main__":
    main()
