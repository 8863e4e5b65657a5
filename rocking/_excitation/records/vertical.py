"""Factors of the vertical component of a record: a body on the ground flies where the acceleration reaches -g."""

import math

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, in_range, number
from rocking._base.units import Scalar
from rocking._excitation.motion import AbstractMotion

HIGHEST_VERTICAL_SCALE = 1e6  # largest factor of a vertical component [-]

FLIGHT_MARGIN = 1e-9
"""Relative distance of `highest_vertical_scale` from the factor at which the acceleration reaches -g [-]."""


def check_vertical_scale(motion: AbstractMotion, vertical_scale: ArrayLike | None) -> Array:
    """Return the factor of the vertical component as a float64 array of its own shape; 0 for a record that has none.

    Raises `InvalidArgumentError` if a factor is not in [0, 1e6], is neither 1 nor None for a record without a vertical
    component, or is so large that the acceleration reaches -g.
    """
    factor = in_range("vertical_scale", 1.0 if vertical_scale is None else vertical_scale, 0.0, HIGHEST_VERTICAL_SCALE)
    if motion.vertical is None:
        if (factor != 1.0).any():
            allowed = "1 or None: the record has no vertical component"
            raise InvalidArgumentError("vertical_scale", vertical_scale, allowed)
        return np.zeros(factor.shape)
    reject_flight("vertical_scale", motion, float(factor.max(initial=0.0)))
    return factor


def check_one_vertical_scale(motion: AbstractMotion, vertical_scale: Scalar | None) -> float:
    """Return one factor of the vertical component, checked as by `check_vertical_scale`."""
    factor = 1.0 if vertical_scale is None else vertical_scale
    return float(check_vertical_scale(motion, number("vertical_scale", factor, 0.0, HIGHEST_VERTICAL_SCALE)))


def reject_flight(parameter: str, motion: AbstractMotion, factor: float, gravity: float = STANDARD_GRAVITY) -> None:
    """Refuse a factor of the vertical component at which the acceleration reaches -g.

    `parameter`: name of the argument that holds the factor, for the message; `motion`: the record, with or without a
    vertical component; `factor`: the factor [-]; `gravity`: g [m/s2]. Raises `InvalidArgumentError` with the first time
    at which it happens, and the lowest acceleration.
    """
    text = flight_text(motion, factor, gravity)
    if text is not None:
        raise InvalidArgumentError(parameter, factor, text)


def flight_text(motion: AbstractMotion, factor: float, gravity: float) -> str | None:
    """Describe the allowed factors, and when and how far this one exceeds -g; None if it does not."""
    if motion.vertical is None:
        return None
    pressing = 1.0 + factor * (STANDARD_GRAVITY / gravity) * (motion.vertical / STANDARD_GRAVITY)
    flying = pressing <= 0.0
    if not flying.any():
        return None
    k = int(flying.argmax())
    time = motion.time_step * (k - 1.0 + pressing[k - 1] / (pressing[k - 1] - pressing[k]) if k else 0.0)
    lowest = int(pressing.argmin())
    return (
        f"below {highest_vertical_scale(motion, gravity):.6g}: with {factor:.6g} the vertical ground acceleration "
        f"reaches -g at {time:.6g} s, and {factor * motion.vertical[lowest]:.4g} m/s2 at "
        f"{lowest * motion.time_step:.6g} s, so that the body would fly"
    )


def highest_vertical_scale(motion: AbstractMotion, gravity: float = STANDARD_GRAVITY) -> float:
    """Return the factor just below that at which the vertical acceleration reaches -g [-]; infinite if none does."""
    lowest = 0.0 if motion.vertical is None else float(motion.vertical.min())
    return (1.0 - FLIGHT_MARGIN) * gravity / -lowest if lowest < 0.0 else math.inf
