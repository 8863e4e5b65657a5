"""Zeros of the series of one lane of a Taylor step: evaluation, exclusion, refinement."""

from rocking._base.errors import SearchError
from rocking._numba.compilation import Series, kernel, specialised_kernel

MAX_INTERVALS = 10_000_000
"""Largest number of intervals in `first_crossing`. A simple zero needs about 30, one of order n up to s^(2/n - 1) with
s = 1e-9 the smallest interval: 3e4 for n = 4, and 3e6 for n = 7."""


@kernel
def evaluate_series(series: Series, lane: int, top: int, h: float) -> float:
    """Value of the series of degree `top` at h."""
    square, last = h * h, top - top % 2
    even, odd = 0.0, 0.0  # even and odd terms: two short dependency chains instead of a long one
    for i in range(0, last + 1, 2):
        n = last - i
        even = even * square + series[n, lane]
        if n < top:
            odd = odd * square + series[n + 1, lane]
    return even + h * odd


@kernel
def value_and_slope(series: Series, lane: int, top: int, h: float) -> tuple[float, float]:
    """Value of the series of degree `top` at h, and its derivative."""
    square, last = h * h, top - top % 2
    even, odd, even_slope, odd_slope = 0.0, 0.0, 0.0, 0.0
    for i in range(0, last + 1, 2):
        n = last - i
        even_slope = even_slope * square + even
        even = even * square + series[n, lane]
        odd_slope = odd_slope * square + odd
        if n < top:
            odd = odd * square + series[n + 1, lane]
    return even + h * odd, odd + 2.0 * h * (even_slope + h * odd_slope)


@kernel
def second_derivative_bound(series: Series, lane: int, top: int, h: float) -> float:
    """Bound of the second derivative of the series of degree `top` on [0, h]."""
    bound = 0.0
    for i in range(top - 1):
        n = top - i
        bound = bound * h + abs(series[n, lane]) * (n * (n - 1.0))
    return bound


@specialised_kernel
def refine_root(
    series: Series, lane: int, top: int, lo: float, hi: float, falling: bool, deflated: bool, guess: float
) -> tuple[float, float]:
    """The zero of a series between lo and hi, decreasing if `falling`, by bracketed Newton iteration; slope there.

    `deflated` divides the series by h, which removes the zero at the start of a flight.
    """
    h = guess if lo < guess < hi else 0.5 * (lo + hi)
    before, rate = 0.0, 0.0
    for _ in range(100):
        value, rate = value_and_slope(series, lane, top, h)
        if deflated:
            value /= h
            rate = (rate - value) / h
        if (value > 0.0) == falling:
            lo = h
        else:
            hi = h
        follow = h - value / rate if rate != 0.0 else lo
        if not lo <= follow <= hi:
            follow = 0.5 * (lo + hi)
        step = abs(follow - h)
        h = follow
        if step * step * step <= 1e-16 * abs(h) * before * before:  # the next Newton step would be below rounding
            break
        before = step
    return h, rate


@kernel
def first_crossing(series: Series, lane: int, top: int, lo: float, hi: float, falling: bool, bound: float) -> float:
    """The first zero between lo and hi with the given direction of crossing, or -1: interval exclusion, then Newton.

    Given: a series v, and M = `bound` of |v''| on the whole of [0, hi]. Decided: where v first crosses zero in this
    direction. None is missed: intervals are taken from left to right, and an interval is left only once it is shown to
    have no such zero. One of length l about m has no zero if |v(m)| > |v'(m)| l/2 + M l^2/8, and at most one if
    |v'(m)| > M l/2; otherwise it is halved. Zeros closer than 1e-9 of [lo, hi] are not told apart.
    """
    left, size = lo, hi - lo
    smallest = 1e-9 * size
    for _ in range(MAX_INTERVALS):
        if left >= hi:
            return -1.0
        half = 0.5 * size
        value, rate = value_and_slope(series, lane, top, left + half)
        clear = abs(value) > abs(rate) * half + 0.5 * bound * half * half
        single = abs(rate) > bound * half
        if clear or single or size <= smallest:
            right = left + size
            # at most one zero: the signs at both ends tell whether it is there
            if not clear and (rate < 0.0) == falling:
                at_left, at_right = evaluate_series(series, lane, top, left), evaluate_series(series, lane, top, right)
                if (at_left > 0.0 >= at_right) if falling else (at_left < 0.0 <= at_right):
                    found, _ = refine_root(series, lane, top, left, right, falling, False, left + half - value / rate)
                    return float(found)
            # on to the next interval, twice as long: where the series is far from zero few are needed
            left = right
            size = min(2.0 * size, hi - left) if hi - left > smallest else hi - left
            if size <= 0.0:
                return -1.0
        else:
            size = half
    raise SearchError("the search for a zero of a Taylor step does not end")
