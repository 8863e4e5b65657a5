"""Under load: queue and time limit of heavy work, clients that go away, questions that arrive together."""

import asyncio
import json
import threading
import time

import httpx2
import pytest
from starlette.requests import ClientDisconnect

import api.batch_answer
from api.questions import ResponseQuestion
from api.together import Together
from api.workshop import BusyError, Leave, TimeLimitError, Workshop, attempt
from rocking.errors import in_range
from tests.service.conftest import assert_problem, client_of
from tests.service.test_api_observed import metrics_of

POINT = {"pulse": "sine", "slenderness": 0.6, "frequency_ratio": 6.0, "restitution": 0.85}
BATCH = POINT | {"slenderness": [0.6, 0.7]}


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


def test_work_of_the_package_stops_when_its_time_is_up():
    async def scenario():
        ended = threading.Event()

        def work():
            try:
                while True:
                    in_range("any", 1.0, 0.0, 2.0)
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

        def work():
            try:
                while True:
                    in_range("any", 1.0, 0.0, 2.0)
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


@pytest.mark.parametrize("path", ["/v1/critical_amplitude", "/v1/overturning"])
def test_a_search_that_takes_too_long_is_504_and_leaves_its_place(results, path):
    """An elastic block under a slow pulse has changes of fate without number: it takes half a minute."""
    question = {"pulse": "c2", "restitution": 1.0, "alpha_deg": 12.0}
    if path == "/v1/critical_amplitude":
        question["frequency_ratio"] = 0.05
    with client_of(results, max_seconds=0.3) as client:
        assert_problem(client.get(path, params=question), 504)
        began = time.monotonic()
        while client.app.state.service.workshop.running:
            time.sleep(0.01)
            assert time.monotonic() - began < 5.0


def test_a_part_of_the_work_may_have_an_end_of_its_own():
    def work():
        return in_range("x", 1.0, 0.0, 2.0)  # a function of the package

    def both():
        return attempt(work, 0.0), attempt(work, 10.0)

    assert attempt(work, 10.0) == 1.0
    assert asyncio.run(Workshop(1, 0, 10.0).run(both)) == (None, 1.0)
    assert attempt(lambda: (attempt(work, 10.0), "on"), 0.0) is None  # the end of the whole is not swallowed


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


def test_a_question_waits_for_those_that_come_with_the_next_turns_of_the_loop(results):
    async def one_a_turn(together, questions):
        asked = []
        for question in questions:
            asked.append(asyncio.create_task(together.ask(question)))
            await asyncio.sleep(0)
        return await asyncio.gather(*asked)

    questions = [ResponseQuestion(**POINT | {"slenderness": 0.5 + 0.01 * k}) for k in range(9)]
    with client_of(results) as client:
        atlas = client.app.state.service.atlas
        alone = [asyncio.run(one_a_turn(Together(atlas), [question]))[0] for question in questions]
        calls = _count_calls(atlas)
        assert asyncio.run(one_a_turn(Together(atlas), questions)) == alone
    assert len(calls) == 1


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
