"""Large and hostile uploads: /health and ordinary questions are answered meanwhile, and little memory is added.

One service takes them all; that which measures the memory comes first.
"""

import json
import os
import struct
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from tests.api.servers import Stopwatch, ask, serving
from tests.sampling import but_long, number
from tests.sheets import xlsx_bytes

CSV, JSON, FILE = "text/csv", "application/json", "application/octet-stream"

pytestmark = [
    pytest.mark.alone,
    pytest.mark.slow,
    pytest.mark.skipif(not Path("/proc/self/schedstat").exists(), reason="needs the delays that Linux tells"),
]

OBJECTS = {"objects": [{"width": 0.3, "height": 1.2}], "sensitivity": False, "shapes": "sine"}
SITE = OBJECTS | {"pga": 3.0, "pgv": 0.3}
SHORT = {"acceleration": [0.0, 1.0, -1.0, 0.0] * 50, "time_step": 0.02}
RECORDS = "/v1/records/response?width=0.5&height=2.0&unit=g"
ROUTE = f"{RECORDS}&thresholds=false"
"""The search for thresholds takes most of the processor time of an upload, and lets others run."""

ORDINARY = {
    "a table": ("POST", "/v1/assess", JSON, json.dumps(SITE)),
    "a record": ("POST", f"{RECORDS}&thresholds=false&time_step=0.02", CSV, "acceleration [g]\n" + "0.1\n-0.3\n" * 50),
    "a block": ("GET", "/v1/blocks/response?pulse=sine&width=0.4&height=1.6&peak_acceleration=4&period=0.5", FILE, ""),
}
SECONDS = 2.0
"""Longest wait of an ordinary question [s]."""


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    folder = tmp_path_factory.mktemp("serve")
    patient = {"ROCKING_MAX_QUEUE": "100", "ROCKING_ARRIVAL_SECONDS": "100"}  # all uploads are answered
    with serving(folder, folder / "log", ROCKING_ACCESS_LOG="0", **patient) as server:
        for asked in ORDINARY.values():
            while (found := ask(server.port, *asked))[0] == 503:
                pass  # the solver is compiled
            assert found[0] == 200, found
        yield server


def column_file(bytes_wanted):
    """A file of times and accelerations [g] of about that size."""
    rows = bytes_wanted // 20
    values = 0.3 * np.sin(np.arange(rows) * 0.01)
    lines = (f"{k * 0.005:9.3f},{value:9.6f}" for k, value in enumerate(values.tolist()))
    return "\n".join(["time [s],acceleration [g]", *lines]).encode()


def json_of(values):
    """A JSON body of blocks or of a record, of about two (blocks) or four megabytes."""
    numbers = np.random.default_rng(1).uniform(0.05, 0.95, 200_000)
    if values == "groups":
        columns = {"slenderness": numbers[:49_000].tolist(), "frequency_ratio": (9.0 * numbers[:49_000]).tolist()}
        return json.dumps({"pulse": "sine", "restitution": 0.85, **columns}).encode()
    records = [{"acceleration": numbers[k::4].tolist(), "time_step": 0.01} for k in range(4)]
    return json.dumps({"objects": [{"width": 1.6, "height": 0.4}], "records": records, "sensitivity": False}).encode()


UPLOADS = {
    "record": (ROUTE, CSV, lambda: column_file(2_000_000)),
    "blocks in JSON": ("/v1/response", JSON, lambda: json_of("groups")),
    "records of a site in JSON": ("/v1/assess", JSON, lambda: json_of("records")),
}
CLIENTS = number(16, 40)

CLIENT = """
import json, sys
from concurrent.futures import ThreadPoolExecutor
from tests.api.servers import ask
port, body, route, media_type, clients = sys.argv[1:]
content = open(body, "rb").read()
with ThreadPoolExecutor(int(clients)) as pool:
    answers = [pool.submit(ask, int(port), "POST", route, media_type, content) for _ in range(int(clients))]
    print(json.dumps([one.result()[0] for one in answers]))
"""


@pytest.mark.parametrize("upload", but_long(UPLOADS, "record"))
def test_many_large_uploads_do_not_delay_health_nor_fill_the_memory(server, tmp_path, upload):
    route, media_type, made = UPLOADS[upload]
    (tmp_path / "body").write_bytes(made())
    before = megabytes(server.process, "VmRSS")
    arguments = [sys.executable, "-c", CLIENT, server.port, tmp_path / "body", route, media_type, CLIENTS]

    def delays_meanwhile():
        delays = []
        with subprocess.Popen([*map(str, arguments)], stdout=subprocess.PIPE) as clients:
            while clients.poll() is None:
                delays.append(delay_of_health(server))
                time.sleep(0.02)
            statuses = json.loads(clients.stdout.read())
        assert set(statuses) == {200}
        return delays

    assert_short(delays_meanwhile)
    assert megabytes(server.process, "VmHWM") - before < number(300.0, 400.0)


