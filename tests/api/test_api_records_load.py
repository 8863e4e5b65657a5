"""Large and hostile uploads: /health answers meanwhile, and little memory is added to that of the service."""

import http.client
import json
import os
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from tests.api.servers import Stopwatch, serving
from tests.sampling import but_long

ROUTE = "/v1/records/response?width=0.5&height=2.0&unit=g"

CLIENTS = """
import http.client, json, sys, threading

body, statuses = open(sys.argv[2], "rb").read(), []

def upload():
    connection = http.client.HTTPConnection("127.0.0.1", int(sys.argv[1]), timeout=120)
    connection.request("POST", sys.argv[3], body=body, headers={"Content-Type": sys.argv[4]})
    statuses.append(connection.getresponse().status)
    connection.close()

threads = [threading.Thread(target=upload) for _ in range(64)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(json.dumps(statuses))
"""

pytestmark = [
    pytest.mark.alone,
    pytest.mark.slow,
    pytest.mark.skipif(not Path("/proc/self/schedstat").exists(), reason="needs the delays that Linux tells"),
]


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


HOSTILE = {
    "4 million rows of one digit": b"unit: g\ndt: 0.01\n" + b"1\n0\n" * 2_000_000,
    "a name of 8 MB": b"a" * 8_000_000 + b"\n0,1\n1,2\n",
    "long lines": (b"a " * 4000 + b"\n") * 190 + b"1\n2\n",
    "openings of brackets": b"time," + b"(" * 8000 + b"\n" + b"0,1\n1,2\n2,1\n" * 600_000,
    "fields that are no numbers": b"time_s,a_g\n" + b"0.01,1\n" * 1_000_000 + b"x" * 8000,
}


@contextmanager
def warm_server(folder):
    """A service whose kernels are loaded."""
    with serving(folder, folder / "log", ROCKING_ACCESS_LOG="0") as server:
        assert status_of(server, "POST", ROUTE, column_file(20_000)) == 200
        yield server


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with warm_server(tmp_path_factory.mktemp("serve")) as server:
        yield server


@pytest.mark.parametrize("name", but_long(HOSTILE, "long lines", "openings of brackets"))
def test_hostile_bodies_do_not_delay_health(server, name):
    def delays_meanwhile():
        delays, statuses = [], []
        upload = threading.Thread(target=lambda: statuses.append(status_of(server, "POST", ROUTE, HOSTILE[name])))
        upload.start()
        while upload.is_alive():
            delays.append(delay_of_health(server))
            time.sleep(0.005)
        assert statuses[0] in (200, 422, 504)
        return delays

    assert_short(delays_meanwhile)


def assert_short(delays_meanwhile):
    """One of three times at most one delay is longer than 0.2 s.

    Those that the service causes come each time. A virtual machine whose host gives it less than its processors is
    stopped for tenths of a second while all of them work, and the clocks of its processes go on.
    """
    found = []
    while not found or found[-1] >= 0.2:
        assert len(found) < 3, found
        found.append([0.0, 0.0, *sorted(delays_meanwhile())][-2])


def status_of(server, method, path, content=None):
    """Status of the response to a request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=120)
    connection.request(method, path, body=content)
    status = connection.getresponse().status
    connection.close()
    return status


def delay_of_health(server):
    """Time of a request for /health [s], without that which other processes took."""
    stopwatch = Stopwatch(os.getpid(), server.process.pid)
    assert status_of(server, "GET", "/health") == 200
    return stopwatch.seconds()


def json_of(values):
    """A JSON body of blocks or of a record, of about two (blocks) or four megabytes."""
    numbers = np.random.default_rng(1).uniform(0.05, 0.95, 200_000)
    if values == "groups":
        columns = {"slenderness": numbers[:49_000].tolist(), "frequency_ratio": (9.0 * numbers[:49_000]).tolist()}
        return json.dumps({"pulse": "sine", "restitution": 0.85, **columns}).encode()
    records = [{"acceleration": numbers[k::4].tolist(), "time_step": 0.01} for k in range(4)]
    return json.dumps({"objects": [{"width": 1.6, "height": 0.4}], "records": records, "sensitivity": False}).encode()


UPLOADS = {
    "record": (ROUTE, "text/csv", lambda: column_file(5_000_000)),
    "blocks in JSON": ("/v1/response", "application/json", lambda: json_of("groups")),
    "records of a site in JSON": ("/v1/assess", "application/json", lambda: json_of("records")),
}


@pytest.mark.parametrize("upload", but_long(UPLOADS, "record", "blocks in JSON"))
def test_many_large_uploads_do_not_delay_health_nor_fill_the_memory(tmp_path, upload):
    route, media_type, made = UPLOADS[upload]
    (tmp_path / "body").write_bytes(made())
    with warm_server(tmp_path) as server:
        before = megabytes(server.process, "VmRSS")
        arguments = [sys.executable, "-c", CLIENTS, str(server.port), str(tmp_path / "body"), route, media_type]

        def delays_meanwhile():
            delays = []
            with subprocess.Popen(arguments, stdout=subprocess.PIPE) as clients:
                while clients.poll() is None:
                    delays.append(delay_of_health(server))
                    time.sleep(0.02)
                statuses = json.loads(clients.stdout.read())
            # beyond the queue, the memory and the time clients have to repeat
            assert {200} < set(statuses) <= {200, 503, 504}
            return delays

        assert_short(delays_meanwhile)
        assert megabytes(server.process, "VmHWM") - before < 400.0
