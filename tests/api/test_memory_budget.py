"""Memory that the service holds for its clients, and for how long."""

import asyncio
import http.client
import json
import socket
import threading
import time
from contextlib import suppress
from functools import lru_cache, partial
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from rocking_api.execution.executor import BusyError
from rocking_api.http.encoding import MEDIA_TYPES
from rocking_api.http.memory_budget import CHUNK_BYTES, MemoryBudget, MemoryBudgetMiddleware, Reservation

from tests.api.conftest import assert_problem, client_of
from tests.api.servers import serving

POINT = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}
HISTORY = "/v1/history?pulse=sine&slenderness=0.4&frequency_ratio=5&restitution=0.85&samples=100000"
CLIENTS = 20


def test_beyond_the_limit_others_are_refused_but_a_single_request_is_not():
    total = MemoryBudget(100)
    one, other = Reservation(total), Reservation(total)
    one.add(60)
    other.add(40)
    for reservation in (one, other):
        with pytest.raises(BusyError):
            reservation.add(1)
    other.replace(0)
    one.add(1000)  # alone
    assert total.held == 1060
    one.replace(0)
    assert total.held == 0


def test_a_reservation_can_be_replaced():
    total = MemoryBudget(100)
    one, other = Reservation(total), Reservation(total)
    one.add(60)
    other.add(30)
    one.replace(20)
    other.add(50)
    assert total.held == 100
    with pytest.raises(BusyError):
        one.replace(21)
    one.replace(0)
    other.replace(1000)  # alone
    assert total.held == 1000


def sent_through(layer_of, body):
    """The messages of a response."""
    messages = []

    async def app(_, __, send):
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": body})

    async def send(message):
        messages.append(message)

    asyncio.run(layer_of(app)({"type": "http", "headers": []}, None, send))
    return messages


@pytest.mark.parametrize(
    "size", [0, 1, CHUNK_BYTES - 1, CHUNK_BYTES, CHUNK_BYTES + 1, 3 * CHUNK_BYTES, 3 * CHUNK_BYTES + 7]
)
def test_large_responses_are_sent_in_chunks(size):
    body = bytes(k % 251 for k in range(size))
    total = MemoryBudget(10 * CHUNK_BYTES)
    head, *parts = sent_through(lambda app: MemoryBudgetMiddleware(app, total, 9.0), body)
    assert head["status"] == 200
    assert b"".join(part["body"] for part in parts) == body
    assert [part.get("more_body", False) for part in parts] == [True] * (len(parts) - 1) + [False]
    assert max(len(part["body"]) for part in parts) <= CHUNK_BYTES
    assert total.held == 0


def test_a_response_beyond_the_limit_is_503():
    total = MemoryBudget(10)
    Reservation(total).add(10)
    head, part = sent_through(lambda app: MemoryBudgetMiddleware(app, total, 9.0), bytes(2 * CHUNK_BYTES))
    assert head["status"] == 503
    assert (b"retry-after", b"2") in head["headers"]
    assert b"retry" in part["body"]
    assert total.held == 10
    head, _ = sent_through(lambda app: MemoryBudgetMiddleware(app, total, 9.0), b"small")
    assert head["status"] == 200


def test_a_body_beyond_the_limit_is_503(results):
    with client_of(results, max_bytes_in_flight=50) as client:
        other = Reservation(client.app.state.service.memory_budget)
        other.add(1)
        refused = client.post("/v1/response", json=POINT)
        assert_problem(refused, 503)
        assert int(refused.headers["retry-after"]) > 0
        assert client.get("/v1/response", params=POINT).status_code == 200
        other.replace(0)
        assert client.post("/v1/response", json=POINT).status_code == 200
        assert client.app.state.service.memory_budget.held == 0


@pytest.fixture(scope="module")
def server(results, tmp_path_factory):
    limits = {"ROCKING_ARRIVAL_SECONDS": "2", "ROCKING_READING_SECONDS": "2", "ROCKING_MAX_QUEUE": str(CLIENTS)}
    with serving(results, tmp_path_factory.mktemp("serve") / "log", **limits) as server:
        read(server)  # memory needed for any response
        yield server


