"""Distribution of the cells of an array over threads."""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import repeat

import numpy as np
from numpy.typing import NDArray

from rocking._numba.cancellation import StopFlag, check_stop, flag_array

AVAILABLE_CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def fill_chunks(
    fill: Callable[[slice, NDArray[np.uint8]], None], size: int, chunk_size: int, threads: int, stop: StopFlag | None
) -> None:
    """Call `fill(part, flag)` for consecutive parts of `size` cells of `chunk_size` each, in up to `threads` threads.

    Raises `StoppedError` if `stop` was set; the kernels read `flag` and return early then. If one part fails, the
    others are stopped.
    """
    parts = [slice(start, start + chunk_size) for start in range(0, size, chunk_size)]
    workers = min(threads, len(parts))
    if workers <= 1:
        for part in parts:
            fill(part, flag_array(stop))
            check_stop(stop)
        return
    with (stop or StopFlag()).child() as own, ThreadPoolExecutor(workers) as pool:
        try:
            list(pool.map(fill, parts, repeat(own.array)))
        except BaseException:  # includes KeyboardInterrupt: the pool waits for its threads
            own.set()
            raise
    check_stop(stop)
