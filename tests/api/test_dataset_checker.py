"""State of the data sets during the first check: number unchecked, problems so far."""

import asyncio
from threading import Semaphore
from types import SimpleNamespace

from rocking_api.dataset_checker import DatasetChecker

NAMES = ["spectra/sine/eta-0.80", "spectra/sine/eta-0.85", "spectra/sine/eta-0.90"]


def test_the_state_follows_a_folder_that_is_replaced_during_a_check_or_without_requests(monkeypatch):
    monkeypatch.setattr("rocking_api.dataset_checker.MAX_WAIT", 0.05)
    monkeypatch.setattr("rocking_api.dataset_checker.WATCH_SECONDS", 0.01)
    present, long = [*NAMES], Semaphore(0)

    def problem(name):
        if name == NAMES[2] and len(present) == 3:
            long.acquire(timeout=20)  # a large file, which is read when the folder is replaced
        return "damaged" if name == NAMES[1] else None

    def problems():
        return {NAMES[1]: "damaged"} if NAMES[1] in present else {}

    cubes = SimpleNamespace(
        catalogue=SimpleNamespace(scan=lambda: ([*present], {})), problem=problem, problems=problems
    )

    async def followed():
        checker = DatasetChecker(cubes)
        while not checker.damaged:
            await checker.state()
        present[:] = NAMES[:1]
        state = await checker.state()
        assert (state.names, state.unchecked, state.problems, checker.damaged) == (NAMES[:1], 0, {}, {})
        watch = asyncio.create_task(checker.watch())
        present[:] = NAMES[:2]
        while not checker.damaged:
            await asyncio.sleep(0.01)
        watch.cancel()
        long.release()

    asyncio.run(asyncio.wait_for(followed(), 10))
