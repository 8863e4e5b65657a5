"""Micro-batching: requests for one block that arrive together are evaluated by one call.

A call of the solver or of a cube costs about the same for one block as for a hundred, since most of the time is spent
in Python around the kernels. A request therefore waits until the event loop has read all requests that are available
(microseconds); those that differ in the block only are evaluated together. While more arrive in each iteration of the
loop, it waits for one more: otherwise clients that repeat their request at once would split into groups, each of which
is evaluated while the others arrive. Without it, one worker under 64 connections
serves a quarter of the requests.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Hashable, Sequence
from functools import partial

from rocking._lookup.collection import CubeCollection
from rocking._numba.cancellation import StopFlag
from rocking_api.execution.evaluation import PointResult, evaluate, point_results
from rocking_api.execution.executor import BoundedExecutor
from rocking_api.models.params import ResponseParams, check_point

BATCH_SIZE = 256
"""Blocks of one call [-]: a few milliseconds at most, during which the event loop is blocked."""

MAX_INLINE_RESTITUTION = 0.9
"""Restitution above which blocks are computed in a thread [-]. Up to it a block has at most a few hundred impacts, half
a millisecond; an elastic one has up to `IMPACT_LIMIT` impacts, a third of a second."""

OPEN_CHECK_SECONDS = 1.0
"""How long an open data set is not checked again [s]."""

PendingRequest = tuple[ResponseParams, "asyncio.Future[PointResult]"]


class MicroBatcher:
    """Collects requests and evaluates them in batches.

    Parameters
    ----------
    cubes : CubeCollection
        Source of the results.
    executor : BoundedExecutor
        For work that takes too long for the event loop.
    """

    def __init__(self, cubes: CubeCollection, executor: BoundedExecutor) -> None:
        self._cubes = cubes
        self._executor = executor
        self._loop: asyncio.AbstractEventLoop
        self._waiting: dict[Hashable, list[PendingRequest]] = {}
        self._count = 0
        self._open: dict[tuple[str, float], float] = {}
        self._reading: set[asyncio.Task[None]] = set()

    async def evaluate(self, params: ResponseParams) -> PointResult:
        """The result of one request.

        Raises
        ------
        InvalidArgumentError, DatasetError
            As `CubeCollection.response`.
        """
        check_point(params)  # an invalid request must not fail the whole batch
        if not self._count:
            self._loop = asyncio.get_running_loop()  # a system call; once is enough
            self._loop.call_soon(self._evaluate_waiting, 0)
        self._count += 1
        answer: asyncio.Future[PointResult] = self._loop.create_future()
        self._waiting.setdefault(_group_key(params), []).append((params, answer))
        return await answer

    def _evaluate_waiting(self, before: int) -> None:
        """Evaluate what waits, unless requests arrived since the last iteration of the loop."""
        if before < self._count < BATCH_SIZE:
            self._loop.call_soon(self._evaluate_waiting, self._count)
            return
        waiting, self._waiting, self._count = self._waiting, {}, 0
        for group in waiting.values():
            for start in range(0, len(group), BATCH_SIZE):
                self._evaluate_group(group[start : start + BATCH_SIZE])

    def _evaluate_group(self, group: list[PendingRequest]) -> None:
        params_list = [params for params, _ in group]
        first = params_list[0]
        try:
            is_read = first.method == "solver" or self._is_open(first.pulse, first.restitution)
        except Exception as error:  # noqa: BLE001  (no request may wait without end)
            _deliver(group, [error] * len(group))
            return
        if is_read and first.restitution <= MAX_INLINE_RESTITUTION:
            _deliver(group, self._results(params_list))
        else:
            task = asyncio.create_task(self._evaluate_in_thread(group, params_list))
            self._reading.add(task)
            task.add_done_callback(self._reading.discard)

    def _is_open(self, pulse: str, restitution: float) -> bool:
        """Whether the data set is open; the folder is looked at once in `OPEN_CHECK_SECONDS`."""
        now = time.monotonic()
        known = self._open.get((pulse, restitution), 0.0) > now - OPEN_CHECK_SECONDS
        if known or not self._cubes.is_open(pulse, restitution):
            return known
        if len(self._open) > BATCH_SIZE:
            self._open.clear()
        self._open[pulse, restitution] = now
        return True

    async def _evaluate_in_thread(self, group: list[PendingRequest], params_list: list[ResponseParams]) -> None:
        """Evaluate in a thread: a data set has to be read first, or blocks may have many impacts."""
        try:
            _deliver(group, await self._executor.run(partial(self._results, params_list)))
        except Exception as error:  # noqa: BLE001  (no request may wait without end)
            _deliver(group, [error] * len(group))

    def _results(
        self, params_list: list[ResponseParams], stop: StopFlag | None = None
    ) -> list[PointResult | Exception]:
        """The result of each request, or its error."""
        try:
            found, versions = evaluate(
                self._cubes,
                params_list[0],
                slenderness=[params.slenderness for params in params_list],
                frequency_ratio=[params.frequency_ratio for params in params_list],
                restitution=params_list[0].restitution,
                stop=stop,
            )
        except Exception as error:  # noqa: BLE001  (any error belongs to the requests)
            if len(params_list) == 1:
                return [error]
            return [
                outcome for params in params_list for outcome in self._results([params], stop)
            ]  # each has its own error
        return [*point_results(found, versions)]


def _deliver(group: list[PendingRequest], outcomes: Sequence[PointResult | Exception]) -> None:
    for (_, answer), outcome in zip(group, outcomes, strict=True):
        if answer.done():
            continue  # its client has disconnected
        if isinstance(outcome, Exception):
            answer.set_exception(outcome)
        else:
            answer.set_result(outcome)


def _group_key(params: ResponseParams) -> Hashable:
    """Requests with equal keys can be evaluated by one call; one restitution, so that one data set serves them."""
    return params.pulse, params.restitution, params.alpha_deg, params.method, params.absolute_tolerance
