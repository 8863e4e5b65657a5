"""How long whole studies take: `python -m benchmarks.cost.studies` prints wall-clock times for one and two cores.

A million blocks under a pulse and a thousand blocks under each of a hundred records, by one and two threads; ten
million blocks as labelled arrays in ten chunks, by one and two processes of a `distributed` cluster on this machine.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import xarray as xr
from distributed import Client, LocalCluster

import rocking
from benchmarks.cost.made_up_records import made_up_suite
from benchmarks.measure import arguments
from rocking._base.constants import STANDARD_GRAVITY

ANGLES = {"slender": None, "rigid": 0.25}
"""alpha [rad]."""


def pulse_study(alpha: float | None, side: int = 1000) -> Callable[[int], Any]:
    """Return the study of side x side blocks under a sine."""
    s, omega = np.linspace(0.02, 0.85, side)[:, None], np.linspace(0.5, 12.0, side)
    return lambda threads: rocking.peak_response(
        "sine", slenderness=s, frequency_ratio=omega, restitution=0.85, alpha=alpha, threads=threads
    )


def record_study(alpha: float | None, records: int = 100, blocks: int = 1000) -> Callable[[int], Any]:
    """Return the study of blocks of R = 0.5 to 4 m at 0.5 to 10 times their uplift acceleration under each record."""
    suite, random = made_up_suite(records), np.random.default_rng(1)
    p = np.sqrt(0.75 * STANDARD_GRAVITY / random.uniform(0.5, 4.0, blocks))
    s = 1.0 / np.geomspace(0.5, 10.0, blocks)
    return lambda threads: [
        rocking.peak_response(one, slenderness=s, frequency_parameter=p, restitution=0.9, alpha=alpha, threads=threads)
        for one in suite
    ]


def overturned_share(alpha: float | None, count: int = 10_000_000) -> float:
    """Return the share of labelled blocks in chunks that overturn, computed by the current dask cluster."""
    side = round(count**0.5)
    s = xr.DataArray(np.linspace(0.02, 0.85, side), dims="slenderness").chunk(slenderness=-(-side // 10))
    omega = xr.DataArray(np.linspace(0.5, 12.0, side), dims="frequency_ratio").chunk()
    found = rocking.peak_response("sine", slenderness=s, frequency_ratio=omega, restitution=0.85, alpha=alpha)
    return float(found.overturned.mean().compute())


@contextmanager
def cluster(workers: int) -> Iterator[None]:
    """Processes of one thread each, as the default of dask inside."""
    with (
        LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as processes,  # type: ignore[no-untyped-call]
        Client(processes),  # type: ignore[no-untyped-call]
    ):
        yield


def seconds(call: Callable[[], Any], rounds: int) -> float:
    """Return the median time of a call after a first one, which loads the kernels [s]."""
    call()
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


if __name__ == "__main__":
    rounds = arguments(__doc__, rounds=5).rounds
    print(f"{'study':44}{'1 core [s]':>12}{'2 cores [s]':>12}")
    for kind, alpha in ANGLES.items():
        studies = {"1,000,000 blocks, sine": pulse_study(alpha), "100 records x 1,000 blocks": record_study(alpha)}
        for name, study in studies.items():
            times = [seconds(lambda threads=threads, study=study: study(threads), rounds) for threads in (1, 2)]
            print(f"{name + ', ' + kind:44}{times[0]:>12.3f}{times[1]:>12.3f}", flush=True)
    for kind, alpha in ANGLES.items():
        times = []
        for workers in (1, 2):
            with cluster(workers):
                times.append(seconds(lambda alpha=alpha: overturned_share(alpha), rounds))
        print(f"{'10,000,000 labelled blocks, dask, ' + kind:44}{times[0]:>12.3f}{times[1]:>12.3f}", flush=True)
