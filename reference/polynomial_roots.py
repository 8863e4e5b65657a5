"""Real roots of a polynomial in multi-precision arithmetic; no root in the interval can be missed.

In Bernstein form a polynomial lies in the hull of its coefficients, and its number of roots in the interval is at most
the number of sign changes of its coefficients, and differs from it by an even number (Descartes, Vincent). No change
means no root, one change exactly one root; otherwise the interval is split. A first test in doubles, with a margin for
their rounding, decides nearly every case; the remaining cases are decided in multi-precision arithmetic.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from math import comb

import numpy as np
from flint import arb, arb_poly, ctx
from numpy.typing import NDArray


@lru_cache(maxsize=256)
def _to_bernstein(degree: int) -> NDArray[np.float64]:
    """Return the matrix from the coefficients of x^k to those of the Bernstein form on [0, 1]."""
    rows = [[comb(i, k) / comb(degree, k) if k <= i else 0.0 for k in range(degree + 1)] for i in range(degree + 1)]
    return np.array(rows)


def evaluate(coefficients: list[arb], x: arb) -> arb:
    """Return the value at x."""
    total = arb(0)
    for c in reversed(coefficients):
        total = total * x + c
    return total.mid()


def derivative(coefficients: list[arb]) -> list[arb]:
    """Return the coefficients of the derivative."""
    return [k * c for k, c in enumerate(coefficients)][1:]


def bernstein_bounds(coefficients: list[arb], length: arb) -> tuple[float, float]:
    """Return the smallest and largest Bernstein coefficient on [0, length], which bound the polynomial (to 1e-12)."""
    scaled = _scaled_doubles(coefficients, float(length))
    form = _to_bernstein(len(scaled) - 1) @ scaled
    guard = 1e-13 * float(np.abs(scaled).sum())
    return float(form.min()) - guard, float(form.max()) + guard


def _scaled_doubles(coefficients: list[arb], length: float) -> NDArray[np.float64]:
    scaled = np.array([float(c) for c in coefficients])
    if length != 1.0:
        scaled *= length ** np.arange(len(scaled))
    return scaled


def roots(coefficients: list[arb], length: arb) -> list[arb]:
    """Return all simple roots in (0, length], ascending; roots at 0 must have been divided out before.

    A double root that the arithmetic cannot distinguish from no root is not returned, nor is a root within rounding of
    `length`: the caller must check the value there.
    """
    scaled = _scaled_doubles(coefficients, float(length))
    form = _to_bernstein(len(scaled) - 1) @ scaled
    guard = 1e-13 * float(np.abs(scaled).sum())
    if np.all(np.abs(form) > guard):
        changes = int(np.count_nonzero(form[:-1] * form[1:] < 0))
        if changes == 0:
            return []
        if changes == 1:
            return [refine_root(coefficients, arb(0), length)]
    return _roots_by_splitting(coefficients, length)


def _roots_by_splitting(coefficients: list[arb], length: arb) -> list[arb]:
    """Return the same entirely in multi-precision arithmetic."""
    degree = len(coefficients) - 1
    scaled, power = [], arb(1)
    for c in coefficients:
        scaled.append((c * power).mid())
        power = (power * length).mid()
    form = [
        sum((scaled[k] * comb(i, k) / comb(degree, k) for k in range(i + 1)), arb(0)).mid() for i in range(degree + 1)
    ]
    noise = max((abs(c) for c in scaled), key=float) * arb(2) ** (16 - ctx.prec)
    found: list[arb] = []
    stack = [(form, arb(0), arb(1), 0)]
    while stack:
        form, left, right, depth = stack.pop()
        signs = [1 if c > noise else -1 for c in form if abs(c) > noise]
        changes = sum(p != q for p, q in pairwise(signs))
        if changes == 0:
            continue
        if changes == 1 and abs(form[0]) > noise and abs(form[-1]) > noise:
            found.append(refine_root(coefficients, left * length, right * length))
            continue
        if depth > ctx.prec // 2 - 16:  # a double root within rounding
            continue
        for part in (arb(15) / 32, arb(17) / 32):  # at least one of them is no root
            first, second = _split(form, part)
            if abs(second[0]) > noise:
                break
        middle = (left + part * (right - left)).mid()
        stack.append((second, middle, right, depth + 1))
        stack.append((first, left, middle, depth + 1))
    return found


def _split(form: list[arb], part: arb) -> tuple[list[arb], list[arb]]:
    """Return the Bernstein forms left and right of `part` of the interval (de Casteljau)."""
    rest = 1 - part
    first, second = [form[0]], [form[-1]]
    while len(form) > 1:
        form = [(rest * p + part * q).mid() for p, q in pairwise(form)]
        first.append(form[0])
        second.append(form[-1])
    return first, second[::-1]


def refine_root(coefficients: list[arb], left: arb, right: arb) -> arb:
    """Return the only root in a bracket to the working precision: Newton, bisection where Newton leaves the bracket."""
    polynomial = arb_poly(coefficients)
    slope = polynomial.derivative()
    left, right = left.mid(), right.mid()
    rising = polynomial(right).mid() > 0
    x = ((left + right) / 2).mid()
    for _ in range(4 * ctx.prec):
        value = polynomial(x).mid()
        if value == 0:
            return x
        if (value > 0) == rising:
            right = x
        else:
            left = x
        gradient = slope(x).mid()
        trial = (x - value / gradient).mid() if gradient != 0 else left
        if left <= trial <= right:
            if abs(trial - x) <= abs(x) * arb(2) ** (10 - ctx.prec):
                return trial
            x, last = trial, x
            if abs(x - last) > (right - left) / 2:  # slow progress: halve as well
                x = ((left + right) / 2).mid()
        else:
            x = ((left + right) / 2).mid()
        if right - left <= abs(x) * arb(2) ** (4 - ctx.prec):
            return x
    raise ArithmeticError("root not found in its bracket")
