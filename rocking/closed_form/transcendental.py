"""Exact roots of I1 e^-tau + I2 e^tau + I3 = 0, appendix A of the paper: (A 1) to (A 4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rocking.closed_form.coefficients import Array


def residual(falling: ArrayLike, growing: ArrayLike, constant: ArrayLike, time: ArrayLike) -> Array:
    """I1 e^-tau + I2 e^tau + I3, the left side of (A 1); all arguments [-], any broadcast shape."""
    tau = np.asarray(time, dtype=np.float64)
    return np.asarray(np.asarray(falling) * np.exp(-tau) + np.asarray(growing) * np.exp(tau) + constant)  # (A 1)


def rising_root(falling: ArrayLike, growing: ArrayLike, constant: ArrayLike) -> Array:
    """The root of (A 1) through which the left side rises.

    Parameters
    ----------
    falling, growing, constant : array_like
        I1, I2, I3 [-], any broadcast shape.

    Returns
    -------
    ndarray
        tau [-]; nan where (A 1) has no real root of that kind.

    Notes
    -----
    With x = e^tau, (A 2) and (A 3) leave the quadratic (A 4): I2 x^2 + I3 x + I1 = 0. The slope of (A 1) at a root
    is I2 x - I1/x = +- 2 r with r = sqrt((I3/2)^2 - I1 I2), plus for x = (-I3/2 + r)/I2, minus for the other root,
    whatever the signs of I1 and I2. A block that starts towards theta < 0 comes back to theta = 0 with positive
    velocity: the root with + r is therefore the only one that can be an impact. The other is negative when
    I1 I2 < 0 (it "lacks physical meaning") and, when positive, an instant before the stage at which a block on the
    same free arc would have left theta = 0 downwards.
    """
    I1, I2, half = (np.asarray(v, dtype=np.float64) for v in (falling, growing, np.asarray(constant) / 2))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        r = np.sqrt(half * half - I1 * I2)
        # (A 4): two forms of one root; the sum under the fraction is the one without cancellation
        x = np.where(half <= 0, (r - half) / I2, -I1 / (r + half))
        return np.asarray(np.where(x > 0, np.log(np.where(x > 0, x, 1.0)), np.nan))
