"""State of the solver: a record for an excitation and a cell, a record for the Taylor steps of `LANES` cells.

The layout is fixed and the same for all excitations. Kernels access the memory without reference counting and are
compiled once. The records are prepared for each pulse; each thread works on copies.
"""

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rocking._excitation.shapes import MAX_PIECES, AbstractPulse
from rocking._model.fields import SOLVED_FIELDS, record_dtype
from rocking._numba.compilation import Record
from rocking._numba.records import constant_fields
from rocking._numba.simd import LANES, VECTOR_BYTES
from rocking._solver.excitation import EXCITATION_FIELDS, PULSE_FIELDS, fill_excitation

MAX_ORDER = 22  # largest degree of the Taylor steps

FULL_PRECISION = 1e-17
"""Smallest ratio of the last terms of a Taylor step to the motion during the step, far below rounding [-]."""

IN_FLIGHT, IMPACT, PULSE_END, OVERTURNS = -1, 0, 1, 2
"""What has ended a flight. OVERTURNS: no later ground acceleration of the pulse can prevent overturning."""

EDGES = (2,)

FREE_ORDER = 18  # degree of the Taylor steps of restrained bodies without ground motion

BODY_FIELDS = [
    # of both edges, the right one (theta > 0) first; times and rotations have the units of the right edge
    ("slenderness", np.float64, EDGES),  # g tan(alpha_s) over the largest ground acceleration
    ("a", np.float64, EDGES),  # its reciprocal, largest ground acceleration over g tan(alpha_s): F = sgn(theta) a f
    ("eta", np.float64, EDGES),  # restitution of an impact that leaves the edge
    ("ratio", np.float64, EDGES),  # alpha_s/alpha
    ("stiffness", np.float64, EDGES),  # (p_s/p)^2
    ("speed", np.float64, EDGES),  # ratio p_s/p: velocity w over that in the units of the edge
    ("turn", np.float64),  # sgn(theta) after an impact over that before: -1, or 1 if it rocks about one edge only
    ("alpha", np.float64),  # slenderness angle of the right edge [rad], 0: slender limit
    ("pull", np.float64, EDGES),  # see `rocking._solver.rules.pulls_of`; 0 until it is known
    ("softening", np.float64),
    ("each_side", np.int64),  # whether peaks are wanted for each edge; always where the edges differ
    # tendon and damper, see `rocking._solver.restrained_rocking`
    ("restrained", np.int64),  # whether it has one
    ("spring", np.float64),  # kappa
    ("level", np.float64),  # 1 + sigma, which multiplies `slenderness`
    ("damping", np.float64),  # zeta
    ("growth", np.float64),  # lambda of a slender body that can escape, else 0
    ("equilibrium", np.float64),  # z from which it does not return without ground motion; inf if there is none
    ("may_turn", np.int64),  # whether z may have a maximum while the body is destabilised
    ("free_z", np.float64, (FREE_ORDER + 1, 1)),  # Taylor step without ground motion
    ("free_rate", np.float64, (FREE_ORDER + 1, 1)),
    ("free_s", np.float64, (FREE_ORDER + 1,)),
    ("free_c", np.float64, (FREE_ORDER + 1,)),
    ("free_d", np.float64, (FREE_ORDER + 1,)),
]
"""Fields of a solver state that describe the body; set once for a cell, by `rocking._solver.rules`."""

BODY_CELL = np.dtype(
    [
        ("rate", np.float64),  # samples: p times the unit of their times [tau]; pulses: frequency ratio omega_g/p
        ("vertical", np.float64),  # factor of the vertical component
        ("alpha", np.float64),  # slenderness angle of the right edge [rad], 0: slender limit
        # g tan(alpha_s)/(largest horizontal acceleration); inf: never lifted about this edge, the body rebounds there
        ("slenderness", np.float64, EDGES),
        ("eta", np.float64, EDGES),
        ("ratio", np.float64),  # alpha_s/alpha of the left edge
        ("stiffness", np.float64),  # (p_s/p)^2 of the left edge
        # kappa, sigma and zeta of a body with equal edges; 0 of a free one
        ("spring", np.float64),
        ("prestress", np.float64),
        ("damping", np.float64),
    ]
)
"""A body under a motion: the argument of the kernels that know two edges."""

