"""A server with slow, malformed and impatient clients, and its start and end."""

import json
import re
import socket
import threading
import time
from contextlib import suppress

import httpx2
import pytest

from tests.api.servers import serving

POINT = "/v1/response?pulse=sine&slenderness=0.6&frequency_ratio=6&restitution=0.85"


@pytest.fixture(scope="module")
def server(results, tmp_path_factory):
    limits = {"ROCKING_ARRIVAL_SECONDS": "1", "ROCKING_MAX_BODY_BYTES": "100000"}
    with serving(results, tmp_path_factory.mktemp("serve") / "log", **limits) as server:
        httpx2.get(server.address + POINT)  # the kernels are loaded
        yield server


@pytest.fixture
def connection(server):
    with socket.create_connection(("127.0.0.1", server.port), timeout=20) as connection:
        yield connection


def answer_of(connection, said):
    """Status, head and body of what comes until the server closes the connection."""
    received = bytearray()
    connection.sendall(said if isinstance(said, bytes) else said.encode())
    with suppress(ConnectionResetError):  # closed while the client was sending
        while part := connection.recv(65536):
            received += part
    head, _, body = bytes(received).partition(b"\r\n\r\n")
    return (int(head.split()[1]) if head else None), head.lower(), body


POST = "POST /v1/response HTTP/1.1\r\nHost: x\r\n"


@pytest.mark.alone
def test_slow_clients_do_not_delay_others(server):
    slow = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(200)]
    try:
        for one in slow:
            one.sendall(f"{POST}Content-Length: 1000\r\n\r\n{{".encode())
        began = time.monotonic()
        assert httpx2.get(server.address + POINT).status_code == 200
        assert time.monotonic() - began < 0.9  # before the others time out
    finally:
        for one in slow:
            one.close()


def test_a_body_that_does_not_arrive_is_408(connection):
    status, _, body = answer_of(connection, f"{POST}Content-Length: 1000\r\n\r\n{{")
    assert status == 408
    assert json.loads(body)["parameter"] == "body"


@pytest.mark.parametrize(
    ("said", "status"),
    [
        (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(200), 400),  # another protocol
        (f"{POST}Content-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400),
        (f"{POST}Connection: close\r\nContent-Length: 9999999999999999\r\n\r\n", 413),  # not waited for
        ("GET /health HTTP/1.0\r\n\r\n", 200),  # needs no host
    ],
)
def test_what_is_not_http_and_what_is_too_long_is_refused(connection, said, status):
    assert answer_of(connection, said)[0] == status


def test_start_limit_of_connections_and_shutdown(results, tmp_path):
    """The start opens no cube; what runs at the end is finished."""
    with serving(results, tmp_path / "log", ROCKING_MAX_CONNECTIONS="5") as server:
        assert httpx2.get(server.address + "/health").status_code == 200
        # three seconds on a quiet machine: `python -m benchmarks.cost.service` measures it
        assert time.clock_gettime((~server.process.pid << 3) | 2) < 5  # of its processor time
        idle = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(5)]
        refused = httpx2.get(server.address + "/health")
        for one in idle:
            one.close()
        assert refused.status_code == 503
        deadline = time.monotonic() + 40
        while httpx2.get(server.address + POINT, timeout=60).status_code != 200:
            assert time.monotonic() < deadline
        responses = []
        curves = "/v1/overturning?pulse=sine&restitution=0.77"  # traced on request: some tenths of a second
        asking = threading.Thread(target=lambda: responses.append(httpx2.get(server.address + curves, timeout=60)))
        asking.start()
        time.sleep(0.1)
        status = server.stop()
        asking.join()
    assert [response.status_code for response in responses] == [200]
    assert status in (0, -15)
    assert "Traceback" not in server.log.read_text()


def test_every_request_is_a_line_in_the_log_and_none_an_error(server):
    httpx2.get(server.address + POINT + "&alpha_deg=0")
    time.sleep(0.1)
    assert "Traceback" not in server.log.read_text()
    (ours,) = [line for line in server.log.read_text().splitlines() if "&alpha_deg=0" in line]
    assert re.fullmatch(r"[-0-9:, ]+ INFO uvicorn.access: 127.0.0.1:\d+ - \"GET /v1/response\?\S+ HTTP/1.1\" 200", ours)


def test_a_redirect_of_the_guide_does_not_repeat_the_host(connection):
    said = "GET /static HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n"
    _, head, _ = answer_of(connection, said)
    assert b"evil" not in head