def megabytes(process, kind):
    """Resident memory (VmRSS) or its maximum (VmHWM) [MB]."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    (line,) = [line for line in status.splitlines() if line.startswith(kind)]
    return int(line.split()[1]) / 1024


def assert_short(delays_meanwhile):
    """One of three times at most one delay is longer than 0.2 s.

    Those that the service causes come each time. A virtual machine whose host gives it less than its processors is
    stopped for tenths of a second while all of them work, and the clocks of its processes go on.
    """
    found = []
    while not found or found[-1] >= 0.2:
        assert len(found) < 3, found
        found.append([0.0, 0.0, *sorted(delays_meanwhile())][-2])


def delay_of_health(server):
    """Time of a request for /health [s], without that which other processes took."""
    stopwatch = Stopwatch(os.getpid(), server.process.pid)
    assert ask(server.port, "GET", "/health", FILE, "")[0] == 200
    return stopwatch.seconds()


HOSTILE = {
    "4 million rows of one digit": lambda: b"unit: g\ndt: 0.01\n" + b"1\n0\n" * 2_000_000,
    "a name of 8 MB": lambda: b"a" * 8_000_000 + b"\n0,1\n1,2\n",
    "long lines": lambda: (b"a " * 4000 + b"\n") * number(20, 190) + b"1\n2\n",
    "openings of brackets": lambda: b"time," + b"(" * 8000 + b"\n" + b"0,1\n1,2\n2,1\n" * number(20_000, 600_000),
    "fields that are no numbers": lambda: b"time [s],acc [g]\n" + b"0.01,1\n" * 1_000_000 + b"x" * 8000,
}


@pytest.mark.parametrize("name", but_long(HOSTILE, "long lines", "openings of brackets"))
def test_hostile_records_do_not_delay_health(server, name):
    content = HOSTILE[name]()

    def delays_meanwhile():
        delays, found = [], []
        upload = threading.Thread(target=lambda: found.append(ask(server.port, "POST", ROUTE, CSV, content)))
        upload.start()
        while upload.is_alive():
            delays.append(delay_of_health(server))
            time.sleep(0.005)
        assert found[0][0] in (200, 422, 504)
        return delays

    assert_short(delays_meanwhile)


TETRAHEDRON = ("1 3 2", "1 2 4", "2 3 4", "1 4 3")


def obj(between):
    """A tetrahedron of many faces with a line before each."""
    lines = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1"]
    for k in range(number(25_000, 200_000)):
        lines += [between.format(k), f"f {TETRAHEDRON[k % 4]}"]
    return "\n".join(lines).encode()


TRIANGLE = np.eye(3, dtype="<f4").tobytes()


def scene(count, **parts):
    """The tree of a GLB file with one mesh of some vertices."""
    mesh = {"primitives": [{"attributes": {"POSITION": 0}}]}
    start = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]}
    accessor = {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"}
    views = {"bufferViews": [{"buffer": 0, "byteLength": 12 * count}], "buffers": [{"byteLength": 12 * count}]}
    return start | {"meshes": [mesh], "accessors": [accessor]} | views | parts


def glb(nodes, nested=False):
    """A triangle in a scene of so many nodes, each perhaps within the one before."""
    tree = [{"mesh": 0} | ({"children": [k + 1]} if nested and k < nodes - 1 else {}) for k in range(nodes)]
    return glb_file(scene(3, nodes=tree, scenes=[{"nodes": [0] if nested else [*range(nodes)]}]), TRIANGLE)


def glb_file(tree, binary=b""):
    """A GLB file of a tree and a binary part."""
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


def ply(elements):
    lines = ["ply", "format ascii 1.0", *(f"element e{k} 0\nproperty float x" for k in range(elements)), "end_header"]
    return "\n".join(lines).encode()


def assess(**given):
    return "/v1/assess", JSON, json.dumps(SITE | given).encode()


def table(rows):
    return "/v1/assess?pga=3&pgv=0.3", CSV, b"width [m],height [m]\n0.3,1.2\n" + rows


LONG = {
    "a sheet with a cell far out": lambda: ("/objects/text?name=a.xlsx", FILE, xlsx_bytes([["a"]], last="ZZZZ9")),
    "an OBJ file of many materials": lambda: ("/object?file=a.obj", FILE, obj("usemtl m{}")),
    "a GLB file of many nodes": lambda: ("/object?file=a.glb", FILE, glb(200_000)),
    "a GLB file of nested nodes": lambda: ("/object?file=a.glb", FILE, glb(2000, nested=True)),
    "a PLY file of many elements": lambda: ("/object?file=a.ply", FILE, ply(100_000)),
    "an STL file of many solids": lambda: ("/object?file=a.stl", FILE, b"solid a\nendsolid a\n" * 200_000),
    "many floor periods": lambda: assess(floor_periods="0.5" + ",0.5" * 20_000, floor_participation="1e-5"),
    "stiff and soft floors": lambda: assess(floor_periods="100" + ",0.001" * 19),
    "many shapes": lambda: assess(shapes="sine" + ",sine" * 400_000),
    "many levels of a hazard curve": lambda: assess(
        pgv=None, records=[SHORT], hazard={key: [*range(1, 300_000)] for key in ("intensity", "annual_rate")}
    ),
    "a table of empty rows": lambda: table(b"\n" * 8_000_000),
    "a table of totals": lambda: table(b"sum\n" * 2_000_000),
    "a form of empty rows": lambda: ("/objects", FILE, b"line-9=1&table=width+[m],height+[m]" + b"%0A" * 4_000_000),
}


def waited(server, kind):
    """Wait of an ordinary question [s]."""
    began = time.monotonic()
    status, found = ask(server.port, *ORDINARY[kind])
    assert status == 200, found
    return time.monotonic() - began


@pytest.mark.parametrize("name", but_long(LONG, "an OBJ file of many materials", "many shapes"))
def test_an_ordinary_question_does_not_wait_for_four_uploads(server, name):
    path, media_type, content = LONG[name]()
    with ThreadPoolExecutor(16) as clients:
        uploads = [clients.submit(ask, server.port, "POST", path, media_type, content) for _ in range(4)]
        time.sleep(0.5)  # they have arrived
        waits = {kind: clients.submit(waited, server, kind) for kind in ORDINARY}
        assert max(one.result() for one in waits.values()) < SECONDS, {k: one.result() for k, one in waits.items()}
        assert {one.result()[0] for one in uploads} <= {200, 413, 422, 504}
    assert ask(server.port, "GET", "/health", FILE, "")[0] == 200
