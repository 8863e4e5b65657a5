"""Measured deviation from the scale law for restitution, theta_m proportional to eta^2, (4.16).

The functions work on peaks that the solver or a closed form computed along an axis of restitutions.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.errors import InvalidArgumentError, float_array, integer
from rocking._base.quantities import RESTITUTION
from rocking.paper.arguments import Array


def scale_law_deviation(peak_rotation: ArrayLike, restitution: ArrayLike, *, reference: float, axis: int = 0) -> Array:
    """Relative deviation of peak/eta^2 from its value at a reference restitution, the error of (4.16).

    Parameters
    ----------
    peak_rotation : array_like
        Peak rotations with any scaling [-], nan where overturned; one axis corresponds to `restitution`.
    restitution : array_like, shape (n,)
        eta [-], (0, 1].
    reference : float
        The eta from which the law predicts the other peaks [-]; one of `restitution`.
    axis : int
        Axis of `peak_rotation` that corresponds to restitution.

    Returns
    -------
    ndarray
        (reference peak) (eta/reference)^2 / peak - 1 [-], of the shape of `peak_rotation`: positive where the law
        overestimates the peak; nan where either block overturned or did not uplift.
    """
    peak, eta = _aligned(peak_rotation, restitution, axis)
    at = np.flatnonzero(np.isclose(eta, RESTITUTION.number(reference, "reference"), rtol=0.0, atol=1e-9))
    if at.size == 0:
        raise InvalidArgumentError("reference", reference, f"one of the restitutions {eta.tolist()}")
    scaled = peak / eta**2  # f(a, omega)/2 of (4.16) if the law is exact
    with np.errstate(divide="ignore", invalid="ignore"):
        deviation = np.where(scaled > 0, scaled[..., at[:1]] / scaled - 1, np.nan)
    return np.asarray(np.moveaxis(deviation, -1, axis))


def largest_deviation(peak_rotation: ArrayLike, restitution: ArrayLike, *, reference: float, axis: int = 0) -> Array:
    """Largest absolute `scale_law_deviation` over restitution [-], nan where no two peaks can be compared.

    Parameters
    ----------
    peak_rotation, restitution, reference, axis
        As for `scale_law_deviation`; the result does not have the axis.
    """
    deviation = np.abs(scale_law_deviation(peak_rotation, restitution, reference=reference, axis=axis))
    # the deviation of the reference itself is zero: at least one other peak is needed
    others = np.sum(np.isfinite(deviation), axis=axis) > 1
    return np.asarray(np.where(others, np.max(np.nan_to_num(deviation, nan=0.0), axis=axis), np.nan))


def restitution_exponent(peak_rotation: ArrayLike, restitution: ArrayLike, *, axis: int = 0) -> Array:
    """Exponent n of peak = constant eta^n [-] by least squares in logarithms; 2 by the law (4.16).

    Parameters
    ----------
    peak_rotation, restitution, axis
        As for `scale_law_deviation`; the result does not have the axis.

    Returns
    -------
    ndarray
        [-]; nan where fewer than two peaks are positive and finite.
    """
    peak, eta = _aligned(peak_rotation, restitution, axis)
    known = np.isfinite(peak) & (peak > 0)
    count = known.sum(axis=-1, keepdims=True)
    x = np.where(known, np.log(eta), 0.0)
    y = np.where(known, np.log(np.where(known, peak, 1.0)), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.where(known, x - x.sum(axis=-1, keepdims=True) / count, 0.0)
        slope = (x * y).sum(axis=-1) / (x * x).sum(axis=-1)
    return np.asarray(np.where(count[..., 0] > 1, slope, np.nan))


def _aligned(peak_rotation: ArrayLike, restitution: ArrayLike, axis: int) -> tuple[Array, Array]:
    """Peaks with restitution as the last axis, and the restitutions."""
    peak = float_array("peak_rotation", peak_rotation)
    peak = np.moveaxis(peak, integer("axis", axis, -peak.ndim, peak.ndim - 1), -1)
    eta = replace(RESTITUTION, closed="right").convert(restitution)
    if eta.shape != peak.shape[-1:]:
        raise InvalidArgumentError("restitution", eta.shape, f"one value for each of {peak.shape[-1]} peaks")
    return peak, eta