PROGRESS_FIELDS = [
    # the flight
    ("sign", np.float64),  # sgn(theta)
    ("side", np.int64),  # edge about which the body rotates
    ("strength", np.float64),  # sgn(theta) a_s: F over f
    ("w0", np.float64),  # velocity at its start
    ("largest_z", np.float64),  # largest z so far
    ("at_rest", np.int64),  # whether the next flight starts with an uplift
    ("starts_at_uplift", np.int64),  # whether it starts with an uplift through q = 0, where q is exactly 0
    ("uplifts", np.int64),  # uplifts from rest so far
    ("impacts_before_uplift", np.int64),  # impacts before the last of them
    # the response; `write_response` copies what is declared
    *((field.name, np.float64 if field.dtype == "f8" else np.int64) for field in SOLVED_FIELDS),
    ("side_peak", np.float64, EDGES),  # largest z on each edge
    ("end_sign", np.float64),  # sgn(theta) at the end of the motion, 0 at rest; end_rotation is |theta|/alpha
    ("final_sign", np.float64),  # sgn(theta) of a body that overturns, else 0
]
"""Fields of a solver state that the rules of events change: the flight and the response."""


EDGE_COLUMNS = 4
"""Columns of the arrays of responses by edges: largest z on the right and on the left edge, nan where the body
overturns; sgn(theta) at the end of the motion, 0 at rest; sgn(theta) of a body that overturns, else 0."""


def _flight_layout() -> np.dtype[np.void]:
    ends, cuts = (MAX_PIECES + 1,), (3 * MAX_PIECES + 1,)
    crossings = (math.ceil(2 * MAX_PIECES / LANES), LANES)
    return np.dtype(
        [
            # the excitation
            *PULSE_FIELDS,
            ("pieces", np.int64),  # number of monotone pieces of f
            ("end_phase", np.float64, ends),  # their ends, with f there
            ("end_shape", np.float64, ends),
            # of two crossings of |f| = 1/a for each piece: its ends with f there, sgn(f) at the crossing, and its
            # phase, see `find_crossings`
            ("crossing_left", np.float64, crossings),
            ("crossing_right", np.float64, crossings),
            ("crossing_f_left", np.float64, crossings),
            ("crossing_f_right", np.float64, crossings),
            ("crossing_sign", np.float64, crossings),
            ("crossing_phase", np.float64, crossings),
            # the cell
            *BODY_FIELDS,
            ("omega", np.float64),  # frequency ratio
            ("interval_phase", np.float64, cuts),  # ends of the intervals, see `split_into_intervals`
            ("interval_level", np.float64, cuts),  # in the interval to the right: +1 if a f > 1, -1 if a f < -1, else 0
            ("interval_slope", np.float64, cuts),  # sign of f' there
            # progress of the event loop
            ("cell", np.int64),  # index of the cell, -1: none
            ("last_cell", np.int64),  # last of the consecutive cells that differ in eta only
            ("interval_count", np.int64),  # number of intervals
            ("interval", np.int64),  # interval that holds the start of the next flight
            *PROGRESS_FIELDS,
            ("next_phase", np.float64),  # its start
            ("next_w", np.float64),
            ("next_sign", np.float64),
            # the flight
            ("phase", np.float64),  # phi at its start
            ("length", np.float64),  # its duration [tau]
            # its Taylor steps
            ("segment_end", np.int64),  # index of the interval end at which the steps must end next
            ("elapsed", np.float64),  # time since the flight's start
            # end of the first flight, which does not depend on eta
            ("first_flight_known", np.int64),  # whether it is known
            ("first_flight_end", np.int64),
            ("first_flight_w", np.float64),
            ("first_flight_z", np.float64),
            ("first_flight_peak", np.float64),
            ("first_flight_length", np.float64),
            ("first_flight_phase", np.float64),
            ("first_flight_sign", np.float64),
            ("first_flight_interval", np.int64),
        ],
        align=True,
    )


FLIGHT_STATE = _flight_layout()  # layout of the record of an excitation and a cell

FOLLOWED_FLIGHT = np.dtype(
    [
        ("phase", np.float64),  # fields of `FLIGHT_STATE`: at the start,
        ("w0", np.float64),
        ("sign", np.float64),
        ("starts_at_uplift", np.int64),
        ("length", np.float64),  # and at the end
        ("next_phase", np.float64),
    ]
)
"""What repeats a flight of a cell."""


