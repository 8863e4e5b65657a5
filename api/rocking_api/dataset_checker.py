"""Reads and checks data sets in the background, so that no request waits for a folder of gigabytes."""

from __future__ import annotations

import asyncio
import logging
from contextlib import suppress
from functools import partial
from typing import NamedTuple

import anyio.to_thread

from rocking._base.errors import DatasetError
from rocking._datasets.catalogue import UnknownDatasetError
from rocking._lookup.collection import NO_CUBES, CubeCollection

LOG = logging.getLogger("rocking.service")

MAX_WAIT = 0.1  # how long a request waits for the check to finish [s]
WATCH_SECONDS = 5.0  # time between two looks at the folder without a request [s]


class State(NamedTuple):
    """Result of the check so far."""

    names: list[str]
    unchecked: int
    problems: dict[str, str]


class DatasetChecker:
    """Checks every data set once per version of its file, on request, and logs each that is found damaged or repaired.

    `damaged` says of each data set or folder that exists and cannot be used what is wrong, by name. The digest of each
    file is known afterwards.
    """

    def __init__(self, cubes: CubeCollection) -> None:
        self._cubes = cubes
        self.damaged: dict[str, str] = {}
        self._task: asyncio.Task[None] | None = None
        self._state = State([], 0, {})

    async def state(self) -> State:
        """The complete result, or the result so far after `MAX_WAIT`."""
        names, unreadable = await anyio.to_thread.run_sync(self._cubes.catalogue.scan)
        if self._task is None or self._task.done() or names != self._state.names:
            if self._task is not None:
                self._task.cancel()  # of other files; those that it has checked are known
            self._state = State(names, len(names), {})
            for name in self.damaged.keys() - {*names, *unreadable}:  # removed
                self._note(name, None)
            self._task = asyncio.create_task(self._check(names))
        await asyncio.wait({self._task}, timeout=MAX_WAIT)
        if self._task.done():
            self._task.result()  # raises an error of the check
        return self._state

    async def watch(self) -> None:
        """Check again and again, so that a request never meets the state of a folder that was replaced long ago."""
        while True:
            with suppress(OSError):
                await self.state()
            await asyncio.sleep(WATCH_SECONDS)

    async def _check(self, names: list[str]) -> None:
        problems: dict[str, str] = {}
        for k, name in enumerate(sorted(names, key=lambda name: name not in self.damaged)):
            try:
                problem = await anyio.to_thread.run_sync(partial(self._cubes.problem, name))
                if problem is None:
                    await anyio.to_thread.run_sync(partial(self._cubes.catalogue.product, name))
            except (UnknownDatasetError, DatasetError):
                problem = None  # removed or replaced meanwhile
            if problem is not None:
                problems[name] = problem
            self._note(name, problem)
            self._state = State(names, len(names) - k - 1, problems)
        # includes problems of the folder itself; the files are checked by now
        problems = await anyio.to_thread.run_sync(self._cubes.problems)
        self._state = State(names, 0, problems)
        for name in {*self.damaged, *problems}:
            self._note(name, problems.get(name))

    def _note(self, name: str, problem: str | None) -> None:
        """Log a data set that is damaged or no longer so, once."""
        before = self.damaged.pop(name, None)
        if problem is not None and problem != NO_CUBES:
            self.damaged[name] = problem
        if (now := self.damaged.get(name)) == before:
            return
        if now is None:
            LOG.info("a data set is no longer damaged: %s", name)
        else:
            LOG.error("a data set is damaged: %s: %s", name, problem)
