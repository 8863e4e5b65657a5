"""Questions about one block that arrive at the same moment are answered by one call.

A call of the solver or of a cube costs the same for one block as for a hundred: what takes the time is Python around
the numbers. So a question waits until the event loop has read all requests that are there, microseconds, and all that
differ in the block only are asked together. Nobody notices but the clock.
"""

from __future__ import annotations

import asyncio
from collections.abc import Hashable

from api.ask import ask
from api.points import Point, points_of
from api.questions import ResponseQuestion
from rocking.lookup_atlas import Atlas

MOST = 256
"""Blocks of one call [-]: a few milliseconds at the very most, in which nothing else is answered."""

Asked = tuple[ResponseQuestion, "asyncio.Future[Point]"]


class Together:
    """Gathers questions and asks the atlas.

    Parameters
    ----------
    atlas : Atlas
        Where the answers come from.
    """

    def __init__(self, atlas: Atlas) -> None:
        self._atlas = atlas
        self._waiting: dict[Hashable, list[Asked]] = {}

    async def ask(self, question: ResponseQuestion) -> Point:
        """The answer to one question.

        Raises
        ------
        InvalidArgumentError, DatasetError
            As `Atlas.response`.
        """
        loop = asyncio.get_running_loop()
        if not self._waiting:
            loop.call_soon(self._answer_all)
        answer: asyncio.Future[Point] = loop.create_future()
        self._waiting.setdefault(_kind(question), []).append((question, answer))
        return await answer

    def _answer_all(self) -> None:
        waiting, self._waiting = self._waiting, {}
        for group in waiting.values():
            for start in range(0, len(group), MOST):
                self._answer(group[start : start + MOST])

    def _answer(self, group: list[Asked]) -> None:
        try:
            points = self._points([question for question, _ in group])
        except Exception as error:  # noqa: BLE001  (whatever it is, it is for those who asked)
            if len(group) > 1:  # one of them spoils it: each is to have its own answer
                for one in group:
                    self._answer([one])
            elif not group[0][1].done():
                group[0][1].set_exception(error)
            return
        for (_, answer), point in zip(group, points, strict=True):
            if not answer.done():  # its client may have gone
                answer.set_result(point)

    def _points(self, questions: list[ResponseQuestion]) -> list[Point]:
        found, versions = ask(
            self._atlas,
            questions[0],
            slenderness=[question.slenderness for question in questions],
            frequency_ratio=[question.frequency_ratio for question in questions],
            restitution=questions[0].restitution,
        )
        return points_of(found, versions)


def _kind(question: ResponseQuestion) -> Hashable:
    """Questions of one kind can be asked by one call; one restitution, so that one data set answers them."""
    return question.pulse, question.restitution, question.alpha_deg, question.method, question.tolerance