def read(server):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    connection.request("GET", HISTORY)
    size = len(connection.getresponse().read())
    connection.close()
    return size


def half_a_body(connection, size=60_000_000):
    connection.sendall(b"POST /v1/response HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % size)
    block = b" " * 1_000_000
    for _ in range(size // len(block) - 1):
        connection.sendall(block)


def no_reading(connection):
    connection.sendall(b"GET %s HTTP/1.1\r\nHost: x\r\n\r\n" % HISTORY.encode())


def no_reading_of_many(connection):
    """Many small responses that are not read."""
    connection.sendall(b"GET /openapi.json HTTP/1.1\r\nHost: x\r\n\r\n" * 500)


POINTS = 500_000


def batch(form):
    """A body of many points, and its type."""
    random = np.random.default_rng(POINTS)
    columns = {"slenderness": random.uniform(0.05, 0.95, POINTS), "frequency_ratio": random.uniform(0.5, 12.0, POINTS)}
    if form == "json":  # of four megabytes
        lists = {name: values[:100_000].tolist() for name, values in columns.items()}
        return json.dumps({"pulse": "sine", "restitution": 0.85, **lists}).encode(), "", MEDIA_TYPES[form]
    options = "?pulse=sine&restitution=0.85"
    if form == "nc":
        variables = {name: ("point", values) for name, values in columns.items()}
        return bytes(xr.Dataset(variables).to_netcdf(engine="scipy")), options, MEDIA_TYPES[form]
    rows = "".join(f"{s!r},{w!r}\n" for s, w in zip(*(values.tolist() for values in columns.values()), strict=True))
    return f"slenderness,frequency_ratio\n{rows}".encode(), options, MEDIA_TYPES[form]


BATCHES = lru_cache(batch)


def no_reading_of_a_batch(connection, form):
    body, options, media_type = BATCHES(form)
    head = f"POST /v1/response{options} HTTP/1.1\r\nHost: x\r\nContent-Type: {media_type}\r\n"
    connection.sendall(f"{head}Content-Length: {len(body)}\r\n\r\n".encode())
    connection.sendall(body)


BEHAVIOURS = {
    "half a body": half_a_body,
    "history": no_reading,
    "many small answers": no_reading_of_many,
    **{f"batch as {form}": partial(no_reading_of_a_batch, form=form) for form in MEDIA_TYPES},
}


def megabytes(process):
    (line,) = [line for line in Path(f"/proc/{process.pid}/status").read_text().splitlines() if "VmRSS" in line]
    return int(line.split()[1]) / 1024


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads /proc of Linux")
@pytest.mark.parametrize("behaviour", BEHAVIOURS)
def test_clients_that_do_not_send_or_read_use_little_memory_for_a_short_time(server, behaviour):
    if behaviour.startswith("batch"):
        BATCHES(behaviour.rpartition(" ")[2])
    before = most = megabytes(server.process)
    dropped = threading.Event()

    def client():
        with socket.socket() as connection, suppress(OSError):  # disconnected while sending
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.settimeout(60)
            connection.connect(("127.0.0.1", server.port))
            BEHAVIOURS[behaviour](connection)
            dropped.wait()

    clients = [threading.Thread(target=client) for _ in range(CLIENTS)]
    for one in clients:
        one.start()
    began = time.monotonic()
    try:
        while time.monotonic() - began < 4 or read(server) < 5e6:  # refused while the memory is in use
            most = max(most, megabytes(server.process))
            assert time.monotonic() - began < 30  # 2 s each, and the time of the work on a busy machine
            time.sleep(0.05)
    finally:
        dropped.set()
        for one in clients:
            one.join()
    assert most - before < 250


def test_a_slow_client_that_reads_is_served(server):
    with socket.socket() as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        connection.connect(("127.0.0.1", server.port))
        connection.settimeout(10)
        connection.sendall(b"GET %s HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n" % HISTORY.encode())
        received, began = 0, time.monotonic()
        while part := connection.recv(65536):
            received += len(part)
            if time.monotonic() - began < 3.5:  # longer than the time limit of a client that reads nothing
                time.sleep(0.2)
    assert received > 5e6
