"""Checks of the parameters against their declared ranges."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.errors import broadcast, in_range, number
from rocking._base.units import Quantity, Scalar
from rocking._model.parameters import ALPHA, FREQUENCY_RATIO, RESTITUTION, SLENDERNESS, SMALLEST_ALPHA, Parameter

Array = NDArray[np.float64]


def check(parameter: Parameter, value: ArrayLike | Quantity, name: str | None = None) -> Array:
    """The value as a float64 array, shape kept.

    Parameters
    ----------
    parameter : Parameter
        The declaration.
    value : array_like of real numbers, any shape
        None of them masked.
    name : str, optional
        Name for the error message, where it is not that of the parameter.

    Raises
    ------
    InvalidArgumentError
        If an entry is not a finite real number in the range.
    """
    return in_range(
        name or parameter.name, value, parameter.lower, parameter.upper, closed=parameter.closed, unit=parameter.unit
    )


def check_number(parameter: Parameter, value: ArrayLike | Quantity, name: str | None = None) -> float:
    """As `check`, for one number.

    Raises
    ------
    InvalidArgumentError
        If it is not one finite real number in the range.
    """
    return number(
        name or parameter.name, value, parameter.lower, parameter.upper, closed=parameter.closed, unit=parameter.unit
    )


def check_window(
    parameter: Parameter, low: Scalar, high: Scalar, names: tuple[str, str] | None = None
) -> tuple[float, float]:
    """The ends of a window of a parameter, low < high.

    Parameters
    ----------
    parameter : Parameter
        The declaration.
    low, high : float
        The ends.
    names : (str, str), optional
        Names for the error message; by default that of the parameter with the endings `_min` and `_max`.

    Raises
    ------
    InvalidArgumentError
        If an end is outside the range, or `high` is not above `low`.
    """
    first, last = names or (f"{parameter.name}_min", f"{parameter.name}_max")
    lower = check_number(parameter, low, first)
    closed = "right" if parameter.closed in ("both", "right") else "neither"
    return lower, number(last, high, lower, parameter.upper, closed=closed, unit=parameter.unit)


def check_alpha(alpha: ArrayLike | Quantity | None) -> Array:
    """Slenderness angles [rad], 0 for None; the same errors as `check`, also between 0 and `SMALLEST_ALPHA`."""
    if alpha is None:
        return np.zeros(())
    angles = check(ALPHA, alpha)
    in_range(ALPHA.name, np.where(angles > 0.0, angles, ALPHA.upper), SMALLEST_ALPHA, ALPHA.upper, unit=ALPHA.unit)
    return angles


def check_one_alpha(alpha: ArrayLike | Quantity | None) -> float:
    """As `check_alpha`, for one angle."""
    if alpha is not None:
        check_number(ALPHA, alpha)
    return float(check_alpha(alpha))


def check_groups(
    slenderness: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike, alpha: ArrayLike | None
) -> tuple[Array, Array, Array, Array]:
    """The dimensionless groups of a response as float64 arrays of their own shapes; alpha = None is 0.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range.
    """
    return (
        check(SLENDERNESS, slenderness),
        check(FREQUENCY_RATIO, frequency_ratio),
        check(RESTITUTION, restitution),
        check_alpha(alpha),
    )


def broadcast_groups(
    slenderness: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike, alpha: ArrayLike | None
) -> list[Array]:
    """`check_groups`, broadcast against each other.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range, the shapes do not broadcast, or labelled arguments (xarray, pandas) differ in their
        dimensions or indexes.
    """
    checked = check_groups(slenderness, frequency_ratio, restitution, alpha)
    given = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "restitution": restitution, "alpha": alpha}
    return broadcast(given, checked)