EDGE_LANES = [
    ("slender", np.float64, (LANES,)),  # 1 for the slender limit, else 0
    ("alpha", np.float64, (LANES,)),  # of the right edge [rad]; arbitrary in the slender limit
    ("ratio", np.float64, (LANES,)),  # alpha_s/alpha
    ("stiffness", np.float64, (LANES,)),  # (p_s/p)^2
    ("sine_alpha", np.float64, (LANES,)),  # of alpha_s
    ("cosine_alpha", np.float64, (LANES,)),
    ("restoring_factor", np.float64, (LANES,)),  # (p_s/p)^2 sin(alpha_s)/alpha
    ("s_rate", np.float64, (LANES,)),  # -alpha/tan(alpha_s)
    ("c_rate", np.float64, (LANES,)),  # alpha tan(alpha_s)
    # restraint, 0 and a cap of inf without it
    ("spring", np.float64, (LANES,)),  # kappa sin(alpha) cos(alpha)/alpha
    ("tension", np.float64, (LANES,)),  # sigma/(1 + sigma)
    ("drag", np.float64, (LANES,)),  # 2 zeta
    ("cap", np.float64, (LANES,)),  # largest step size on which z behaves as without the tendon [tau]
    ("may_turn", np.float64, (LANES,)),
]
"""Fields of Taylor steps that describe the edges about which the bodies rotate, see `rocking._solver.taylor.step`."""

AT_REST = ("slender", "alpha", "ratio", "stiffness", "sine_alpha", "cosine_alpha", "restoring_factor", "cap", "omega")
"""Lanes that are 1 while unused: a block at rest, which produces no infinities."""


_SERIES, _LANES = (MAX_ORDER + 1, LANES), (LANES,)

STEP_FIELDS = [
    ("z", np.float64, _SERIES),  # coefficients of z,
    ("rate", np.float64, _SERIES),  # of dz/dtau,
    ("s", np.float64, _SERIES),  # of sin(alpha (1 - z))/sin(alpha)
    ("c", np.float64, _SERIES),  # of cos(alpha (1 - z))/cos(alpha)
    ("half", np.float64, _SERIES),  # and of cos(alpha z/2), if a body has a prestress
    # start of the step
    ("z0", np.float64, _LANES),
    ("w0", np.float64, _LANES),
    ("limit", np.float64, _LANES),  # largest step size [tau]
    ("omega", np.float64, _LANES),
    *EDGE_LANES,
    # the step
    ("h", np.float64, _LANES),  # step size [tau]
    ("z1", np.float64, _LANES),  # z at its end
    ("w1", np.float64, _LANES),  # w there
    ("second_derivative_bound", np.float64, _LANES),  # bound of |w''| on it
    ("taken", np.int64, _LANES),  # number of steps of the flight
]
"""Fields of `LANES` Taylor steps under any motion; the fields of one kind of motion, then `ACCURACY_FIELDS` follow."""

ACCURACY_FIELDS = [
    ("order", np.int64),  # degree of the steps, 6 to `MAX_ORDER`
    ("log_precision", np.float64),  # log2 of the largest ratio of the last terms to the motion
    ("restrained", np.int64),  # 0: all bodies are free, 1: some have a tendon or a damper, 2: some have a prestress
]

STEP_STATE = np.dtype(
    [
        *STEP_FIELDS,
        ("f", np.float64, _SERIES),  # coefficients of F = sgn(theta) a f,
        ("gauss", np.float64, _SERIES),  # of the wavelet's Gaussian
        # start of the step
        ("phase", np.float64, _LANES),
        ("starts_at_uplift", np.float64, _LANES),  # 1 if it starts with an uplift through |a f| = 1, else 0
        ("reach", np.float64, _LANES),  # step size up to which the expansion of the excitation is exact [tau]
        ("in_use", np.float64, _LANES),  # 1 if the lane follows a block, else 0
        ("destabilised", np.float64, _LANES),  # 1 if the block is destabilised up to the end of the segment, else 0
        ("restoring_phase", np.float64, _LANES),  # otherwise, phase from which the acceleration is restoring
        ("at_ground", np.float64, _LANES),  # 1 if the flight starts here, else 0
        ("known", np.float64, _LANES),  # largest z of the response so far: smaller peaks do not count
        ("strength", np.float64, _LANES),  # sgn(theta) a
        # events, see `rocking._solver.taylor.lane_events`
        ("impact", np.float64, _LANES),
        ("impact_w", np.float64, _LANES),
        ("peak", np.float64, _LANES),
        *EXCITATION_FIELDS,  # the excitation, as in `FLIGHT_STATE`
        *ACCURACY_FIELDS,
    ]
)
"""Layout of the record of `LANES` Taylor steps. Scalars come last, so that the rows of lanes are aligned."""


