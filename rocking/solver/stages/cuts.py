"""Phases at which |a f| = 1, for `LANES` cells.

On a monotone piece of the pulse a block with sgn(theta) = sign is destabilised where g = -sign f exceeds 1/a, restored
where it is smaller. The cut between both is unique. If there is none it is put at an end of the piece, so that the
destabilised or the restored part is empty and all cells have the same sequence of parts.
"""

from __future__ import annotations

import math
from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import absolute, any_lane, load, maximum, minimum, select, splat, store
from rocking._numba.simd_exponentials import arccosine
from rocking._numba.simd_sines import sine_and_cosine
from rocking.solver.excitation import is_unit_sinusoid
from rocking.solver.stages.state import SLENDERNESS

MAX_NEWTON_STEPS = 100
"""Steps after which the bracketed Newton iteration stops; bisection alone needs 55."""


@kernel
def init_cuts(pulse: Record, group: Record) -> None:
    """Set the half-width of |f| > 1/a about an extremum, arccos(1/a), for a single sinusoid."""
    if is_unit_sinusoid(pulse):
        store(group.half_width, 0, arccosine(minimum(load(group.columns, SLENDERNESS), splat(1.0))))


@kernel
def cut_phases(pulse: Record, group: Record, piece: int, sign: float) -> Any:
    """Phases of the cuts on a piece of the pulse [rad]."""
    s = load(group.columns, SLENDERNESS)
    left, right = pulse.end_phase[piece], pulse.end_phase[piece + 1]
    g_left, g_right = -sign * pulse.end_shape[piece], -sign * pulse.end_shape[piece + 1]
    rising = g_right >= g_left
    lowest, highest = min(g_left, g_right), max(g_left, g_right)
    inside = (s > lowest) & (s < highest)
    # g < 1/a on the whole piece, or above
    ends = select(s >= highest, splat(right if rising else left), splat(left if rising else right))
    if not any_lane(inside):
        return ends
    if is_unit_sinusoid(pulse):
        half_width = load(group.half_width, 0)
        peak_at_left = -sign * pulse.amplitude[0] * pulse.half_period_cosine[piece] > 0.0
        distance = half_width if peak_at_left else math.pi - half_width
        found = minimum(maximum(pulse.half_period_phase[piece] + distance, splat(left)), splat(right))
    else:
        found = cuts_by_newton(pulse, s * -sign, left, right, rising == (sign < 0.0))
    return select(inside, found, ends)


@kernel
def cuts_by_newton(pulse: Record, level: SimdVector, left: float, right: float, rising: bool) -> Any:
    """The phases at which f, monotone on [left, right], equals `level`; any phase where it does not."""
    low, high = splat(left), splat(right)
    phase = 0.5 * (low + high)
    going = low < high
    for _ in range(MAX_NEWTON_STEPS):
        f, slope = splat(0.0), splat(0.0)
        for k in range(pulse.terms):
            sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
            f += pulse.amplitude[k] * cosine
            slope -= pulse.amplitude[k] * pulse.multiple[k] * sine
        above = (f >= level) if rising else (f <= level)
        high, low = select(going & above, phase, high), select(going & ~above, phase, low)
        following = phase - (f - level) / slope
        following = select((following > low) & (following < high), following, 0.5 * (low + high))
        moved = absolute(following - phase)
        phase = select(going, following, phase)
        going = going & (moved > 4.5e-16 * absolute(phase))
        if not any_lane(going):
            break
    return phase
