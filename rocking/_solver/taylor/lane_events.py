"""Impact and peak within a Taylor step of all lanes at once.

The conditions, and why they miss no event, are those of `rocking._solver.taylor.flight`. Left to its scalar functions
is what needs a search: a minimum of z while the block is destabilised, and peaks of which the bound of |w''| does not
show that there is one only.
"""

from typing import Any

from rocking._numba.compilation import Record, Series, SimdVector, kernel
from rocking._numba.simd import absolute, any_lane, load, maximum, minimum, select, splat, store

MAX_NEWTON_STEPS = 100  # steps after which the bracketed Newton iteration stops; bisection alone needs 55

NO_IMPACT, UNDECIDED = -1.0, -1.0
"""Time of an impact that does not take place in the step; peak that is left to the scalar functions."""


@kernel
def evaluate(series: Series, top: int, h: SimdVector) -> SimdVector:
    """Values of the series of degree `top` at h; `evaluate_series` of `rocking._solver.taylor.events`."""
    square, last = h * h, top - top % 2
    even, odd = load(series, last), splat(0.0)
    if last < top:
        odd = load(series, top)
    for i in range(2, last + 1, 2):
        n = last - i
        even = even * square + load(series, n)
        odd = odd * square + load(series, n + 1)
    return even + h * odd


@kernel
def values_and_slopes(series: Series, top: int, h: SimdVector) -> Any:
    """Values of the series of degree `top` at h, and their derivatives; `value_and_slope` for one lane."""
    square, last = h * h, top - top % 2
    even, odd, even_slope, odd_slope = load(series, last), splat(0.0), splat(0.0), splat(0.0)
    if last < top:
        odd = load(series, top)
    for i in range(2, last + 1, 2):
        n = last - i
        even_slope = even_slope * square + even
        even = even * square + load(series, n)
        odd_slope = odd_slope * square + odd
        odd = odd * square + load(series, n + 1)
    return even + h * odd, odd + 2.0 * h * (even_slope + h * odd_slope)


@kernel
def second_derivative_bounds(series: Series, top: int, h: SimdVector) -> SimdVector:
    """Bounds of the second derivatives of the series of degree `top` on [0, h]."""
    bound = splat(0.0)
    for i in range(top - 1):
        n = top - i
        bound = bound * h + absolute(load(series, n)) * (n * (n - 1.0))
    return bound


@kernel
def refine_roots(
    series: Series, top: int, low: SimdVector, high: SimdVector, deflated: Any, guess: SimdVector, wanted: Any
) -> Any:
    """The decreasing zeros of series between `low` and `high` where the mask `wanted` is true, and the slopes there.

    The mask `deflated` tells where the series is divided by h, which removes the zero at the start of a flight. The
    bracketed Newton iteration is the one of `rocking._solver.taylor.events.refine_root`.
    """
    h = select((guess > low) & (guess < high), guess, 0.5 * (low + high))
    going, before, slope, divides = wanted, splat(0.0), splat(0.0), any_lane(deflated & wanted)
    for _ in range(MAX_NEWTON_STEPS):
        value, rate = values_and_slopes(series, top, h)
        if divides:
            quotient = value / h
            rate = select(deflated, (rate - quotient) / h, rate)
            value = select(deflated, quotient, value)
        above = value > 0.0
        low, high = select(going & above, h, low), select(going & ~above, h, high)
        following = h - value / rate
        following = select((following >= low) & (following <= high), following, 0.5 * (low + high))
        step = absolute(following - h)
        h, slope = select(going, following, h), select(going, rate, slope)
        going = going & ~(step * step * step <= 1e-16 * absolute(h) * before * before)  # the next is below rounding
        if not any_lane(going):
            break
        before = step
    return h, slope


@kernel
def locate_events(steps: Record) -> None:
    """Set `impact`, the time of the impact in the step or `NO_IMPACT`, `impact_w`, and `peak` of the lanes in use.

    `peak` is the largest z inside the step, before the impact, if it can exceed `known`, else 0; or `UNDECIDED`.
    """
    in_use, destabilised = load(steps.in_use, 0) > 0.0, load(steps.destabilised, 0) > 0.0
    no_peak = destabilised & (load(steps.may_turn, 0) == 0.0)
    at_ground = load(steps.at_ground, 0) > 0.0
    h, w0, z, w = load(steps.h, 0), load(steps.w0, 0), load(steps.z1, 0), load(steps.w1, 0)
    zero = splat(0.0)
    # z <= 0 at the end is an impact, but for a destabilised block that rises: there it is rounding at the ground
    has_impact = in_use & (z <= 0.0) & ~(destabilised & (w0 >= 0.0))
    impact = splat(NO_IMPACT)
    if any_lane(has_impact):
        # first guess: the zero of a parabola from z = 0, otherwise a Newton step from the end of the step
        guess = select(at_ground, 2.0 * w0 * h / (w0 - w), h - z / w)
        root, _ = refine_roots(steps.z, steps.order, zero, h, at_ground, guess, has_impact)
        h, z = select(has_impact, root, h), select(has_impact, zero, z)
        w = select(has_impact, evaluate(steps.rate, steps.order - 1, h), w)
        impact = select(has_impact, h, impact)
    store(steps.impact, 0, impact)
    store(steps.impact_w, 0, w)
    # peaks, by the conditions of `highest_peak`: none where w keeps its sign (steady), where z stays below the largest
    # so far (low), or while the block is destabilised; for certain one where w falls through zero (turns)
    start = (load(steps.restoring_phase, 0) - load(steps.phase, 0)) / load(steps.omega, 0)
    bound = load(steps.second_derivative_bound, 0)
    sagitta = 0.125 * bound * h * h
    steady = (w0 * w > 0.0) & (minimum(absolute(w0), absolute(w)) > sagitta)
    speed = maximum(absolute(w0), absolute(w)) + sagitta
    low = 0.5 * (load(steps.z0, 0) + z + speed * h) <= load(steps.known, 0)
    possible = in_use & ~no_peak & (start < h) & ~steady & ~low
    peak, undecided = select(possible, splat(UNDECIDED), zero), possible
    turns, start = possible & (w0 >= 0.0) & (w < 0.0), maximum(start, zero)
    reach, slope, tops = h, zero, zero
    if any_lane(turns):
        top, slope = refine_roots(steps.rate, steps.order - 1, start, h, ~turns & turns, h * w0 / (w0 - w), turns)
        reach = maximum(top - start, h - top)
        tops = evaluate(steps.z, steps.order, top)
        single = turns & (2.0 * absolute(slope) > bound * reach)  # |w - slope (t - top)| <= bound (t - top)^2/2
        peak, undecided = select(single, tops, peak), undecided & ~single
    # the bound of the whole step was too wide: once more with the bound up to the impact, and with w at the place where
    # the acceleration becomes restoring in place of w at the start of the step
    if any_lane(undecided):
        bound = second_derivative_bounds(steps.rate, steps.order - 1, h)
        single = undecided & turns & (2.0 * absolute(slope) > bound * reach)
        peak = select(single, tops, peak)
        w0 = evaluate(steps.rate, steps.order - 1, start)
        steady = (w0 * w > 0.0) & (minimum(absolute(w0), absolute(w)) > 0.125 * bound * (h - start) * (h - start))
        peak = select(undecided & steady, zero, peak)
    store(steps.peak, 0, peak)