def block_cells(
    rate: NDArray[np.float64],
    slenderness: NDArray[np.float64],
    eta: NDArray[np.float64],
    alpha: NDArray[np.float64],
    vertical: NDArray[np.float64] | float = 0.0,
) -> NDArray[np.void]:
    """Cells `BODY_CELL` (size,) of free blocks with equal edges, from arrays (size,)."""
    cells = np.zeros(rate.size, BODY_CELL)
    cells["rate"], cells["alpha"], cells["ratio"], cells["stiffness"] = rate, alpha, 1.0, 1.0
    cells["vertical"] = vertical
    cells["slenderness"], cells["eta"] = slenderness[:, None], eta[:, None]
    return cells


def block_cell(rate: float, slenderness: float, eta: float, alpha: float, vertical: float = 0.0) -> Record:
    """The cell of one block."""
    one = np.array([[rate], [slenderness], [eta], [alpha], [vertical]])
    return block_cells(one[0], one[1], one[2], one[3], one[4])[0]


RESPONSE_RECORD = record_dtype(SOLVED_FIELDS)  # record of the response of a cell

set_empty_response = constant_fields({field.name: field.at_rest for field in SOLVED_FIELDS})
"""set_empty_response(record): the response of a body without uplift, into a record of the solver or a response."""


@lru_cache(maxsize=256)
def pulse_state(pulse: AbstractPulse) -> Record:
    """The record `FLIGHT_STATE` of a pulse, to be copied before use."""
    record: Record = np.zeros(1, FLIGHT_STATE)[0]
    phases = np.array([pulse.start, *pulse.stationary, pulse.end])
    fill_excitation(record, pulse.series, phases)
    ends = len(phases)
    record["pieces"] = ends - 1
    record["end_phase"][:ends] = phases
    record["end_shape"][:ends] = f = pulse.shape(phases)
    for name, values in {"left": phases[:-1], "right": phases[1:], "f_left": f[:-1], "f_right": f[1:]}.items():
        record[f"crossing_{name}"].ravel()[: 2 * (ends - 1)] = np.repeat(values, 2)
    rise = np.where(np.diff(f) < 0.0, -1.0, 1.0)
    record["crossing_sign"].ravel()[: 2 * (ends - 1)] = np.stack((-rise, rise), axis=1).ravel()
    return record


def aligned_record(layout: np.dtype[np.void]) -> Record:
    """A record of zeros that starts at a multiple of the size of a vector."""
    memory = np.zeros(layout.itemsize + VECTOR_BYTES, np.uint8)
    start = -memory.ctypes.data % VECTOR_BYTES
    record: Record = memory[start : start + layout.itemsize].view(layout)[0]
    return record


def restraint_level(cells: NDArray[np.void]) -> int:
    """The field `restrained` of Taylor steps for cells `BODY_CELL`."""
    if cells["prestress"].any():
        return 2
    return int(cells["spring"].any() or cells["damping"].any())


def step_state(flight: Record, precision: float = FULL_PRECISION) -> Record:
    """Taylor steps for the pulse of a record of `pulse_state`.

    `precision`: largest ratio of the last terms of a step's series to the motion during the step [-], `FULL_PRECISION`
    to 1e-4. It sets the degree: 1 - log(precision)/2 gives the longest steps for the work, Jorba and Zou (2005).
    """
    steps = aligned_record(STEP_STATE)
    for name, *_ in EXCITATION_FIELDS:
        steps[name] = flight[name]
    steps["order"] = min(MAX_ORDER, math.ceil(2.0 - 0.5 * math.log(precision)))
    steps["log_precision"] = math.log2(precision)
    steps["reach"] = math.inf
    for name in AT_REST:
        steps[name] = 1.0
    return steps
