"""Uplifts of blocks at rest: the piece of the pulse that holds them, and their phase there."""

from __future__ import annotations

import math
from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import any_lane, load, select, splat, store
from rocking._solver.stages.cuts import cut_phases, init_cuts
from rocking._solver.stages.state import OMEGA, PHASE, PIECE, UPLIFT_TIME, UPLIFTS


@kernel
def uplift_piece(pulse: Record, slenderness: float, phase: float) -> tuple[int, float]:
    """Piece of the pulse with the first uplift of a block at rest at `phase`, and its sgn(theta), 0 if there is none.

    |f| < 1/a at `phase`, so that |f| reaches 1/a on the first piece with |f| > 1/a at its right end.
    """
    for piece in range(pulse.pieces):
        f = pulse.end_shape[piece + 1]
        if pulse.end_phase[piece + 1] > phase and abs(f) > slenderness:
            return piece, -math.copysign(1.0, f)
    return -1, 0.0


@kernel
def first_uplifts(pulse: Record, slenderness: SimdVector) -> Any:
    """Pieces of the pulse with the first uplifts of blocks at rest at its start, and their sgn(theta), 0: no uplift.

    The piece is -1 where |f| exceeds 1/a at the start. The vector form of `uplift_piece`.
    """
    pieces, signs = splat(-1.0), splat(0.0)
    for i in range(pulse.pieces):
        piece = pulse.pieces - 1 - i
        f = pulse.end_shape[piece + 1]
        reached = slenderness < abs(f)
        pieces = select(reached, splat(float(piece)), pieces)
        signs = select(reached, splat(-math.copysign(1.0, f)), signs)
    f = pulse.end_shape[0]
    exceeded = slenderness < abs(f)
    return select(exceeded, splat(-1.0), pieces), select(exceeded, splat(-math.copysign(1.0, f)), signs)


@kernel
def start_uplifts(pulse: Record, group: Record, sign: float) -> None:
    """Set the phase and the time of the uplifts that are given by their piece."""
    pieces = load(group.columns, PIECE)
    if not any_lane(pieces >= 0.0):
        return
    init_cuts(pulse, group)
    phase = load(group.columns, PHASE)
    for piece in range(pulse.pieces):
        here = pieces == float(piece)
        if any_lane(here):
            phase = select(here, cut_phases(pulse, group, piece, sign), phase)
    store(group.columns, PHASE, phase)
    first = (pieces >= 0.0) & (load(group.columns, UPLIFTS) == 1.0)
    time = (phase - pulse.end_phase[0]) / load(group.columns, OMEGA)
    store(group.columns, UPLIFT_TIME, select(first, time, load(group.columns, UPLIFT_TIME)))
    store(group.columns, PIECE, splat(-1.0))
