"""State of the stages: a record of `LANES` cells, and one row of numbers for each cell that waits for a stage."""

from typing import NamedTuple

import numpy as np

from rocking._excitation.shapes import MAX_PIECES
from rocking._excitation.sinusoids import MAX_SINUSOIDS
from rocking._excitation.wavelets import MAX_POLYNOMIAL
from rocking._numba.compilation import Record
from rocking._numba.simd import LANES
from rocking._solver.families.wavelets import WAVELET_SERIES_LENGTH
from rocking._solver.state import aligned_record

BLOCK_SIZE = 1536
"""Cells of a block, which passes all stages before the next: their rows fit into the second-level cache."""

BUCKETS = 256  # classes of slenderness, in whose order the cells of a block are followed
LIST_COUNT = 7  # lists of cells, see `rocking._solver.stages.lists`

FAR = 1.0  # time [tau] given to cells that are not concerned: it is outside the series at the start of every flight

FINISHED, LONG, SHORT, REPEATED, REST, UNDECIDED = 0, 1, 2, 3, 4, 5
"""What follows for a cell: nothing, a long or a short flight with the opposite sign of rotation, a long one with the
same sign, rest, or the event loop."""

_LANE_FIELDS = (
    # the cell; `reach`: time [tau] up to which the series at the start of the flight is exact to rounding
    *("a", "reciprocal_omega", "reach"),
    "max_rate",  # largest of 1 and the rates Omega
    "half_width",  # arccos(1/a) [rad]
    "node_share",  # of the nodes of a piece, 0 to 1
    *("q0", "x0", "y0", "offset_z", "offset_w"),  # the arc, as in `rocking._solver.state.FLIGHT_STATE`
    # of a wavelet: sgn(theta) a; phase and exp(-phase^2/spread) at the phase of the last `set_angles`, and at the start
    *("strength", "phase", "gaussian", "gaussian0"),
    "decay",  # sqrt(spread)/(2 omega), see `rocking._solver.stages.wavelets`
    # progress of the flight
    "followed",  # 1 where it is still followed, else 0
    "undecided",  # 1 where it is left to the event loop, else 0
    "known",  # 1 where the state below is known; 0 where it is not and w > 0
    *("left_h", "left_z", "left_w", "left_q"),  # time, z, w and q at the left end of the next part of the pulse
    *("peak_pending", "peak_low", "peak_high", "peak_guess"),  # 1 where a peak is to be located; bracket, first guess
    *("found_peak_h", "found_peak_z", "found_peak_slope"),  # the last located one, with the slope of w
    # the impact to be located: the bracket with the states at its ends
    *("impact_low", "impact_low_z", "impact_low_w", "impact_low_slope"),
    *("impact_high", "impact_high_z", "impact_high_w", "impact_high_slope"),
    "impact_after_peak",  # 1 where the bracket starts with the last peak
    # end of the flight: `IMPACT`, `PULSE_END`, or `IN_FLIGHT` where it is undecided; its duration [tau]; largest z
    *("ended", "length", "end_z", "end_w", "top"),
    # the response; what follows, `FINISHED` to `UNDECIDED`; state at the end of the pulse, or where it overturns
    *("outcome", "next", "free_z", "free_w"),
)


def _group_layout() -> np.dtype[np.void]:
    lanes, rows, terms, pieces = (LANES,), (LANES, LANES), (MAX_SINUSOIDS, LANES), (MAX_PIECES, LANES)
    return np.dtype(
        [
            ("columns", np.float64, rows),  # of the rows of the cells
            ("shared", np.float64, rows),  # the same at the end of a first flight that several cells share
            *((name, np.float64, lanes) for name in _LANE_FIELDS),
            *((name, np.float64, terms) for name in ("force", "rate", "particular")),
            *((name, np.float64, terms) for name in ("cosine0", "sine0", "cosine", "sine")),
            # coefficients: of z about the start of the flight; of F for a wavelet; of its Gaussian, in powers of phi
            *((name, np.float64, (WAVELET_SERIES_LENGTH, LANES)) for name in ("series", "excitation", "gauss")),
            ("arc", np.float64, (MAX_POLYNOMIAL, LANES)),  # coefficients of its particular solution
            ("node_shape", np.float64, pieces),  # f at equidistant phases of each piece of the pulse, and df/dphi
            ("node_slope", np.float64, pieces),
            ("place", np.int64, lanes),  # row of the cell, BLOCK_SIZE: none
            ("expanded", np.int64),  # 1 once `series` and `excitation` are of this flight
            ("used", np.int64),  # bits of the lanes that hold a cell
            ("source", np.int64, lanes),  # the same, with a cell in every lane
            ("leader", np.int64, lanes),  # row of the first cell that shares its flight
        ]
    )


GROUP_STATE = _group_layout()
"""Layout of the record of `LANES` cells. All fields before `place` are rows of a SIMD vector."""


CELLS_STATE = np.dtype(
    [
        ("rows", np.float64, (BLOCK_SIZE + 1, LANES)),  # of cells that have flown; the last is for unused lanes
        ("lists", np.int64, (LIST_COUNT, BLOCK_SIZE + LANES)),  # places in the block
        ("counts", np.int64, (LIST_COUNT,)),  # lengths of the lists
        ("members", np.int64, (BLOCK_SIZE + 1,)),  # number of cells that share the first flight of a cell
        ("ends", np.int64, (BUCKETS,)),  # places so far in the sorted list of each class of slenderness
        ("ordered", np.int64, (BLOCK_SIZE,)),  # the sorted list
    ]
)
"""Layout of the record of the cells of a block, which wait in lists."""


class StageState(NamedTuple):
    """State of the stages of one thread."""

    group: Record  # the cells in work
    cells: Record  # all cells of a block


def stage_state() -> StageState:
    """A new state."""
    return StageState(aligned_record(GROUP_STATE), aligned_record(CELLS_STATE))
