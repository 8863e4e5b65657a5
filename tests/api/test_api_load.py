"""Under load: queue limit and time limit of heavy work, disconnects, and how little work one block is."""

import asyncio
import re
import statistics
import sys
import threading
import time
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import rocking_api
import rocking_api.execution.evaluation
from rocking_api.app import create_app
from rocking_api.execution.executor import BoundedExecutor, BusyError, TimeLimitError
from rocking_api.models.batch import batch_of, parse_csv
from rocking_api.models.params import LookupOptions, ResponseParams
from rocking_api.models.pulses import MAX_SAMPLES
from rocking_api.routers.response import get_response
from rocking_api.settings import Settings
from starlette.requests import ClientDisconnect

import rocking
from rocking._base.errors import StoppedError
from rocking._numba.cancellation import StopFlag
from tests.api.conftest import CSV, POINT, QUERIES, assert_problem, client_of, metrics_of, of_point, post, until
from tests.api.fuzzer import Sent, exchange
from tests.sampling import number

BATCH = POINT | {"slenderness": [0.6, 0.7]}


class Gate:
    """Heavy work that blocks until it is released, and an executor for it."""

    def __init__(self, queue=0):
        self.open, self.begun = threading.Event(), threading.Semaphore(0)
        self.executor = BoundedExecutor(workers=1, queue=queue, seconds=30)

    def work(self, *_):
        self.begun.release()
        assert self.open.wait(30)
        return "done"

    def asked(self, host, cost=0, work=None):
        """A task for a client that stays."""
        return asyncio.create_task(self.executor.run(work or self.work, of_client(host), cost))


def of_client(host):
    """A request of a client that stays."""
    return SimpleNamespace(client=SimpleNamespace(host=host), receive=asyncio.Event().wait)


def test_clients_take_turns_and_the_cheapest_of_each_is_first():
    async def scenario():
        gate, order = Gate(queue=6), []

        def work(name):
            return lambda _: (time.sleep(0.01), order.append(name))

        tasks = [gate.asked("a")]
        await asyncio.to_thread(gate.begun.acquire)
        asked = [("a", "a dear", 9), ("a", "a cheap", 1), ("a", "a middling", 5), ("b", "b", 99), ("c", "c", 99)]
        tasks += [gate.asked(client, cost, work(name)) for client, name, cost in asked]
        await asyncio.sleep(0.01)
        gate.open.set()
        await asyncio.gather(*tasks)
        return order

    assert asyncio.run(scenario()) == ["b", "c", "a cheap", "a middling", "a dear"]


def test_one_client_does_not_fill_the_queue():
    async def scenario():
        gate = Gate(queue=3)
        tasks = [gate.asked("a", cost) for cost in range(4)]
        await asyncio.to_thread(gate.begun.acquire)
        with pytest.raises(BusyError):
            await gate.asked("a")
        other = gate.asked("b", 100)
        with pytest.raises(BusyError):  # the dearest of the client with the most
            await tasks[-1]
        gate.open.set()
        return await asyncio.gather(*tasks[:-1], other)

    assert asyncio.run(scenario()) == ["done"] * 4


def test_short_work_does_not_wait_for_long_work(monkeypatch):
    monkeypatch.setattr("rocking_api.execution.executor.TRIAL_SECONDS", 0.05)

    def long(stop):
        starts.append(time.monotonic())
        while not release.is_set():
            stop.check()
            time.sleep(0.001)
        return "long"

    async def scenario():
        executor = BoundedExecutor(workers=1, queue=9, seconds=30, trials=True)
        tasks = [asyncio.create_task(executor.run(long, of_client("a"))) for _ in range(3)]
        await asyncio.sleep(0.01)
        short = await executor.run(lambda _: "short", of_client("a"), cost=10**9)
        assert len(starts) == 3  # each has had its trial, or runs
        assert (executor.running, executor.waiting) == (1, 2)
        release.set()
        return short, await asyncio.gather(*tasks)

    starts, release = [], threading.Event()
    assert asyncio.run(scenario()) == ("short", ["long"] * 3)
    assert len(starts) == 5  # two of them anew


