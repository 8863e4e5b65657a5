"""Phases at which f crosses a level on monotone pieces of the pulse: bracketed Newton iterations, `LANES` at a time."""

import math
from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import LANES, absolute, any_lane, load, maximum, minimum, select, splat, square_root, store
from rocking._numba.simd_functions import arccosine
from rocking._solver.excitation import shapes_and_slopes

MAX_NEWTON_STEPS = 100  # steps after which the bracketed Newton iteration stops; bisection alone needs 55


@kernel
def refine_crossings(
    pulse: Record,
    level: SimdVector,
    rise: SimdVector,
    ends: tuple[SimdVector, SimdVector],
    low: SimdVector,
    high: SimdVector,
    phase: SimdVector,
    wanted: Any,
) -> Any:
    """The phases between `low` and `high` at which f equals `level`, where the mask `wanted` is true.

    `rise` is the sign of f' on the piece of the pulse, which has the given ends; `phase` is a first guess. f is
    monotone between the ends, so that the bracket holds one crossing. The iteration ends where its next step would be
    below rounding: near an extremum, where f' vanishes, that is the square of the last one over the distance from it.
    """
    left, right = ends
    going = wanted
    for _ in range(MAX_NEWTON_STEPS):
        f, slope = shapes_and_slopes(pulse, phase)
        excess = f - level
        above = excess * rise >= 0.0
        high, low = select(going & above, phase, high), select(going & ~above, phase, low)
        following = phase - excess / slope
        inside = (following >= low) & (following <= high)
        following = select(inside, following, 0.5 * (low + high))
        moved = absolute(following - phase)
        edge = minimum(following - left, right - following)
        phase = select(going, following, phase)
        arrived = inside & (moved * moved <= 1e-17 * absolute(phase) * edge)
        going = going & ~arrived & (high - low > 4.5e-16 * absolute(phase))
        if not any_lane(going):
            break
    return phase


@kernel
def find_crossings(below: float, above: float, flight: Record) -> None:
    """Set `crossing_phase` to the phases at which f = -`below` and f = `above` on the pieces that contain them.

    The crossing with sgn(f) opposite to f' on a piece precedes the other one. The first guess is a cosine
    between the ends of the piece.
    """
    for row in range((2 * flight.pieces + LANES - 1) // LANES):
        left, right = load(flight.crossing_left, row), load(flight.crossing_right, row)
        f_left, f_right = load(flight.crossing_f_left, row), load(flight.crossing_f_right, row)
        sign = load(flight.crossing_sign, row)
        level = select(sign > 0.0, above * sign, below * sign)
        wanted = (level > minimum(f_left, f_right)) & (level < maximum(f_left, f_right))
        if not any_lane(wanted):
            continue
        share = select(wanted, (level - f_left) / (f_right - f_left), splat(0.5))
        phase = left + (right - left) * (1.0 - arccosine(square_root(share)) * (2.0 / math.pi))
        rise = select(f_right > f_left, splat(1.0), splat(-1.0))
        phase = refine_crossings(flight, level, rise, (left, right), left, right, phase, wanted)
        store(flight.crossing_phase, row, phase)
