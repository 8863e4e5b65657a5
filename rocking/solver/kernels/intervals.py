"""Division of the pulse into intervals on which events can be located with certainty.

The interval ends are the phases at which one of the edges is on the point of uplift (a_s f = 1 on the left edge, -1 on
the right one) and at which f' = 0. Between two of them q = 1 + F keeps its sign on both edges, and so does q'. By the
maximum principle for z'' - z = -q (and for its derivative, w'' - w = -q'), with z >= 0 at the left end:

- q >= 0: z has no zero inside unless it is negative at the right end, and then exactly one;
- q <= 0: z is convex where it is positive: no zero unless w < 0 at the left end, and then at most two with one minimum
  between; no maximum of z inside;
- q' >= 0 or q' <= 0 determine the zeros of w, which are the peaks, in the same way.

Single sinusoids have closed forms for the interval ends and the cosine and sine there; for other excitations
`rocking.solver.crossings` finds them.
"""

from __future__ import annotations

import math

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import LANES
from rocking.solver.crossings import find_crossings
from rocking.solver.excitation import is_unit_sinusoid


@kernel
def set_interval(flight: Record, index: int, phase: float, level: float, rise: float) -> None:
    """Set the left end of an interval, the level and the sign of f' in it."""
    flight.interval_phase[index] = phase
    flight.interval_level[index] = level
    flight.interval_slope[index] = rise


@kernel
def cap(slenderness: float) -> tuple[float, float]:
    """Sine and value of the half-width of |f| > 1/a about an extremum of a sinusoid, accurate also for 1/a near 1."""
    root = math.sqrt(max((1.0 - slenderness) * (1.0 + slenderness), 0.0))
    return root, math.atan2(root, slenderness)  # cos(half-width) = 1/a


@kernel
def split_into_intervals(flight: Record) -> int:
    """Fill `flight.interval_*` (intervals + 1) for the body of the cell; returns the number of intervals.

    Levels of f: above 1/a_1 the body is destabilised on the left edge (level 1), below -1/a_0 on the right one (level
    -1), between them on neither (level 0). On a monotone piece each of them is crossed at most once; the crossing with
    sgn(f) opposite to f' comes first.
    """
    angles = flight.terms if flight.by_arcs == 1 else 0  # of which Taylor steps need no cosines and sines
    single = is_unit_sinusoid(flight)
    below, above = flight.slenderness[0], flight.slenderness[1]
    root_below, width_below, root_above, width_above = 0.0, 0.0, 0.0, 0.0
    if single:
        root_below, width_below = cap(below)
        root_above, width_above = (root_below, width_below) if above == below else cap(above)
    else:
        find_crossings(below, above, flight)
    count = 0
    for piece in range(flight.pieces):
        left = flight.end_phase[piece]
        f_left, f_right = flight.end_shape[piece], flight.end_shape[piece + 1]
        rise = -1.0 if f_left > f_right else 1.0
        level = 1.0 if f_left > above else (-1.0 if f_left < -below else 0.0)
        set_interval(flight, count, left, level, rise)
        for k in range(angles):
            flight.interval_cosine[count, k], flight.interval_sine[count, k] = (
                flight.end_cosine[piece, k],
                flight.end_sine[piece, k],
            )
        count += 1
        for turn in (-rise, rise):
            target = above if turn > 0.0 else -below
            entered = f_left == target and turn == rise  # where the pulse starts at |a f| = 1 and |f| grows
            if not (entered or min(f_left, f_right) < target < max(f_left, f_right)):
                continue
            level += rise
            if single:
                cosine = flight.half_period_cosine[piece]  # the cosine decreases from +1 here, or increases from -1
                root, half_width = (root_above, width_above) if turn > 0.0 else (root_below, width_below)
                value = target * flight.amplitude[0]
                distance = half_width if value * cosine > 0.0 else math.pi - half_width
                set_interval(flight, count, flight.half_period_phase[piece] + distance, level, rise)
                flight.interval_cosine[count, 0], flight.interval_sine[count, 0] = value, cosine * root
            else:
                crossing = 2 * piece + (0 if turn == -rise else 1)
                phi = left if entered else flight.crossing_phase[crossing // LANES, crossing % LANES]
                set_interval(flight, count, phi, level, rise)
                for k in range(angles):
                    angle = flight.multiple[k] * phi + flight.shift[k]
                    flight.interval_cosine[count, k], flight.interval_sine[count, k] = math.cos(angle), math.sin(angle)
            count += 1
    set_interval(flight, count, flight.end_phase[flight.pieces], 0.0, 0.0)
    for k in range(angles):
        flight.interval_cosine[count, k], flight.interval_sine[count, k] = (
            flight.end_cosine[flight.pieces, k],
            flight.end_sine[flight.pieces, k],
        )
    return count
