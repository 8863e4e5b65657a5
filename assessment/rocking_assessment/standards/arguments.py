"""Checked arguments of the clauses, by name."""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import ArrayLike

from rocking.extension import STANDARD_GRAVITY, Array, broadcast, in_range, number

RANGES: dict[str, tuple[float, float, str, str]] = {
    "half_width": (0.0, math.inf, "neither", "m"),
    "mass_height": (0.0, math.inf, "neither", "m"),
    "gyration": (0.0, math.inf, "neither", "m"),
    "rotation": (0.0, 0.5 * math.pi, "right", "rad"),
    "acceleration": (0.0, math.inf, "left", "m/s2"),
    "velocity": (0.0, math.inf, "left", "m/s"),
    "displacement": (0.0, math.inf, "left", "m"),
    "vertical_ratio": (0.0, 100.0, "both", "-"),
    "vertical_acceleration": (0.0, STANDARD_GRAVITY / 0.4, "left", "m/s2"),
    "friction": (0.0, 10.0, "right", "-"),
    "confidence_factor": (1.0, 2.0, "both", "-"),
    "behaviour_factor": (1.0, 10.0, "both", "-"),
    "height_ratio": (0.0, 1.0, "both", "-"),
    "storeys": (1.0, 1000.0, "both", "-"),
    "period": (0.0, math.inf, "neither", "s"),
    "secant_period": (0.0, math.inf, "neither", "s"),
    "first_period": (0.0, math.inf, "neither", "s"),
    "elastic_period": (0.0, math.inf, "left", "s"),
    "first_acceleration": (0.0, math.inf, "left", "m/s2"),
    "floor_acceleration": (0.0, math.inf, "left", "m/s2"),
    "ground_acceleration": (0.0, math.inf, "left", "m/s2"),
    "ground_displacement": (0.0, math.inf, "left", "m"),
    "damping": (0.0, 1.0, "left", "-"),
    "first_damping": (0.0, 1.0, "neither", "-"),
    "length": (0.0, math.inf, "neither", "m"),
    "thickness": (0.0, math.inf, "neither", "m"),
    "unit_weight": (0.0, math.inf, "neither", "N/m3"),
    "modulus": (0.0, math.inf, "neither", "Pa"),
    "coefficient": (0.0, 10.0, "right", "-"),
}


def checked(**arguments: Any) -> list[Array]:
    """The arguments in their order as float64 arrays that broadcast."""
    arrays = []
    for name, value in arguments.items():
        low, high, closed, unit = RANGES[name]
        arrays.append(in_range(name, value, low, high, closed=closed, unit=unit))
    return broadcast(arguments, arrays)


def checked_number(name: str, value: Any) -> float:
    """An argument that is one number."""
    low, high, closed, unit = RANGES[name]
    return number(name, value, low, high, closed=closed, unit=unit)


def checked_body(half_width: ArrayLike, mass_height: ArrayLike, gyration: ArrayLike | None) -> tuple[Array, ...]:
    """b, h and I_O/m = r^2 + b^2 + h^2 [m2], the moment of inertia about the edge over the mass."""
    if gyration is None:
        b, h = checked(half_width=half_width, mass_height=mass_height)
        return b, h, 4.0 / 3.0 * (b * b + h * h)
    b, h, r = checked(half_width=half_width, mass_height=mass_height, gyration=gyration)
    return b, h, r * r + b * b + h * h
