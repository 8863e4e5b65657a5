"""Roots: of I1 e^-tau + I2 e^tau + I3 = 0 in closed form, appendix A of the paper, (A 1) to (A 4), and by bracketing.

By bracketing, roots and maxima of many scalar functions are found at once; nan where there is none.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import elementwise

from rocking.paper.arguments import Array, checked


def residual(falling: ArrayLike, growing: ArrayLike, constant: ArrayLike, time: ArrayLike) -> Array:
    """I1 e^-tau + I2 e^tau + I3, left side of (A 1); all arguments [-], any broadcast shape."""
    I1, I2, I3, tau = checked(falling=falling, growing=growing, constant=constant, time=time)
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(I1 * np.exp(-tau) + I2 * np.exp(tau) + I3)  # (A 1)


def rising_root(falling: ArrayLike, growing: ArrayLike, constant: ArrayLike) -> Array:
    """The root of (A 1) at which the left side increases.

    Parameters
    ----------
    falling, growing, constant : array_like
        I1, I2, I3 [-], any broadcast shape.

    Returns
    -------
    ndarray
        tau [-]; nan where (A 1) has no such real root.

    Notes
    -----
    With x = e^tau, (A 2) and (A 3) reduce to the quadratic (A 4): I2 x^2 + I3 x + I1 = 0. The slope of (A 1) at a root
    is I2 x - I1/x = +- 2 r with r = sqrt((I3/2)^2 - I1 I2), plus for x = (-I3/2 + r)/I2 and minus for the other root,
    for any signs of I1 and I2. A block that starts towards theta < 0 returns to theta = 0 with positive velocity, so
    only the root with + r can be an impact. The other root is negative if I1 I2 < 0 (it "lacks physical meaning" in the
    paper). If it is positive, it is a time before the stage begins, at which the same free motion would have passed
    theta = 0 with negative velocity.
    """
    I1, I2, I3 = checked(falling=falling, growing=growing, constant=constant)
    half = I3 / 2
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        r = np.sqrt(half * half - I1 * I2)
        # (A 4): two forms of the same root; the sign of I3 selects the one without cancellation
        x = np.where(half <= 0, (r - half) / I2, -I1 / (r + half))
        return np.asarray(np.where(x > 0, np.log(np.where(x > 0, x, 1.0)), np.nan))


Function = Callable[..., Array]


def find_root(function: Function, low: Array, high: Array, *args: Array) -> Array:
    """Root of the vectorised `function(x, *args)` in [low, high] to rounding error (Chandrupatla), element by element.

    Nan where the function has the same sign at both ends; an infinite or nan limit is no bracket.
    """
    low, high, *args_ = np.broadcast_arrays(low, high, *args)
    if low.size == 0:
        return np.full(low.shape, np.nan)
    with np.errstate(all="ignore"):
        found = elementwise.find_root(function, (low, high), args=tuple(args_))
        return np.asarray(np.where(found.success, found.x, np.nan), dtype=np.float64)


def find_maximum(function: Function, low: Array, high: Array, *args: Array, points: int = 129) -> Array:
    """Argument of the largest value of `function(x, *args)` on [low, high], element by element.

    A grid of `points` brackets the maximum and Chandrupatla's minimiser refines it. A maximum at an end of the interval
    is returned as that end.
    """
    low, high, *args_ = np.broadcast_arrays(low, high, *args)
    if low.size == 0:
        return np.full(low.shape, np.nan)
    with np.errstate(all="ignore"):
        grid = low + (high - low) * np.linspace(0.0, 1.0, points).reshape(-1, *(1,) * low.ndim)
        values = np.where(np.isfinite(value := function(grid, *args_)), value, -np.inf)
        best = np.argmax(values, axis=0)[np.newaxis]
        left, middle, right = (
            np.take_along_axis(grid, np.clip(best + step, 0, points - 1), axis=0)[0] for step in (-1, 0, 1)
        )
        refined = elementwise.find_minimum(lambda x, *a: -function(x, *a), (left, middle, right), args=tuple(args_))
        return np.asarray(np.where(refined.success, refined.x, middle), dtype=np.float64)
