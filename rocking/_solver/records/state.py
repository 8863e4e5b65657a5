"""State of the solver under samples: a record for each body, a record for the Taylor steps of `LANES`."""

import math

import numpy as np
from numpy.typing import NDArray

from rocking._numba.compilation import Record
from rocking._numba.simd import LANES
from rocking._solver.records.samples import TIME
from rocking._solver.state import (
    ACCURACY_FIELDS,
    AT_REST,
    BODY_FIELDS,
    FULL_PRECISION,
    MAX_ORDER,
    PROGRESS_FIELDS,
    STEP_FIELDS,
    aligned_record,
    restraint_level,
)

MIN_ORDER = 14  # lowest degree [-]: lower ones need more steps where the motion is strong, and take longer in all

BLOCK_STATE = np.dtype(
    [
        *BODY_FIELDS,
        *PROGRESS_FIELDS,
        ("h", np.float64),  # unit of the times of the samples [tau]
        ("vertical", np.float64),  # factor of the vertical component
        ("equidistant", np.int64),  # whether that is the length of each sample interval
        ("cell", np.int64),  # index of the cell, -1: none
        # position in the motion, where the next flight starts
        ("interval", np.int64),  # sample interval
        ("s", np.float64),  # time since its left end [tau]
        ("stepped", np.int64),  # sample intervals followed so far, for benchmarks
        # pieces of a flight by Taylor steps, see `rocking._solver.records.taylor_flight`
        ("length", np.float64),  # of the interval [tau]
        ("piece_end", np.float64),  # time since the left end of the interval at which the piece ends [tau]
        ("destabilised", np.int64),  # whether q <= 0 on the piece
        ("from_ground", np.int64),  # whether the step starts at z = 0
    ],
    align=True,
)


def body_states(samples: NDArray[np.float64], count: int) -> NDArray[np.void]:
    """Records `BLOCK_STATE` (count,) for bodies under the motion `samples` of `sample_rows`."""
    states = np.zeros(count, BLOCK_STATE)
    states["equidistant"] = int((np.diff(samples[TIME]) == 1.0).all())
    return states


STEP_STATE = np.dtype(
    [
        *STEP_FIELDS,
        # start of the step
        ("force", np.float64, (LANES,)),  # F there,
        ("force_rate", np.float64, (LANES,)),  # and its rate
        ("vertical", np.float64, (LANES,)),  # V there,
        ("vertical_rate", np.float64, (LANES,)),  # and its rate
        ("steady", np.float64, (LANES,)),  # 1 if the step contains neither an impact nor a peak, 0 if not known
        ("has_vertical", np.int64),  # whether V is not 1 everywhere
        *ACCURACY_FIELDS,
    ]
)
"""Layout of the record of `LANES` Taylor steps; their degree is `MIN_ORDER` to `MAX_ORDER`."""


def taylor_orders(samples: NDArray[np.float64], cells: NDArray[np.void]) -> NDArray[np.int64]:
    """Degree n of the Taylor steps of each cell: (2 h)^n/n! is below rounding, for the longest sample interval h [tau].

    The lowest degree that reaches the end of an interval in one step under a motion of moderate strength; where it does
    not suffice, the step is shorter than the interval.
    """
    interval = cells["rate"] * np.diff(samples[TIME]).max()
    term, orders = np.ones(cells.size), np.full(cells.size, MIN_ORDER)
    for order in range(1, MAX_ORDER + 1):
        orders[(term > FULL_PRECISION) & (order > MIN_ORDER)] = order
        term *= 2.0 * interval / order
    return orders


def step_state(samples: NDArray[np.float64], cells: NDArray[np.void]) -> Record:
    """Taylor steps for the motion `samples` of `sample_rows` and cells `BODY_CELL`."""
    steps = aligned_record(STEP_STATE)
    steps["order"] = taylor_orders(samples, cells).max()
    steps["log_precision"] = math.log2(FULL_PRECISION)
    steps["has_vertical"] = int(cells["vertical"].any())
    steps["restrained"] = restraint_level(cells)
    for name in AT_REST:
        steps[name] = 1.0
    return steps
