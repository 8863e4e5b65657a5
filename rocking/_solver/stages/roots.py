"""First guesses of zeros by polynomials, and peaks and impacts of `LANES` flights inside their brackets.

Given: brackets that hold one zero each (`rocking._solver.stages.flight` has shown it). Found: the zero, to rounding.

Each iteration evaluates the exact arc, and continues by reversion of the Taylor series of fourth order there. With
y = -v/v', b_n = v^(n)/(n! v') the zero of v is y - b_2 y^2 + (2 b_2^2 - b_3) y^3 + (5 b_2 b_3 - 5 b_2^3 - b_4) y^4,
with an error of about 14 r^4 y where r is the largest of |b_2 y| and the rate times |y|. The bracket shrinks in every
iteration; a step out of it is replaced by its middle.
"""

from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import absolute, any_lane, load, maximum, select, splat, store, store_where
from rocking._solver.stages import columns as column
from rocking._solver.stages.arcs import motions_at
from rocking._solver.stages.excitation import set_angles
from rocking._solver.stages.state import FAR


@kernel
def hermite_roots(f0: SimdVector, d0: SimdVector, f1: SimdVector, d1: SimdVector, length: SimdVector) -> Any:
    """Guess of the zero in [0, length] of the cubic through two values of opposite sign with their slopes.

    Two Newton steps from the secant.
    """
    # in x = time/length: f0 + d0 x + c2 x^2 + c3 x^3
    d0 = d0 * length
    d1 = d1 * length
    c2 = 3.0 * (f1 - f0) - 2.0 * d0 - d1
    c3 = 2.0 * (f0 - f1) + d0 + d1
    x = f0 / (f0 - f1)
    for _ in range(2):
        better = x - (f0 + x * (d0 + x * (c2 + x * c3))) / (d0 + x * (2.0 * c2 + x * 3.0 * c3))
        x = select((better > 0.0) & (better < 1.0), better, x)
    return x * length


@kernel
def quintic_roots(of_w: bool, low: Any, high: Any, length: SimdVector) -> Any:
    """Guess of the zero of z in [0, length], or of w = dz/dtau, from z, w and dw/dtau at both ends.

    Two Newton steps on the quintic through these, from the zero of the cubic through the function and its slopes: the
    quintic is more accurate by two orders, and an arc costs as much as ten of these steps.
    """
    (z0, w0, slope0), (z1, w1, slope1) = low, high
    w0, w1 = w0 * length, w1 * length
    slope0, slope1 = slope0 * (length * length), slope1 * (length * length)
    # in x: z0 + w0 x + c2 x^2 + c3 x^3 + c4 x^4 + c5 x^5
    c2 = 0.5 * slope0
    rest, rest_w, rest_slope = (z1 - z0) - (w0 + c2), w1 - (w0 + slope0), 0.5 * (slope1 - slope0)
    c3 = 10.0 * rest - 4.0 * rest_w + rest_slope
    c4 = 7.0 * rest_w - 15.0 * rest - 2.0 * rest_slope
    c5 = 6.0 * rest - 3.0 * rest_w + rest_slope
    one = splat(1.0)
    x = hermite_roots(w0, slope0, w1, slope1, one) if of_w else hermite_roots(z0, w0, z1, w1, one)
    for _ in range(2):
        w = w0 + x * (slope0 + x * (3.0 * c3 + x * (4.0 * c4 + x * (5.0 * c5))))
        if of_w:
            better = x - w / (slope0 + x * (6.0 * c3 + x * (12.0 * c4 + x * (20.0 * c5))))
        else:
            better = x - (z0 + x * (w0 + x * (c2 + x * (c3 + x * (c4 + x * c5))))) / w
        x = select((better > 0.0) & (better < 1.0), better, x)
    return x * length


MAX_ARCS = 24
"""Evaluations of the arc after which a search gives up and leaves the cell to the event loop. Nearly all need two
or three."""


