"""Questions about one block that arrive at the same moment are answered by one call.

A call of the solver or of a cube costs the same for one block as for a hundred: what takes the time is Python around
the numbers. So a question waits until the event loop has read all requests that are there, microseconds, and all that
differ in the block only are asked together. As long as more come with each turn of the loop it waits another turn:
otherwise clients that ask anew at once fall apart into groups, each of which is answered while the others arrive.
Nobody notices but the clock.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Hashable, Sequence
from functools import partial

from rocking._numba.cancellation import StopFlag
from rocking.lookup.collection import CubeCollection
from rocking_api.execution.evaluation import ask
from rocking_api.execution.executor import BoundedExecutor
from rocking_api.models.params import ResponseQuestion, check_point
from rocking_api.models.point import Point, points_of

MOST = 256
"""Blocks of one call [-]: a few milliseconds at the very most, in which nothing else is answered."""

ELASTIC = 0.9
"""Restitution above which blocks are followed in a thread [-]: up to it none strikes more than some hundred times, half
a millisecond; an elastic one strikes up to `rock.IMPACT_LIMIT` times, a third of a second."""

A_MOMENT = 1.0
"""How long an open data set needs no second look [s]."""

Asked = tuple[ResponseQuestion, "asyncio.Future[Point]"]


class Together:
    """Gathers questions and asks the atlas.

    Parameters
    ----------
    atlas : CubeCollection
        Where the answers come from.
    executor : BoundedExecutor
        For what takes too long for the event loop.
    """

    def __init__(self, atlas: CubeCollection, executor: BoundedExecutor) -> None:
        self._atlas = atlas
        self._executor = executor
        self._loop: asyncio.AbstractEventLoop
        self._waiting: dict[Hashable, list[Asked]] = {}
        self._count = 0
        self._open: dict[tuple[str, float], float] = {}
        self._reading: set[asyncio.Task[None]] = set()

    async def ask(self, question: ResponseQuestion) -> Point:
        """The answer to one question.

        Raises
        ------
        InvalidArgumentError, DatasetError
            As `CubeCollection.response`.
        """
        check_point(question)  # one that is out of range must not spoil the call of the others
        if not self._count:
            self._loop = asyncio.get_running_loop()  # asks the operating system who runs: once is enough
            self._loop.call_soon(self._answer_all, 0)
        self._count += 1
        answer: asyncio.Future[Point] = self._loop.create_future()
        self._waiting.setdefault(_kind(question), []).append((question, answer))
        return await answer

    def _answer_all(self, before: int) -> None:
        """Answer what waits, unless a turn ago there were fewer questions."""
        if before < self._count < MOST:
            self._loop.call_soon(self._answer_all, self._count)
            return
        waiting, self._waiting, self._count = self._waiting, {}, 0
        for group in waiting.values():
            for start in range(0, len(group), MOST):
                self._answer(group[start : start + MOST])

    def _answer(self, group: list[Asked]) -> None:
        questions = [question for question, _ in group]
        first = questions[0]
        try:
            is_read = first.method == "solver" or self._is_open(first.pulse, first.restitution)
        except Exception as error:  # noqa: BLE001  (nobody may wait for ever)
            _tell(group, [error] * len(group))
            return
        if is_read and first.restitution <= ELASTIC:
            _tell(group, self._outcomes(questions))
        else:
            task = asyncio.create_task(self._answer_in_thread(group, questions))
            self._reading.add(task)
            task.add_done_callback(self._reading.discard)

    def _is_open(self, pulse: str, restitution: float) -> bool:
        """As the atlas says, which looks at the folder for it; what was open a moment ago is open still."""
        now = time.monotonic()
        known = self._open.get((pulse, restitution), 0.0) > now - A_MOMENT
        if known or not self._atlas.is_open(pulse, restitution):
            return known
        if len(self._open) > MOST:
            self._open.clear()
        self._open[pulse, restitution] = now
        return True

    async def _answer_in_thread(self, group: list[Asked], questions: list[ResponseQuestion]) -> None:
        """A data set has to be read first, or blocks may strike the ground many times."""
        try:
            _tell(group, await self._executor.run(partial(self._outcomes, questions)))
        except Exception as error:  # noqa: BLE001  (nobody may wait for ever)
            _tell(group, [error] * len(group))

    def _outcomes(self, questions: list[ResponseQuestion], stop: StopFlag | None = None) -> list[Point | Exception]:
        """Each question's answer, or what is wrong with it."""
        try:
            found, versions = ask(
                self._atlas,
                questions[0],
                slenderness=[question.slenderness for question in questions],
                frequency_ratio=[question.frequency_ratio for question in questions],
                restitution=questions[0].restitution,
                stop=stop,
            )
        except Exception as error:  # noqa: BLE001  (whatever it is, it is for those who asked)
            if len(questions) == 1:
                return [error]
            return [outcome for question in questions for outcome in self._outcomes([question], stop)]  # each its own
        return [*points_of(found, versions)]


def _tell(group: list[Asked], outcomes: Sequence[Point | Exception]) -> None:
    for (_, answer), outcome in zip(group, outcomes, strict=True):
        if answer.done():
            continue  # its client has gone
        if isinstance(outcome, Exception):
            answer.set_exception(outcome)
        else:
            answer.set_result(outcome)


def _kind(question: ResponseQuestion) -> Hashable:
    """Questions of one kind can be asked by one call; one restitution, so that one data set answers them."""
    return question.pulse, question.restitution, question.alpha_deg, question.method, question.tolerance
