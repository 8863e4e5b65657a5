"""Real servers on the loopback, for tests."""

import os
import re
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[2]


def processes_below(process):
    """Process ids of the children of a process."""
    return [int(child) for child in Path(f"/proc/{process}/task/{process}/children").read_text().split()]


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
                return int(listening[1])
            time.sleep(0.02)
        raise AssertionError(self.log.read_text())


@contextmanager
def serving(results, log, command=(sys.executable, "-m", "rocking._cli"), cwd=ROOT, workers=1, **environment):
    """`rocking serve` in a separate process on a free port, with a cache folder beside its log."""
    arguments = [*command, "serve", "--port", "0", "--results", str(results)]
    if workers > 1:
        arguments += ["--workers", str(workers)]
    environment = os.environ | {"ROCKING_CACHE": str(log.with_name("cache"))} | environment
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