@kernel
def locate_peaks(pulse: Record, group: Record) -> None:
    """Locate the pending peaks: zeros of w, decreasing; set `found_peak_h`, `found_peak_z` and raise `top`.

    The error of z is proportional to the square of the error of the time, which is required to 1e-9.
    """
    pending = load(group.peak_pending, 0) > 0.0
    low, high, h = load(group.peak_low, 0), load(group.peak_high, 0), load(group.peak_guess, 0)
    max_rate = load(group.max_rate, 0)
    found_h, found_z = load(group.found_peak_h, 0), load(group.found_peak_z, 0)
    found_slope = load(group.found_peak_slope, 0)
    todo = pending
    h = select(todo, h, splat(FAR))
    for _ in range(MAX_ARCS):
        set_angles(pulse, group, load(group.columns, column.PHASE) + load(group.columns, column.OMEGA) * h)
        z, w, second, third, fourth = motions_at(pulse, group, h)
        low, high = select(w > 0.0, h, low), select(w > 0.0, high, h)
        # the reversed series of w to third order: z at the peak needs no more
        inverse = 1.0 / second
        y, b2, b3 = w * inverse * -1.0, 0.5 * third * inverse, fourth * inverse * (1.0 / 6.0)
        step = y * (1.0 - y * (b2 - y * (2.0 * b2 * b2 - b3)))
        ratio = maximum(absolute(b2 * y), absolute(y) * max_rate)
        root = h + step
        inside = (root >= low) & (root <= high)
        done = todo & inside & (ratio < 2e-3) & (ratio * ratio * ratio * absolute(y) <= 2e-10 * h)
        tight = todo & (high - low <= 4e-16 * high)  # no double remains between
        step = select(tight, splat(0.0), step)
        root = h + step
        done = done | tight
        # z at the root by its Taylor series: the arc is not evaluated once more
        peak = z + step * (w + step * (0.5 * second + step * (third * (1.0 / 6.0) + step * fourth * (1.0 / 24.0))))
        found_h, found_z = select(done, root, found_h), select(done, peak, found_z)
        found_slope = select(done, second + step * third, found_slope)
        todo = todo & ~done
        if not any_lane(todo):
            break
        h = select(todo, select(inside & (ratio < 1.0), root, 0.5 * (low + high)), splat(FAR))
    store(group.found_peak_h, 0, found_h)
    store(group.found_peak_z, 0, found_z)
    store(group.found_peak_slope, 0, found_slope)
    store_where(group.top, 0, pending, maximum(load(group.top, 0), found_z))
    store_where(group.undecided, 0, todo, 1.0)
    store(group.peak_pending, 0, splat(0.0))


@kernel
def locate_impacts(pulse: Record, group: Record, wanted: Any) -> None:
    """Locate the impacts where the mask `wanted` is true: zeros of z, decreasing; set `length` and `end_w`."""
    low, high = load(group.impact_low, 0), load(group.impact_high, 0)
    after_peak = load(group.impact_after_peak, 0) > 0.0
    # the impact follows the peak that has just been located: the bracket starts there, where w = 0
    low = select(after_peak, load(group.found_peak_h, 0), low)
    at_low = (
        select(after_peak, load(group.found_peak_z, 0), load(group.impact_low_z, 0)),
        select(after_peak, splat(0.0), load(group.impact_low_w, 0)),
        select(after_peak, load(group.found_peak_slope, 0), load(group.impact_low_slope, 0)),
    )
    at_high = load(group.impact_high_z, 0), load(group.impact_high_w, 0), load(group.impact_high_slope, 0)
    h = low + quintic_roots(False, at_low, at_high, high - low)
    max_rate = load(group.max_rate, 0)
    length, end_w = load(group.length, 0), load(group.end_w, 0)
    todo = wanted
    h = select(todo, h, splat(FAR))
    for _ in range(MAX_ARCS):
        set_angles(pulse, group, load(group.columns, column.PHASE) + load(group.columns, column.OMEGA) * h)
        z, w, second, third, fourth = motions_at(pulse, group, h)
        low, high = select(z > 0.0, h, low), select(z > 0.0, high, h)
        inverse = 1.0 / w
        y, b2 = z * inverse * -1.0, 0.5 * second * inverse
        b3, b4 = third * inverse * (1.0 / 6.0), fourth * inverse * (1.0 / 24.0)
        square = b2 * b2
        step = y * (1.0 - y * (b2 - y * ((2.0 * square - b3) + y * (5.0 * b2 * (b3 - square) - b4))))
        ratio = maximum(absolute(b2 * y), absolute(y) * max_rate)
        root = h + step
        slack = 4e-16 * high  # a root at an end of the bracket may be rounded out of it
        inside = (root >= low - slack) & (root <= high + slack)
        fourth_power = ratio * ratio * (ratio * ratio)
        done = todo & inside & (fourth_power * absolute(y) <= 4e-18 * h) & (ratio < 1e-3)
        # an expansion far from the start loses the first part of a flight by cancellation
        reach = load(group.reach, 0)
        done = done & ((h <= reach) | (root > reach))
        tight = todo & (high - low <= slack)  # no double remains between
        step = select(tight, splat(0.0), step)
        root = h + step
        done = done | tight
        length = select(done, root, length)
        end_w = select(done, w + step * (second + step * (0.5 * third + step * fourth * (1.0 / 6.0))), end_w)
        todo = todo & ~done
        if not any_lane(todo):
            break
        h = select(todo, select(inside & (ratio < 1.0), root, 0.5 * (low + high)), splat(FAR))
    store(group.length, 0, length)
    store(group.end_w, 0, end_w)
    store_where(group.undecided, 0, todo, 1.0)
