"""Division of the pulse into intervals on which events can be located with certainty.

The interval ends are the phases at which one of the edges is on the point of uplift (a_s f = 1 on the left edge, -1 on
the right one) and at which f' = 0. Between two of them q = 1 + F keeps its sign on both edges, and so does q'. By the
maximum principle for z'' - z = -q (and for its derivative, w'' - w = -q'), with z >= 0 at the left end:

- q >= 0: z has no zero inside unless it is negative at the right end, and then exactly one;
- q <= 0: z is convex where it is positive: no zero unless w < 0 at the left end, and then at most two with one minimum
  between; no maximum of z inside;
- q' >= 0 or q' <= 0 determine the zeros of w, which are the peaks, in the same way.

Single sinusoids have closed forms for the interval ends; for other excitations `rocking._solver.crossings` finds them.
"""

import math

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import LANES
from rocking._solver.crossings import find_crossings
from rocking._solver.families.sinusoids import is_unit_sinusoid


@kernel
def set_interval(flight: Record, index: int, phase: float, level: float, rise: float) -> None:
    """Set the left end of an interval, the level and the sign of f' in it."""
    flight.interval_phase[index] = phase
    flight.interval_level[index] = level
    flight.interval_slope[index] = rise


@kernel
def half_width(slenderness: float) -> float:
    """Half of the width [rad] of |f| > 1/a about an extremum of a sinusoid: arccos(1/a), also accurate near 1/a = 1."""
    return math.atan2(math.sqrt(max((1.0 - slenderness) * (1.0 + slenderness), 0.0)), slenderness)


@kernel
def crossing_of_sinusoid(flight: Record, piece: int, target: float, width: float) -> float:
    """Phase at which a single sinusoid of amplitude 1 equals `target` on a piece, where |f| > 1/a has the half-width.

    The sinusoid is cos(x), x from the start of the half period: there the cosine of the angle is +1 and decreases, or
    -1 and increases.
    """
    start: float = flight.half_period_phase[piece]
    near_start = target * flight.amplitude[0] * flight.half_period_cosine[piece] > 0.0
    return start + (width if near_start else math.pi - width)


@kernel
def split_into_intervals(flight: Record) -> int:
    """Fill `flight.interval_*` (intervals + 1) for the body of the cell; returns the number of intervals.

    Given: the monotone pieces of the pulse with f at their ends, and the slenderness of both edges. Decided: which ends
    of intervals lie on each piece. Above f = 1/a_1 the body is destabilised on the left edge (level 1), below -1/a_0 on
    the right one (level -1), between them on neither (level 0). No crossing is missed: on a monotone piece f takes the
    value 1/a_1, or -1/a_0, once if it lies between the values at the ends, and otherwise never.

    Worked example: the sine, a = 2 on both edges. Its pieces end at 0, pi/2, 3 pi/2 and 2 pi. On the first f rises from
    0 to 1 and crosses 1/2 at pi/6: intervals from 0 (level 0) and pi/6 (level 1). On the second it falls through 1/2 at
    5 pi/6 and -1/2 at 7 pi/6: intervals from pi/2 (level 1), 5 pi/6 (level 0), 7 pi/6 (level -1). The last one, from
    3 pi/2, is left at 11 pi/6: seven intervals.
    """
    single = is_unit_sinusoid(flight)
    below, above = flight.slenderness[0], flight.slenderness[1]
    width_below, width_above = 0.0, 0.0
    if single:
        width_below = half_width(below)
        width_above = width_below if above == below else half_width(above)
    else:
        find_crossings(below, above, flight)
    count = 0
    for piece in range(flight.pieces):
        f_left, f_right = flight.end_shape[piece], flight.end_shape[piece + 1]
        rise = -1.0 if f_left > f_right else 1.0
        level = 1.0 if f_left > above else (-1.0 if f_left < -below else 0.0)
        set_interval(flight, count, flight.end_phase[piece], level, rise)
        count += 1
        # a piece that rises passes -1/a_0 first, where the right edge is held down again, then 1/a_1, where the left
        # one is destabilised; a piece that falls passes them in the other order
        for turn in (-rise, rise):
            target = above if turn > 0.0 else -below
            entered = f_left == target and turn == rise  # the pulse starts at |a f| = 1, and |f| grows
            if not (entered or min(f_left, f_right) < target < max(f_left, f_right)):
                continue
            level += rise  # either crossing of a rising piece raises the level by one
            if single:
                phase = crossing_of_sinusoid(flight, piece, target, width_above if turn > 0.0 else width_below)
            elif entered:
                phase = flight.end_phase[piece]
            else:
                crossing = 2 * piece + (0 if turn == -rise else 1)
                phase = flight.crossing_phase[crossing // LANES, crossing % LANES]
            set_interval(flight, count, phase, level, rise)
            count += 1
    set_interval(flight, count, flight.end_phase[flight.pieces], 0.0, 0.0)  # the end of the last interval
    return count
