"""State of the solver under a recorded motion: a record for each block, a record for the Taylor steps of `LANES`."""

from __future__ import annotations

import math

import numpy as np

from rocking._numba.compilation import Record
from rocking._numba.simd import LANES, VECTOR_BYTES
from rocking.solver.state import FULL_PRECISION, MAX_ORDER

MIN_ORDER = 6
"""Smallest degree of the Taylor steps."""

BLOCK_STATE = np.dtype(
    [
        # the block and the motion
        ("a", np.float64),  # 1/slenderness: u = a f
        ("eta", np.float64),
        ("alpha", np.float64),  # slenderness angle [rad], 0: slender limit
        ("h", np.float64),  # length of a sample interval [tau]
        ("cell", np.int64),  # index of the cell, -1: none
        # position in the motion, where the next flight starts
        ("interval", np.int64),  # sample interval
        ("s", np.float64),  # time since its left end [tau]
        ("w0", np.float64),  # velocity there
        ("sign", np.float64),  # sgn(theta) of the flight
        ("at_rest", np.int64),  # whether the next flight starts with an uplift
        ("starts_at_uplift", np.int64),  # whether it starts with an uplift through |u| = 1, where q is exactly 0
        # progress
        ("uplifts", np.int64),  # uplifts from rest so far
        ("impacts_before_uplift", np.int64),
        ("largest_z", np.float64),  # largest z of the flight so far
        ("stepped", np.int64),  # sample intervals followed so far, for benchmarks
        # pieces of a flight by Taylor steps, see `rocking.solver.records.taylor_flight`
        ("piece_end", np.float64),  # time since the left end of the interval at which the piece ends [tau]
        ("destabilised", np.int64),  # whether q <= 0 on the piece
        ("from_ground", np.int64),  # whether the step starts at z = 0
        # the response, see `rocking.model.fields`
        ("outcome", np.int64),
        ("peak_rotation", np.float64),
        ("peak_mode", np.int64),
        ("impacts", np.int64),
        ("chatter", np.int64),
        ("uplift_time", np.float64),
        ("first_impact_time", np.float64),
        ("first_impact_velocity", np.float64),
        ("end_rotation", np.float64),
        ("end_velocity", np.float64),
        ("end_sign", np.float64),
    ],
    align=True,
)
"""Layout of the record of a block."""


def _steps_layout() -> np.dtype[np.void]:
    lanes, series = (LANES,), (MAX_ORDER + 1, LANES)
    return np.dtype(
        [
            ("z", np.float64, series),  # coefficients of z,
            ("rate", np.float64, series),  # of dz/dtau,
            ("s", np.float64, series),  # of sin(alpha (1 - z))/sin(alpha)
            ("c", np.float64, series),  # and of cos(alpha (1 - z))/cos(alpha)
            # start of the step
            ("z0", np.float64, lanes),
            ("w0", np.float64, lanes),
            ("force", np.float64, lanes),  # sgn(theta) u there,
            ("force_rate", np.float64, lanes),  # and its rate
            ("limit", np.float64, lanes),  # largest step size [tau]
            # the block, as in `rocking.solver.state.STEP_STATE`
            ("omega", np.float64, lanes),
            ("slender", np.float64, lanes),
            ("alpha", np.float64, lanes),
            ("sine_alpha", np.float64, lanes),
            ("cosine_alpha", np.float64, lanes),
            ("restoring_factor", np.float64, lanes),
            ("s_rate", np.float64, lanes),
            ("c_rate", np.float64, lanes),
            # the step
            ("h", np.float64, lanes),  # step size [tau]
            ("z1", np.float64, lanes),  # z at its end
            ("w1", np.float64, lanes),  # w there
            ("second_derivative_bound", np.float64, lanes),  # bound of |w''| on it
            ("taken", np.int64, lanes),  # number of steps of the flight
            # accuracy
            ("order", np.int64),  # degree of the steps, `MIN_ORDER` to `MAX_ORDER`
            ("log_precision", np.float64),  # log2 of the largest ratio of the last terms to the motion
        ]
    )


STEP_STATE = _steps_layout()
"""Layout of the record of `LANES` Taylor steps."""


def taylor_order(interval: float) -> int:
    """Degree n of the Taylor steps for sample intervals of this length [tau]: (2 interval)^n/n! is below rounding.

    The lowest degree that reaches the end of an interval in one step under a motion of moderate strength; where it does
    not suffice, the step is shorter than the interval.
    """
    term, order = 1.0, 0
    while order < MIN_ORDER or (term > FULL_PRECISION and order < MAX_ORDER):
        order += 1
        term *= 2.0 * interval / order
    return order


def step_state(interval: float) -> Record:
    """Taylor steps for sample intervals of at most this length [tau]."""
    memory = np.zeros(STEP_STATE.itemsize + VECTOR_BYTES, np.uint8)
    start = -memory.ctypes.data % VECTOR_BYTES
    steps: Record = memory[start : start + STEP_STATE.itemsize].view(STEP_STATE)[0]
    steps["order"] = taylor_order(interval)
    steps["log_precision"] = math.log2(FULL_PRECISION)
    # unused lanes hold a block at rest, which produces no infinities
    for name in ("slender", "alpha", "sine_alpha", "cosine_alpha", "restoring_factor", "omega"):
        steps[name] = 1.0
    return steps
