"""Under load: queue and time limit of heavy work, clients that go away, counts, ids, and what may be kept."""

import asyncio
import json
import logging
import threading
import time

import httpx2
import pytest
from fastapi.testclient import TestClient
from prometheus_client.parser import text_string_to_metric_families
from starlette.requests import ClientDisconnect

import api.batch_answer
from api.app import create_app
from api.logs import JsonFormatter
from api.settings import Settings
from api.workshop import BusyError, Leave, TimeLimitError, Workshop
from tests.service.conftest import assert_problem, client_of

POINT = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}
BATCH = POINT | {"slenderness": [0.6, 0.7]}


def metrics_of(client):
    """Samples by name and labels."""
    text = client.get("/metrics").text
    return {
        (sample.name, *sorted(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


class Gate:
    """Heavy work that waits to be let through."""

    def __init__(self):
        self.open = threading.Event()
        self.begun = threading.Semaphore(0)

    def work(self, *_):
        self.begun.release()
        assert self.open.wait(30)
        return "done"


def test_beyond_the_queue_work_is_refused_and_the_rest_is_done():
    async def scenario():
        shop, gate = Workshop(workers=1, queue=2, seconds=30), Gate()
        asked = [asyncio.create_task(shop.run(gate.work)) for _ in range(3)]
        await asyncio.to_thread(gate.begun.acquire)
        assert (shop.running, shop.waiting) == (1, 2)
        with pytest.raises(BusyError):
            await shop.run(gate.work)
        gate.open.set()
        assert await asyncio.gather(*asked) == ["done"] * 3
        assert (shop.running, shop.waiting) == (0, 0)

    asyncio.run(scenario())


def test_work_that_cannot_be_stopped_keeps_its_place_after_its_time():
    async def scenario():
        shop, gate = Workshop(workers=1, queue=0, seconds=0.05), Gate()
        with pytest.raises(TimeLimitError, match=r"0\.05 s"):
            await shop.run(gate.work)
        assert shop.running == 1
        with pytest.raises(BusyError):
            await shop.run(gate.work)
        gate.open.set()
        while shop.running:
            await asyncio.sleep(0.001)

    asyncio.run(scenario())


def test_work_in_pieces_stops_when_its_time_is_up():
    async def scenario():
        ended = threading.Event()

        def work(leave):
            try:
                while True:
                    leave.ask()
                    time.sleep(0.001)
            finally:
                ended.set()

        with pytest.raises(TimeLimitError):
            await Workshop(workers=1, queue=0, seconds=0.05).run(work)
        assert await asyncio.to_thread(ended.wait, 5)

    asyncio.run(scenario())


def test_work_stops_when_its_client_goes_away():
    class Gone:
        async def receive(self):
            await asyncio.sleep(0.02)
            return {"type": "http.disconnect"}

    async def scenario():
        stopped = threading.Event()

        def work(leave):
            try:
                while True:
                    leave.ask()
                    time.sleep(0.001)
            except ClientDisconnect:
                stopped.set()

        with pytest.raises(ClientDisconnect):
            await Workshop(workers=1, queue=0, seconds=30).run(work, Gone())
        assert await asyncio.to_thread(stopped.wait, 5)

    asyncio.run(scenario())


def test_leave_is_good_until_it_is_not():
    leave = Leave(60)
    leave.ask()
    leave.withdraw()
    with pytest.raises(ClientDisconnect):
        leave.ask()


def test_a_full_queue_is_503_with_a_hint_and_points_go_on(results, monkeypatch):
    gate = Gate()
    with client_of(results, max_workers=1, max_queue=0) as client:
        client.get("/v1/response", params=POINT)
        shop = client.app.state.service.workshop
        monkeypatch.setattr(api.batch_answer, "ask", lambda *_, **__: gate.work())
        batch = threading.Thread(target=client.post, args=("/v1/response",), kwargs={"json": BATCH})
        batch.start()
        gate.begun.acquire()
        refused = client.post("/v1/response", json=BATCH)
        assert_problem(refused, 503)
        assert int(refused.headers["retry-after"]) > 0
        assert client.get("/v1/response", params=POINT).status_code == 200
        assert client.get("/health").status_code == 200
        assert metrics_of(client)["rocking_heavy_running",] == shop.running == 1
        gate.open.set()
        batch.join()


def test_too_long_is_504(results, monkeypatch):
    monkeypatch.setattr(api.batch_answer, "PIECE", 1)
    with client_of(results, max_seconds=0.2) as client:
        many = POINT | {"slenderness": [0.6] * 100_000, "method": "solver"}
        problem = assert_problem(client.post("/v1/response", json=many), 504)
        assert "0.2 s" in problem["detail"]


def test_batches_in_pieces_are_the_same(client, monkeypatch):
    many = POINT | {"slenderness": [0.05 + 0.009 * k for k in range(101)]}
    whole = client.post("/v1/response", json=many).json()
    monkeypatch.setattr(api.batch_answer, "PIECE", 7)
    assert client.post("/v1/response", json=many).json() == whole


def test_questions_asked_together_have_the_answers_of_questions_asked_alone(results):
    questions = [POINT | {"slenderness": 0.05 + 0.03 * k} for k in range(30)]
    questions += [POINT | {"method": "cube", "slenderness": s} for s in (0.01, 0.6, 0.02)]
    questions += [POINT | {"slenderness": -1.0}, POINT | {"tolerance": -1.0}, POINT | {"pulse": "sinus"}]
    with client_of(results) as client:
        alone = [client.get("/v1/response", params=question) for question in questions]
        calls = _count_calls(client.app.state.service.atlas)
        together = asyncio.run(_all_at_once(client.app, questions))
    assert [answer.status_code for answer in alone] == [status for status, _ in together]
    for one, (_, body) in zip(alone, together, strict=True):
        found = json.loads(body)
        assert found == one.json()
    assert len(calls) < len(questions) / 2


def test_an_error_inside_reaches_all_that_asked(results, monkeypatch):
    with client_of(results) as client:
        monkeypatch.setattr(client.app.state.service.atlas, "is_open", lambda *_: 1 / 0)
        together = asyncio.run(_all_at_once(client.app, [POINT, POINT | {"slenderness": 0.5}]))
    assert [status for status, _ in together] == [500, 500]


def _count_calls(atlas):
    calls, respond = [], atlas.response

    def counted(*args, **kwargs):
        calls.append(args)
        return respond(*args, **kwargs)

    atlas.response = counted
    return calls


async def _all_at_once(app, questions):
    transport = httpx2.ASGITransport(app=app, raise_app_exceptions=False)
    async with httpx2.AsyncClient(transport=transport, base_url="http://service") as client:
        answers = await asyncio.gather(*(client.get("/v1/response", params=question) for question in questions))
    return [(answer.status_code, answer.content) for answer in answers]


def test_metrics_count_requests_and_points_by_source(results):
    with client_of(results) as client:
        client.get("/v1/response", params=POINT)
        client.get("/v1/response", params=POINT | {"method": "solver"})
        client.post("/v1/response", json=BATCH | {"slenderness": [0.6, 0.6, 1.5]})
        client.get("/v1/response")
        client.get("/v1/datasets/no/such")
        client.get("/no/such/route")
        found = metrics_of(client)
    assert found["rocking_requests_total", "/v1/response", "200", "GET"] == 2
    assert found["rocking_requests_total", "/v1/response", "200", "POST"] == 1
    assert found["rocking_requests_total", "/v1/response", "422", "GET"] == 1
    assert found["rocking_requests_total", "/v1/datasets/{name:path}", "404", "GET"] == 1
    assert found["rocking_requests_total", "404", "GET", "none"] == 1
    assert found["rocking_points_total", "cube"] == 3
    assert found["rocking_points_total", "solver"] == 2
    assert found["rocking_request_seconds_count", "/v1/response"] == 4
    assert found["rocking_heavy_running",] == found["rocking_heavy_waiting",] == 0


@pytest.mark.parametrize("sane", ["a", "7f3c-1.B_", "x" * 64])
def test_a_sane_request_id_comes_back(client, sane):
    assert client.get("/health", headers={"X-Request-ID": sane}).headers["x-request-id"] == sane


@pytest.mark.parametrize("odd", ["", "x" * 65, "a b", '"', "a;b"])
def test_another_one_is_made_in_place_of_an_odd_one(client, odd):
    made = [client.get("/health", headers={"X-Request-ID": odd}).headers["x-request-id"] for _ in range(2)]
    assert made[0] != made[1]
    assert odd not in made
    assert client.get("/nowhere").headers["x-request-id"]


def test_every_request_is_a_line_in_the_log(client, caplog):
    with caplog.at_level(logging.INFO, "rocking.access"):
        client.get("/v1/response", params=POINT, headers={"X-Request-ID": "mine"})
    line = json.loads(JsonFormatter().format(caplog.records[-1]))
    assert (line["request_id"], line["status"], line["path"]) == ("mine", 200, "/v1/response")
    assert line["query"].startswith("pulse=sine&")
    assert line["milliseconds"] > 0
    assert line["bytes"] > 100


def test_an_error_leaves_its_traceback_and_its_id_in_the_log(results, caplog):
    app = create_app(Settings(results=results))

    @app.get("/broken")
    async def broken():
        raise ZeroDivisionError

    with TestClient(app) as client, caplog.at_level(logging.ERROR, "rocking.service"):
        assert_problem(client.get("/broken", headers={"X-Request-ID": "mine"}), 500)
    line = json.loads(JsonFormatter().format(caplog.records[-1]))
    assert line["request_id"] == "mine"
    assert "ZeroDivisionError" in line["traceback"]


def test_answers_may_be_kept_a_minute_and_are_known_again(client):
    answer = client.get("/v1/response", params=POINT)
    assert answer.headers["cache-control"] == "max-age=60"
    again = client.get("/v1/response", params=POINT, headers={"If-None-Match": answer.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")
    other = client.get("/v1/response", params=POINT | {"slenderness": 0.61})
    assert other.headers["etag"] != answer.headers["etag"]
    assert "etag" not in client.get("/v1/response").headers


def test_a_version_of_a_data_set_may_be_kept_for_ever(client):
    entry = client.get("/v1/datasets").json()["datasets"][0]
    kept = client.get(entry["version"])
    assert "immutable" in kept.headers["cache-control"]
    assert kept.headers["etag"] == f'"{entry["sha256"]}"'
    assert client.get(entry["netcdf"]).headers["cache-control"] == "no-cache"
    gone = entry["version"].replace(entry["sha256"], "0" * 64)
    assert entry["sha256"] in assert_problem(client.get(gone), 404)["detail"]
