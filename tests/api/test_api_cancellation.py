"""A client that closes its connection: the work for it stops."""

import json
import socket
import time

import httpx2
import pytest

from tests.api.servers import Stopwatch, serving

OBJECTS = [{"width": 0.2 + 0.001 * k, "depth": 0.3, "height": 1.6 + 0.001 * k} for k in range(1000)]
ELASTIC = {"pulse": "c2", "restitution": 1.0, "alpha_deg": 12.0}
LONG = {
    "/v1/assess": {"objects": OBJECTS, "pga": 3.0, "pgv": 0.3, "samples": 20_000},
    "/v1/thresholds": ELASTIC | {"frequency_ratio": 0.02},
    "/v1/overturning": ELASTIC,
}


@pytest.fixture(scope="module")
def server(results, tmp_path_factory):
    with serving(results, tmp_path_factory.mktemp("serve") / "log") as server:
        point = "/v1/response?pulse=sine&slenderness=0.6&frequency_ratio=6&restitution=0.85"
        httpx2.get(server.address + point, timeout=120)  # the kernels are loaded
        yield server


def running(server):
    return "rocking_heavy_running 1.0" in httpx2.get(server.address + "/metrics").text


@pytest.mark.alone
@pytest.mark.parametrize("route", LONG)
def test_work_stops_within_a_second_after_the_client_has_left(server, route):
    body = json.dumps(LONG[route]).encode()
    head = f"POST {route} HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n"
    with socket.create_connection(("127.0.0.1", server.port)) as client:
        client.sendall(head.encode() + body)
        deadline = time.monotonic() + 30.0
        while not running(server):
            assert time.monotonic() < deadline
        # it is still being computed a second later: what stops it below is not its end
        client.settimeout(1.0)
        with pytest.raises(TimeoutError):
            client.recv(1)
        assert running(server)
    since_closed = Stopwatch(server.process.pid)
    while running(server):
        assert since_closed.seconds() < 1.0
