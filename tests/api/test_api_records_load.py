"""Sixty-four uploads of 5 MB at once: /health answers meanwhile, and little memory is added to that of the service."""

import http.client
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from tests.api.servers import serving

ROUTE = "/v1/records/response?half_width=0.25&half_height=1.0&unit=g"

CLIENTS = f"""
import http.client, json, sys, threading

body, statuses = open(sys.argv[2], "rb").read(), []

def upload():
    connection = http.client.HTTPConnection("127.0.0.1", int(sys.argv[1]), timeout=120)
    connection.request("POST", "{ROUTE}", body=body)
    statuses.append(connection.getresponse().status)
    connection.close()

threads = [threading.Thread(target=upload) for _ in range(64)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(json.dumps(statuses))
"""


def column_file(bytes_wanted):
    """A file of times and accelerations [g] of about that size."""
    rows = bytes_wanted // 20
    values = 0.3 * np.sin(np.arange(rows) * 0.01)
    return "\n".join(f"{k * 0.005:9.3f},{value:9.6f}" for k, value in enumerate(values.tolist())).encode()


def megabytes(process, kind):
    """Resident memory (VmRSS) or its maximum (VmHWM) [MB]."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    (line,) = [line for line in status.splitlines() if line.startswith(kind)]
    return int(line.split()[1]) / 1024


def kept_waiting(*processes):
    """Time that the main threads of processes were ready to run while the processors did other work [s].

    That of the other threads of the service must count: the event loop waits for those that parse bodies.
    """
    return 1e-9 * sum(int(Path(f"/proc/{pid}/task/{pid}/schedstat").read_text().split()[1]) for pid in processes)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/schedstat").exists(), reason="needs the delays that Linux tells")
def test_many_large_uploads_do_not_delay_health_nor_fill_the_memory(tmp_path):
    body, delays = column_file(5_000_000), []
    (tmp_path / "record.csv").write_bytes(body)
    with serving(tmp_path, tmp_path / "log", ROCKING_ACCESS_LOG="0") as server:

        def status_of(method, path, content=None):
            connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=120)
            connection.request(method, path, body=content)
            status = connection.getresponse().status
            connection.close()
            return status

        assert status_of("POST", ROUTE, body[:20_000]) == 200  # the kernels are loaded
        before = megabytes(server.process, "VmRSS")
        arguments = [sys.executable, "-c", CLIENTS, str(server.port), str(tmp_path / "record.csv")]
        with subprocess.Popen(arguments, stdout=subprocess.PIPE) as clients:
            while clients.poll() is None:
                waited, began = kept_waiting(os.getpid(), server.process.pid), time.perf_counter()
                assert status_of("GET", "/health") == 200
                took = time.perf_counter() - began
                delays.append(took - (kept_waiting(os.getpid(), server.process.pid) - waited))
                time.sleep(0.02)
            statuses = json.loads(clients.stdout.read())
        added = megabytes(server.process, "VmHWM") - before
    assert set(statuses) == {200, 503}  # beyond the queue and the limit of memory clients have to repeat
    assert added < 300.0
    assert max(delays) < 0.2, sorted(delays)[-10:]
