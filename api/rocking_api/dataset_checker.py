"""Data sets are read and checked behind the scenes, one by one: a request need not wait for a folder of gigabytes."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import NamedTuple

import anyio.to_thread

from rocking.datasets.catalogue import UnknownDatasetError
from rocking.lookup.collection import CubeCollection

PATIENCE = 0.1
"""How long a request waits for the check to end [s]."""


class State(NamedTuple):
    """What is known of the data sets."""

    names: list[str]
    unchecked: int
    problems: dict[str, str]


class Inspection:
    """Checks every data set once per version of its file, whenever somebody asks.

    Parameters
    ----------
    atlas : CubeCollection
        Whose data sets.
    """

    def __init__(self, atlas: CubeCollection) -> None:
        self._atlas = atlas
        self._task: asyncio.Task[None] | None = None
        self._state = State([], 0, {})

    async def state(self) -> State:
        """All is known, or what is known after `PATIENCE`."""
        if self._task is None or self._task.done():
            names = await anyio.to_thread.run_sync(self._atlas.catalogue.names)
            self._state = State(names, len(names), {})
            self._task = asyncio.create_task(self._check(names))
        await asyncio.wait({self._task}, timeout=PATIENCE)
        if self._task.done():
            self._task.result()  # an error inside is the asker's to hear
        return self._state

    async def _check(self, names: list[str]) -> None:
        problems: dict[str, str] = {}
        for k, name in enumerate(names):
            try:
                problem = await anyio.to_thread.run_sync(partial(self._atlas.problem, name))
            except UnknownDatasetError:
                problem = None  # it went away meanwhile
            if problem is not None:
                problems[name] = problem
            self._state = State(names, len(names) - k - 1, problems)
        # with what is wrong with the folder as a whole; the files are known by now
        problems = await anyio.to_thread.run_sync(self._atlas.problems)
        self._state = State(names, 0, problems)
