"""State of the data sets during the first check: number unchecked, problems so far."""

import asyncio
from threading import Semaphore
from types import SimpleNamespace

from rocking_api.dataset_checker import DatasetChecker

NAMES = ["spectra/sine/eta-0.80", "spectra/sine/eta-0.85", "spectra/sine/eta-0.90"]


def test_data_sets_left_are_counted_one_by_one(monkeypatch):
    monkeypatch.setattr("rocking_api.dataset_checker.MAX_WAIT", 0.05)
    turn = Semaphore(0)

    def problem(name):
        turn.acquire()
        return "damaged" if name == NAMES[1] else None

    cubes = SimpleNamespace(
        catalogue=SimpleNamespace(scan=lambda: (NAMES, {})), problem=problem, problems=lambda: {NAMES[1]: "damaged"}
    )

    async def counted():
        inspection, seen = DatasetChecker(cubes), []
        for left in (3, 2, 1, 0):
            while (state := await inspection.state()).unchecked > left:
                pass
            seen.append((state.unchecked, dict(state.problems)))
            turn.release()
        return seen

    nothing, damaged = {}, {NAMES[1]: "damaged"}
    assert asyncio.run(asyncio.wait_for(counted(), 20)) == [(3, nothing), (2, nothing), (1, damaged), (0, damaged)]