def test_work_that_ignores_the_stop_flag_keeps_its_worker():
    async def scenario():
        executor, gate = BoundedExecutor(workers=1, queue=0, seconds=0.05), Gate()
        with pytest.raises(TimeLimitError, match=r"0\.05 s"):
            await executor.run(gate.work)
        assert executor.running == 1
        with pytest.raises(BusyError):
            await executor.run(gate.work)
        gate.open.set()
        while executor.running:
            await asyncio.sleep(0.001)

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
        executor = BoundedExecutor(workers=1, queue=0, seconds=seconds)
        with pytest.raises(error):
            await executor.run(slow_search, request_)
        began = time.process_time()
        while executor.running:
            await asyncio.sleep(0.001)
        return time.process_time() - began

    assert asyncio.run(scenario()) < 0.1


def test_a_full_queue_is_503_with_retry_after_and_single_blocks_are_served(results, monkeypatch):
    gate = Gate()
    with client_of(results, max_workers=1, max_queue=0) as client:
        client.get("/v1/response", params=POINT)
        executor = client.app.state.service.executor
        monkeypatch.setattr(rocking_api.execution.evaluation, "evaluate", lambda *_, **__: gate.work())
        batch = threading.Thread(target=client.post, args=("/v1/response",), kwargs={"json": BATCH})
        batch.start()
        gate.begun.acquire()
        refused = client.post("/v1/response", json=BATCH)
        assert_problem(refused, 503)
        assert int(refused.headers["retry-after"]) > 0
        assert client.get("/v1/response", params=POINT).status_code == 200
        assert client.get("/health").status_code == 200
        assert metrics_of(client)["rocking_heavy_running",] == executor.running == 1
        gate.open.set()
        batch.join()


def test_what_is_wrong_is_refused_before_queueing(results):
    """With a full queue a valid request is refused with 503, an invalid one with 422; of queries in test_openapi.py."""
    options, body = of_point("slenderness"), "slenderness\n{}\n"
    with client_of(results) as client:
        client.app.state.service.executor._capacity = 0
        for path, query in QUERIES.items():
            assert path == "/v1/response" or assert_problem(client.get(path, params=query), 503)
        assert_problem(client.post("/v1/response", json=BATCH), 503)
        assert_problem(post(client, "/v1/response", body.format(0.6), CSV, **options), 503)
        for name, value in {"pulse": "sinus", "restitution": -1.0, "alpha_deg": 95.0}.items():
            assert_problem(client.post("/v1/response", json=BATCH | {name: value}), 422, name)
            assert_problem(post(client, "/v1/response", body.format(0.6), CSV, **options | {name: value}), 422, name)
        assert_problem(post(client, "/v1/response", body.format(-1), CSV, **options), 422, "slenderness")


def test_work_beyond_the_time_limit_is_504(results, monkeypatch):
    monkeypatch.setattr(rocking_api.execution.evaluation, "CHUNK_SIZE", 1)
    objects = [{"name": "vase", "width": 0.16, "height": 0.9}]
    with client_of(results, max_seconds=0.2) as client:
        many = POINT | {"slenderness": [0.6] * 100_000, "method": "solver"}
        assert "0.2 s" in assert_problem(client.post("/v1/response", json=many), 504)["detail"]
        samples = {"acceleration": np.random.default_rng(1).uniform(-1, 1, MAX_SAMPLES).tolist(), "period": 10.0}
        for path in ("/v1/map", "/v1/overturning"):
            given = {"pulse": samples, "restitution": 0.85, "alpha_deg": 20.0}
            assert_problem(client.post(path, json=given), 504)
    with client_of(results, max_seconds=0.001) as client:
        hurried = client.post("/v1/assess?pga=3&period_min=0.1&period_max=2", json=objects)
        assert hurried.status_code in (503, 504)


