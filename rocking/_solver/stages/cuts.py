"""Phases at which |a f| = 1, for `LANES` cells: cuts of the pieces of the pulse, and uplifts of blocks at rest.

On a monotone piece of the pulse a block with sgn(theta) = sign is destabilised where g = -sign f exceeds 1/a, restored
where it is smaller. The cut between both is unique. If there is none it is put at an end of the piece, so that the
destabilised or the restored part is empty and all cells have the same sequence of parts.
"""

import math
from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import LANES, any_lane, load, maximum, minimum, select, splat, store, store_where
from rocking._numba.simd_functions import arccosine
from rocking._solver.crossings import refine_crossings
from rocking._solver.excitation import shapes_and_slopes
from rocking._solver.families.sinusoids import is_unit_sinusoid
from rocking._solver.stages import columns as column
from rocking._solver.stages.roots import hermite_roots


@kernel
def init_cuts(pulse: Record, group: Record) -> None:
    """Set the half-width of |f| > 1/a about an extremum, arccos(1/a), for a single sinusoid."""
    if is_unit_sinusoid(pulse):
        store(group.half_width, 0, arccosine(minimum(load(group.columns, column.SLENDERNESS), splat(1.0))))


@kernel
def cut_phases(pulse: Record, group: Record, piece: int, sign: float) -> Any:
    """Phases of the cuts on a piece of the pulse [rad]."""
    s = load(group.columns, column.SLENDERNESS)
    left, right = pulse.end_phase[piece], pulse.end_phase[piece + 1]
    g_left, g_right = -sign * pulse.end_shape[piece], -sign * pulse.end_shape[piece + 1]
    rising = g_right >= g_left
    lowest, highest = min(g_left, g_right), max(g_left, g_right)
    inside = (s > lowest) & (s < highest)
    # no cut: g < 1/a on the whole piece, which is restored, or g > 1/a, and it is destabilised
    ends = select(s >= highest, splat(right if rising else left), splat(left if rising else right))
    if not any_lane(inside):
        return ends
    if is_unit_sinusoid(pulse):  # arccos(1/a) from the peak of g, at whichever end of the piece that lies
        half_width = load(group.half_width, 0)
        peak_at_left = -sign * pulse.amplitude[0] * pulse.half_period_cosine[piece] > 0.0
        distance = half_width if peak_at_left else math.pi - half_width
        found = minimum(maximum(pulse.half_period_phase[piece] + distance, splat(left)), splat(right))
    else:
        found = cuts_by_newton(pulse, group, piece, s * -sign, rising == (sign < 0.0), inside)
    return select(inside, found, ends)


@kernel
def init_nodes(pulse: Record, group: Record) -> None:
    """Set f and its slope at `LANES` equidistant phases of each piece of the pulse, for `cuts_by_newton`."""
    if is_unit_sinusoid(pulse):
        return
    for lane in range(LANES):
        group.node_share[lane] = lane / (LANES - 1.0)
    share = load(group.node_share, 0)
    for piece in range(pulse.pieces):
        left, right = pulse.end_phase[piece], pulse.end_phase[piece + 1]
        f, slope = shapes_and_slopes(pulse, left + (right - left) * share)
        store(group.node_shape, piece, f)
        store(group.node_slope, piece, slope)


@kernel
def cuts_by_newton(pulse: Record, group: Record, piece: int, level: SimdVector, rising: bool, wanted: Any) -> Any:
    """The phases at which f, monotone on a piece of the pulse, equals `level`, where the mask `wanted` is true.

    The two nodes beside the level give the bracket, and the cubic through both the first guess.
    """
    left, right = pulse.end_phase[piece], pulse.end_phase[piece + 1]
    spacing = (right - left) / (LANES - 1.0)
    shapes, slopes = group.node_shape[piece], group.node_slope[piece]
    low = splat(left)
    f_low, slope_low = splat(shapes[0]), splat(slopes[0])
    f_high, slope_high = splat(shapes[1]), splat(slopes[1])
    # move the bracket on, node by node, as long as the level lies beyond: lanes differ in it and cannot branch
    for node in range(1, LANES - 1):
        beyond = (level > shapes[node]) if rising else (level < shapes[node])
        low = select(beyond, splat(left + node * spacing), low)
        f_low, slope_low = select(beyond, splat(shapes[node]), f_low), select(beyond, splat(slopes[node]), slope_low)
        f_high = select(beyond, splat(shapes[node + 1]), f_high)
        slope_high = select(beyond, splat(slopes[node + 1]), slope_high)
    high = minimum(low + spacing, splat(right))
    phase = low + hermite_roots(f_low - level, slope_low, f_high - level, slope_high, high - low)
    phase = select((phase > low) & (phase < high), phase, 0.5 * (low + high))
    rise = splat(1.0 if rising else -1.0)
    return refine_crossings(pulse, level, rise, (splat(left), splat(right)), low, high, phase, wanted)


@kernel
def uplift_piece(pulse: Record, slenderness: float, phase: float) -> tuple[int, float]:
    """Piece of the pulse with the first uplift of a block at rest at `phase`, and its sgn(theta), 0 if there is none.

    |f| < 1/a at `phase`. f is monotone on a piece, so that |f| first reaches 1/a on the first piece with |f| > 1/a at
    its right end: no uplift is missed.
    """
    for piece in range(pulse.pieces):
        f = pulse.end_shape[piece + 1]
        if pulse.end_phase[piece + 1] > phase and abs(f) > slenderness:
            return piece, -math.copysign(1.0, f)
    return -1, 0.0


@kernel
def first_uplift_pieces(pulse: Record, slenderness: SimdVector) -> Any:
    """Pieces of the pulse with the first uplifts of blocks at rest at its start, as `uplift_piece`.

    The piece is -1 where |f| exceeds 1/a at the start.
    """
    pieces = splat(-1.0)
    for i in range(pulse.pieces):
        piece = pulse.pieces - 1 - i
        pieces = select(slenderness < abs(pulse.end_shape[piece + 1]), splat(float(piece)), pieces)
    return select(slenderness < abs(pulse.end_shape[0]), splat(-1.0), pieces)


@kernel
def start_uplifts(pulse: Record, group: Record, sign: float) -> None:
    """Set the phase and the time of the uplifts that are given by their piece."""
    pieces = load(group.columns, column.PIECE)
    if not any_lane(pieces >= 0.0):
        return
    init_cuts(pulse, group)
    phase = load(group.columns, column.PHASE)
    for piece in range(pulse.pieces):
        here = pieces == float(piece)
        if any_lane(here):
            phase = select(here, cut_phases(pulse, group, piece, sign), phase)
    store(group.columns, column.PHASE, phase)
    first = (pieces >= 0.0) & (load(group.columns, column.UPLIFTS) == 1.0)
    time = (phase - pulse.end_phase[0]) / load(group.columns, column.OMEGA)
    store_where(group.columns, column.UPLIFT_TIME, first, time)
    store(group.columns, column.PIECE, splat(-1.0))
