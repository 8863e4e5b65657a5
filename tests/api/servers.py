"""Real servers on the loopback, for tests."""

import http.client
import os
import re
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from pathlib import Path

ROOT = Path(__file__).parents[2]


class Server:
    """A running `rocking serve`."""

    def __init__(self, process, log):
        self.process = process
        self.log = log
        self.port = self._port()

    @property
    def address(self):
        return f"http://127.0.0.1:{self.port}"

    def stop(self, seconds=30):
        """Stop it with SIGTERM; returns the exit status."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=seconds)

    def _port(self):
        """The port, from the log line of the server when it listens."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and self.process.poll() is None:
            listening = re.search(r"running on http://127\.0\.0\.1:(\d+)", self.log.read_text())
            if listening:
                with suppress(ConnectionRefusedError), socket.create_connection(("127.0.0.1", int(listening[1]))):
                    return int(listening[1])  # the first of several workers listens
            time.sleep(0.02)
        raise AssertionError(self.log.read_text())


@contextmanager
def serving(results, log, command=(sys.executable, "-m", "rocking._cli"), cwd=ROOT, workers=1, **environment):
    """`rocking serve` in a separate process on a free port."""
    arguments = [*command, "serve", "--port", "0", "--results", str(results)]
    if workers > 1:
        arguments += ["--workers", str(workers)]
    environment = os.environ | environment
    with (
        log.open("w") as output,
        subprocess.Popen(arguments, cwd=cwd, stdout=output, stderr=output, env=environment) as process,
    ):
        try:
            yield Server(process, log)
        finally:
            if process.poll() is None:
                process.terminate()
                try:
                    process.wait(timeout=30)
                except subprocess.TimeoutExpired:
                    process.kill()


def ask(port, method, path, media_type="application/octet-stream", content=""):
    """Status and body of the answer to a request, by a client of plain Python, which takes little time."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=180)
    connection.request(method, path, content, {"Content-Type": media_type})
    response = connection.getresponse()
    found = response.status, response.read()
    connection.close()
    return found


@contextmanager
def proxy(service_port, folder):
    """The configuration of the proxy in front of a service: its port on the loopback, and what it writes."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    own = (ROOT / "deploy" / "nginx.conf").read_text().replace("/etc/ssl/rocking", str(folder))
    own = own.replace("listen 443", f"listen 127.0.0.1:{port}")
    own = own.replace("http://127.0.0.1:8000", f"http://127.0.0.1:{service_port}")
    temporary = " ".join(
        f"{kind}_temp_path {folder / kind};" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    )
    (folder / "nginx.conf").write_text(
        f"daemon off; worker_processes auto; user root; pid {folder / 'pid'}; error_log stderr;\n"
        "events { worker_connections 768; }\n"
        f"http {{ access_log off; {temporary}\n{own} }}"
    )
    files = ["-keyout", str(folder / "key.pem"), "-out", str(folder / "fullchain.pem")]
    key = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=rocking.example.org", *files]
    subprocess.run(key, check=True, capture_output=True)
    log = folder / "nginx.log"
    command = ["nginx", "-p", str(folder), "-c", str(folder / "nginx.conf")]
    with log.open("w") as output, subprocess.Popen(command, stderr=output) as process:
        try:
            for _ in range(100):
                with suppress(OSError), socket.create_connection(("127.0.0.1", port)):
                    break
                assert process.poll() is None, log.read_text()
                time.sleep(0.1)
            yield port, log
        finally:
            process.terminate()


class Stopwatch:
    """Time since its creation [s], without that in which the processors did not work for the processes.

    That is the time that the main threads of the processes were ready to run while others did, and that for which a
    virtual machine stops: the clocks go on, the ticks of its processors do not. The result is never longer than the
    processor time of the processes, which a delay that they cause themselves cannot exceed.
    """

    def __init__(self, *processes):
        self._processes = processes
        self._began = time.perf_counter(), self._kept_waiting(), self._processor_time(), _ticking_time()

    def seconds(self):
        began, waited, spent, ticked = self._began
        passed = min(time.perf_counter() - began, _ticking_time() - ticked + TICK)
        return min(passed - (self._kept_waiting() - waited), self._processor_time() - spent)

    def _kept_waiting(self):
        files = (Path(f"/proc/{pid}/task/{pid}/schedstat") for pid in self._processes)
        return 1e-9 * sum(int(file.read_text().split()[1]) for file in files)

    def _processor_time(self):
        """Of all threads, those that have ended among them."""
        return sum(time.clock_gettime((~pid << 3) | 2) for pid in self._processes)  # clock_getcpuclockid(3)


TICK = 1.0 / os.sysconf("SC_CLK_TCK")
"""Unit of the times that the system counts [s]."""


def _ticking_time():
    """Time for which the processors of this machine have worked or had nothing to do, the mean of all [s]."""
    counts = Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]
    return TICK * sum(map(int, counts)) / os.cpu_count()
