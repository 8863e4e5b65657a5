"""Uploads that take long to read, beside an ordinary question: it is answered within 2 s."""

import http.client
import json
import struct
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.api.servers import serving
from tests.sampling import but_long
from tests.sheets import xlsx_bytes

SECONDS = 2.0
"""Longest wait of an ordinary question [s]."""

CLIENTS = 4
"""Clients that send the same upload at the same time."""

CSV, JSON, FILE = "text/csv", "application/json", "application/octet-stream"
OBJECTS = {"objects": [{"width": 0.3, "height": 1.2}], "sensitivity": False, "shapes": "sine"}
SITE = OBJECTS | {"pga": 3.0, "pgv": 0.3}
RECORD = {"acceleration": [0.0, 1.0, -1.0, 0.0] * 50, "time_step": 0.02}
ORDINARY = {
    "a table": ("POST", "/v1/assess", JSON, json.dumps(SITE)),
    "a record": (
        *("POST", "/v1/records/response?width=0.4&height=1.6&thresholds=false&time_step=0.02", CSV),
        "acceleration [g]\n" + "0.1\n-0.3\n" * 50,
    ),
    "a block": ("GET", "/v1/blocks/response?pulse=sine&width=0.4&height=1.6&peak_acceleration=4&period=0.5", FILE, ""),
}
CORNERS = [(x, y, z) for z in (0.0, 1.2) for y in (0.0, 0.3) for x in (0.0, 0.4)]
TRIANGLES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7)]
TRIANGLES += [(0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def obj(between):
    """A box of 200,000 faces with a line before each."""
    lines = [f"v {x} {y} {z}" for x, y, z in CORNERS]
    for k in range(200_000):
        lines += [between.format(k), "f {} {} {}".format(*(corner + 1 for corner in TRIANGLES[k % 12]))]
    return "\n".join(lines).encode()


def glb(nodes):
    """A box in a scene of so many nodes, and one that is nested in all others where they are few."""
    points = b"".join(struct.pack("<3f", *corner) for corner in CORNERS)
    faces = b"".join(struct.pack("<3H", *triangle) for triangle in TRIANGLES)
    chain = nodes < 10_000
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0] if chain else [*range(nodes)]}],
        "nodes": [{"mesh": 0} | ({"children": [k + 1]} if chain and k < nodes - 1 else {}) for k in range(nodes)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 96},
            {"buffer": 0, "byteOffset": 96, "byteLength": 72},
        ],
        "buffers": [{"byteLength": 168}],
    }
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", 168, 0x004E4942) + points + faces
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def ply(elements):
    lines = ["ply", "format ascii 1.0", *(f"element e{k} 0\nproperty float x" for k in range(elements)), "end_header"]
    return "\n".join(lines).encode()


def assess(**given):
    return "/v1/assess", JSON, json.dumps(SITE | given).encode()


def repeated(text, times):
    return ",".join([text] * times)


HOSTILE = {
    "a sheet with a cell far out": lambda: ("/objects/text?name=a.xlsx", FILE, xlsx_bytes([["a"]], last="ZZZZ9")),
    "an OBJ file of many materials": lambda: ("/object?file=a.obj", FILE, obj("usemtl m{}")),
    "an OBJ file of many objects": lambda: ("/object?file=a.obj", FILE, obj("o m{}")),
    "a GLB file of many nodes": lambda: ("/object?file=a.glb", FILE, glb(200_000)),
    "a GLB file of nested nodes": lambda: ("/object?file=a.glb", FILE, glb(2000)),
    "a PLY file of many elements": lambda: ("/object?file=a.ply", FILE, ply(100_000)),
    "an STL file of many solids": lambda: ("/object?file=a.stl", FILE, b"solid a\nendsolid a\n" * 200_000),
    "many floor periods": lambda: assess(floor_periods=repeated("0.5", 20_000), floor_participation="1e-5"),
    "stiff and soft floors": lambda: assess(floor_periods="100," + repeated("0.001", 19)),
    "many shapes": lambda: assess(shapes=repeated("sine", 400_000)),
    "many levels of a hazard curve": lambda: assess(
        pgv=None, records=[RECORD], hazard={key: [*range(1, 300_000)] for key in ("intensity", "annual_rate")}
    ),
    "a table of empty rows": lambda: (
        *("/v1/assess?pga=3&pgv=0.3", CSV, b"width [m],height [m]\n0.3,1.2\n" + b"\n" * 8_000_000),
    ),
    "a table of totals": lambda: (
        *("/v1/assess?pga=3&pgv=0.3", CSV, b"width [m],height [m]\n0.3,1.2\n" + b"sum\n" * 2_000_000),
    ),
    "a form of empty rows": lambda: ("/objects", FILE, b"line-9=1&table=width+[m],height+[m]" + b"%0A" * 4_000_000),
}


def ask(port, method, path, media_type, content):
    """Status and body of the answer."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=180)
    connection.request(method, path, content, {"Content-Type": media_type})
    response = connection.getresponse()
    found = response.status, response.read()
    connection.close()
    return found


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    folder = tmp_path_factory.mktemp("serve")
    with serving(folder, folder / "log", ROCKING_ACCESS_LOG="0") as server:
        for asked in ORDINARY.values():
            while (found := ask(server.port, *asked))[0] == 503:
                pass  # the solver is compiled
            assert found[0] == 200, found
        yield server


def timed(server, kind):
    """Wait of an ordinary question [s]."""
    began = time.monotonic()
    status, found = ask(server.port, *ORDINARY[kind])
    assert status == 200, found
    return time.monotonic() - began


@pytest.mark.alone
@pytest.mark.parametrize(
    "name",
    but_long(
        *(HOSTILE, "a sheet with a cell far out", "an OBJ file of many materials", "many shapes"),
        "a table of empty rows",
    ),
)
def test_an_ordinary_question_does_not_wait(server, name):
    path, media_type, content = HOSTILE[name]()
    with ThreadPoolExecutor(16) as clients:
        uploads = [clients.submit(ask, server.port, "POST", path, media_type, content) for _ in range(CLIENTS)]
        time.sleep(0.5)  # they have arrived
        waits = {kind: clients.submit(timed, server, kind) for kind in ORDINARY}
        assert max(one.result() for one in waits.values()) < SECONDS, {k: one.result() for k, one in waits.items()}
        assert {one.result()[0] for one in uploads} <= {200, 413, 422, 504}
    assert ask(server.port, "GET", "/health", FILE, "")[0] == 200
