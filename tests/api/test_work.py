"""Threads for work: the limits of the queue and of the time, disconnects, and cheap work beside dear work."""

import asyncio
import sys
import threading
import time
from collections import Counter
from pathlib import Path

import anyio
import pytest
import rocking_api
from rocking_api.app import create_app
from rocking_api.execution.helper import Helper
from rocking_api.execution.work import BusyError, TimeLimitError, Workers
from rocking_api.settings import Settings
from starlette.requests import ClientDisconnect

import rocking
from rocking._base.errors import InvalidArgumentError, one_of
from tests.api.conftest import CSV, POINT, QUERIES, assert_problem, client_of, of_point, post
from tests.api.in_process import answer_in_process

BATCH = POINT | {"slenderness": [0.6, 0.7]}


class Gate:
    """Work that blocks until it is released."""

    def __init__(self):
        self.open, self.begun = threading.Event(), threading.Semaphore(0)

    def work(self, *_):
        self.begun.release()
        assert self.open.wait(30)
        return "done"


def test_beyond_the_queue_work_is_refused():
    async def scenario():
        gate, workers = Gate(), Workers(1, queue=1, seconds=30)
        tasks = [asyncio.create_task(workers.run(gate.work)) for _ in range(2)]
        await asyncio.to_thread(gate.begun.acquire)
        with pytest.raises(BusyError):
            await workers.run(gate.work)
        gate.open.set()
        return await asyncio.gather(*tasks)

    assert asyncio.run(scenario()) == ["done", "done"]


def test_what_waits_beyond_the_time_limit_ends_in_the_queue():
    async def scenario():
        gate, workers = Gate(), Workers(1, queue=1, seconds=0.2)
        running = asyncio.create_task(workers.run(gate.work))
        await asyncio.to_thread(gate.begun.acquire)
        with pytest.raises(TimeLimitError):
            await workers.run(gate.work)
        gate.open.set()
        await asyncio.gather(running, return_exceptions=True)

    asyncio.run(scenario())


def slow_search(stop):
    """An elastic block under a slow pulse: half a minute of impacts."""
    return rocking.thresholds("c2", frequency_ratio=0.05, restitution=1.0, alpha=0.2, stop=stop)


class Gone:
    """A request whose client disconnects soon."""

    async def receive(self):
        await asyncio.sleep(0.2)
        return {"type": "http.disconnect"}


@pytest.mark.parametrize(
    ("seconds", "request_", "error"),
    [(0.2, None, TimeLimitError), (30, Gone(), ClientDisconnect)],
    ids=["time", "gone"],
)
def test_the_thread_is_free_soon_after_timeout_or_disconnect(seconds, request_, error):
    rocking.peak_response("c2", slenderness=0.5, frequency_ratio=1.0, restitution=0.9, alpha=0.2)  # compiled

    async def scenario():
        workers = Workers(1, queue=0, seconds=seconds)
        began = time.process_time()
        with pytest.raises(error):
            await workers.run(slow_search, request_)
        assert workers.running == 0
        return time.process_time() - began

    assert asyncio.run(scenario()) < 1.0


def test_beside_dear_work_cheap_work_is_done_and_more_dear_work_is_503(results, monkeypatch):
    gate = Gate()
    with client_of(results, max_workers=1, max_queue=0) as client:
        client.get("/v1/response", params=POINT)
        monkeypatch.setattr("rocking_api.routers.curves.evaluate_many", gate.work)
        spectrum = QUERIES["/v1/spectrum"]
        dear = threading.Thread(target=client.get, args=("/v1/spectrum",), kwargs={"params": spectrum})
        dear.start()
        gate.begun.acquire()
        refused = client.get("/v1/spectrum", params=spectrum)
        assert_problem(refused, 503)
        assert int(refused.headers["retry-after"]) > 0
        assert client.get("/v1/response", params=POINT).status_code == 200
        assert client.get("/v1/blocks/response", params=QUERIES["/v1/blocks/response"]).status_code == 200
        assert client.post("/v1/response", json=BATCH).status_code == 200
        assert client.get("/health").status_code == 200
        gate.open.set()
        dear.join()


def test_work_beyond_the_time_limit_is_504(results, monkeypatch):
    monkeypatch.setattr("rocking_api.execution.evaluation.CHUNK_SIZE", 1)
    with client_of(results, max_seconds=0.2) as client:
        client.get("/v1/response", params=POINT)
        columns = "slenderness\n" + "0.6\n" * 20_000
        slow = post(client, "/v1/response", columns, CSV, **of_point("slenderness"), method="solver")
        assert "0.2 s" in assert_problem(slow, 504)["detail"]


@pytest.mark.parametrize(
    ("read", "arguments", "allowed"),
    [
        (time.sleep, (60.0,), "within 1 s"),
        (bytearray, (3 * 1024**3,), "MiB"),
        (int, ("x",), "ValueError"),
        (one_of, ("mesh", "open", ["closed"]), "one of closed"),
    ],
)
def test_a_file_that_exceeds_the_limits_of_the_helper_is_refused_and_the_next_one_is_read(
    monkeypatch, read, arguments, allowed
):
    async def scenario():
        helper = Helper()
        assert await helper.read("mesh", "a.stl", len, b"123") == 3  # it is started
        if read is time.sleep:
            monkeypatch.setattr("rocking_api.execution.helper.SECONDS", 1)
        with pytest.raises(InvalidArgumentError, match=allowed):
            await helper.read("mesh", "a.stl", read, *arguments)
        monkeypatch.undo()
        assert await helper.read("mesh", "a.stl", len, b"1234") == 4

    anyio.run(scenario)


ROOTS = tuple(str(Path(one.__file__).parent) for one in (rocking, rocking_api))


@pytest.mark.parametrize(("method", "most"), [("cube", 80), ("solver", 60)])
def test_one_block_is_little_work(results, method, most):
    found, seconds = Counter(), []
    query = f"pulse=sine&slenderness=0.413&frequency_ratio=5.1&restitution=0.85&method={method}"

    def count(frame, event, _):
        if event == "call" and frame.f_code.co_filename.startswith(ROOTS):
            found[frame.f_code.co_filename] += 1

    async def scenario():
        app = create_app(Settings(results=results))
        async with app.router.lifespan_context(app):
            await app.state.service.kernels.wait()
            for _ in range(200):
                began = time.process_time()
                assert await answer_in_process(app, "/v1/response", query) == 200
                seconds.append(time.process_time() - began)
            sys.setprofile(count)
            try:
                await answer_in_process(app, "/v1/response", query)
            finally:
                sys.setprofile(None)

    asyncio.run(scenario())
    assert found.total() <= most, found
    assert min(seconds) < 1.2e-3  # others use the same processors