@pytest.mark.alone
def test_curves_of_an_elastic_block_end_early_and_the_answer_says_what_to_ask_instead(results):
    query = {"pulse": "c2", "restitution": 1.0, "alpha_deg": 10.0}
    with client_of(results, max_seconds=6.0) as client:
        client.get("/v1/response", params=POINT)  # waits for the solver
        began = time.monotonic()
        detail = assert_problem(client.get("/v1/overturning", params=query), 504)["detail"]
        assert time.monotonic() - began < 4.0
        assert "time limit of 1 s" in detail
        instead = re.search(r"ask for the outcomes on a grid, (\S+),", detail)[1]
        assert client.get(f"{instead}&columns=4&rows=4").status_code == 200
        until(lambda: not client.app.state.service.executor.running, 5)


def test_blocks_with_many_impacts_do_not_block_the_event_loop(results):
    """One of them takes a sixth of a second, computed twice; a pause of the machine is no pause of the loop."""
    elastic = {"pulse": "c2", "slenderness": 1 - 1e-7, "frequency_ratio": 0.05, "restitution": 1.0, "alpha_deg": 11.0}
    with client_of(results) as client:
        client.get("/v1/response", params=POINT)

        async def scenario():
            task = asyncio.create_task(get_response(ResponseParams(**elastic), client.app.state.service))
            longest, before = 0.0, time.perf_counter()
            while not task.done():
                await asyncio.sleep(0.001)
                longest, before = max(longest, time.perf_counter() - before), time.perf_counter()
            assert (await task).source == "solver"
            return longest

        assert any(asyncio.run(scenario()) < 0.1 for _ in range(3))


class Clock(StopFlag):
    """Notes the processor time of the thread at each look at the flag, and sets it at one of them."""

    def __init__(self, last=None):
        super().__init__()
        self.times = [time.thread_time()]
        self.last = last

    def check(self):
        self.times.append(time.thread_time())
        if len(self.times) == self.last:
            self.set()
        super().check()


def test_a_table_of_a_million_points_is_read_whole_and_its_reading_can_be_stopped():
    points, random = number(600_000, 1_000_000), np.random.default_rng(1)
    table = {name: random.uniform(0.05, 0.95, points) for name in ("slenderness", "frequency_ratio")}
    rows = zip(*(values.tolist() for values in table.values()), strict=True)
    body = (",".join(table) + "\n" + "".join(f"{s!r},{w!r}\n" for s, w in rows)).encode()
    clock, stopped = Clock(), Clock(last=5)
    found = batch_of(LookupOptions(pulse="sine"), parse_csv(body, points, clock), {"restitution": 0.85}, points)
    clock.times.append(time.thread_time())
    for name, values in table.items():
        np.testing.assert_array_equal(found.groups[name], values)
    assert len(clock.times) > 50
    assert max(np.diff(clock.times)) < 0.1
    with pytest.raises(StoppedError):
        parse_csv(body, points, stopped)
    assert len(stopped.times) == 5


ROOTS = tuple(str(Path(one.__file__).parent) for one in (rocking, rocking_api))


@pytest.mark.parametrize(("method", "most"), [("cube", 60), ("solver", 40)])
def test_one_block_is_little_work(results, method, most):
    found, seconds = Counter(), []
    query = f"pulse=sine&slenderness=0.413&frequency_ratio=5.1&restitution=0.85&method={method}"
    sent = Sent("GET", "/v1/response", query, [], b"", False)

    def count(frame, event, _):
        if event == "call" and frame.f_code.co_filename.startswith(ROOTS):
            found[frame.f_code.co_filename] += 1

    async def scenario():
        app = create_app(Settings(results=results))
        async with app.router.lifespan_context(app):
            await app.state.service.kernels.wait()
            for _ in range(200):
                began = time.process_time()
                assert (await exchange(app, sent)).status == 200
                seconds.append(time.process_time() - began)
            sys.setprofile(count)
            try:
                await exchange(app, sent)
            finally:
                sys.setprofile(None)

    asyncio.run(scenario())
    assert found.total() <= most, found
    assert len(found) <= 15, found
    assert statistics.median(seconds) < 1e-3
