"""Stationary phases of a pulse: all phases at which f' changes sign, by interval exclusion and bisection."""

from collections.abc import Callable

import numpy as np

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError

HALVINGS = 26
"""Halvings of the window in the search. Two zeros in a remaining interval are at most 1.5e-8 of the window apart."""

MAX_INTERVALS = 65536  # largest number of intervals searched at once
BISECTIONS = 80  # halvings of a bracket around one zero, down to two adjacent doubles

Slope = Callable[[Array], tuple[Array, Array]]  # from phases (n,) the function and its derivative


def sign_changes(
    slope: Slope, bound: float, second_bound: float, start: float, end: float, parts: int = 1
) -> tuple[float, ...]:
    """Search the phases strictly inside the window at which `slope` changes sign, to the last bit.

    `slope` is smooth inside each of `parts` equal parts of the window, a power of two; `bound` and `second_bound`, M,
    are bounds of the slope and of its second derivative. On an interval of length l about m a function v has no zero if
    |v(m)| > |v'(m)| l/2 + M l^2/8, and at most one if |v'(m)| > M l/2; other intervals are halved. Two zeros in an
    interval that remains after `HALVINGS` change f by less than rounding.
    """
    if bound == 0.0:  # f is constant
        return ()
    length, share = end - start, 1.0 / parts
    first: Array = share * np.arange(float(parts))
    brackets = []  # exact fractions of the window: adjacent intervals share their end
    for _ in range(HALVINGS):
        value, rate = slope(start + (first + 0.5 * share) * length)
        half = 0.5 * share * length
        some = np.abs(value) <= np.abs(rate) * half + 0.5 * second_bound * half * half
        single = np.abs(rate) > second_bound * half
        brackets.append(np.stack([first, first + share])[:, some & single])
        share *= 0.5
        first = first[some & ~single]
        first = np.concatenate([first, first + share])
        if first.size > MAX_INTERVALS:
            raise InvalidArgumentError("pulse", "a sum that cancels", "one whose f' is not zero on a whole interval")
    brackets.append(np.stack([first, first + share]))
    ends = np.sort(start + np.concatenate(brackets, axis=1).ravel() * length)
    signs = np.sign(slope(ends)[0])
    ends, signs = ends[signs != 0.0], signs[signs != 0.0]
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    left, right, rises = ends[changes], ends[changes + 1], signs[changes + 1] > 0.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (left + right)
        beyond = (slope(middle)[0] > 0.0) == rises
        left, right = np.where(beyond, left, middle), np.where(beyond, middle, right)
    phases = np.where(np.abs(slope(left)[0]) < np.abs(slope(right)[0]), left, right)
    # otherwise an end of the window displaced by rounding
    inside = (phases - start > 1e-12 * length) & (end - phases > 1e-12 * length)
    return tuple(phases[inside].tolist())
