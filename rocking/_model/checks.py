"""Checks of the parameters against their declared ranges."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError, broadcast, in_range, number, plain_number
from rocking._base.quantities import ALPHA, FREQUENCY_RATIO, RESTITUTION, RESTRAINTS, SLENDERNESS, SMALLEST_ALPHA
from rocking._base.quantity import Quantity
from rocking._base.units import Scalar, Values, WithUnit
from rocking._model.labelled import Index, broadcast_by_name, in_unit, index_of, is_labelled

_GROUPS = {parameter.name: parameter for parameter in (SLENDERNESS, FREQUENCY_RATIO, RESTITUTION)}


def check_quantities(arguments: Mapping[Quantity, Any]) -> tuple[dict[str, Array], dict[str, Any], Index | None]:
    """What bodies are made from: arrays by name, those of them that are labelled, and the index of a series.

    Numbers, texts, quantities or arrays, also labelled ones, which broadcast; None is left out.
    """
    given = {one.name: in_unit(one.name, value, one.unit) for one, value in arguments.items() if value is not None}
    labels = {name: value for name, value in given.items() if is_labelled(value)}
    given |= broadcast_by_name(labels)
    checked = {one.name: one.convert(given[one.name]) for one in arguments if one.name in given}
    broadcast(given, list(checked.values()))
    return checked, labels, index_of(*arguments.values())


def check_window(
    parameter: Quantity, low: Scalar, high: Scalar, names: tuple[str, str] | None = None
) -> tuple[float, float]:
    """The ends of a window of a parameter, low < high, in its range.

    `names`: for the error message; by default the name of the parameter with the endings `_min` and `_max`.
    """
    first, last = names or (f"{parameter.name}_min", f"{parameter.name}_max")
    lower = parameter.number(low, first)
    closed = "right" if parameter.closed in ("both", "right") else "neither"
    return lower, number(last, high, lower, parameter.upper, closed=closed, unit=parameter.unit)


def check_ends(parameter: Quantity, ends: Any, name: str | None = None) -> tuple[float, float]:
    """The same of a window that is one argument, by default with the name of the parameter."""
    name = name or parameter.name
    if np.shape(ends) != (2,):
        raise InvalidArgumentError(name, ends, "the two ends of a window, ascending")
    low, high = ends
    return check_window(parameter, low, high, (name, f"{name}[1]"))


def check_alpha(alpha: ArrayLike | WithUnit | None) -> Array:
    """Slenderness angles [rad], 0 for None; the same errors as its `convert`, also between 0 and `SMALLEST_ALPHA`."""
    if alpha is None:
        return np.zeros(())
    angles = ALPHA.convert(alpha)
    if angles.ndim or 0.0 < angles < SMALLEST_ALPHA:
        in_range(ALPHA.name, np.where(angles > 0.0, angles, ALPHA.upper), SMALLEST_ALPHA, ALPHA.upper, unit=ALPHA.unit)
    return angles


def check_one_alpha(alpha: ArrayLike | WithUnit | None) -> float:
    """As `check_alpha`, for one angle."""
    if type(alpha) is float and SMALLEST_ALPHA < alpha < ALPHA.upper:
        return alpha
    if alpha is not None:
        ALPHA.number(alpha)
    return float(check_alpha(alpha))


def known_restitution(restitution: Any, alpha: Any) -> Any:
    """The restitution as it is given; "momentum" and "kalliontzis(k=...)" become numbers, from the angles [rad].

    "momentum" is (2.4), 0 where that is negative, and the other one `spread_impact` of it. Raises
    `InvalidArgumentError` for these without an angle, or with 0, the slender limit, in which they lose no energy.
    """
    share = impact_share(restitution)
    if share is None:
        return restitution
    if alpha is None or not np.all(ALPHA.convert(alpha) > 0.0):
        raise InvalidArgumentError("restitution", restitution, "a number in the slender limit: (2.4) needs `alpha` > 0")
    sine = np.sin(alpha if is_labelled(alpha) else ALPHA.convert(alpha))
    return spread_impact(1.0 - 1.5 * sine * sine, share)  # (2.4)


def impact_share(restitution: Any) -> float | None:
    """k of "kalliontzis(k=...)", (0, 1]; 1 of "momentum"; None of anything else, which is no such text."""
    if not isinstance(restitution, str):
        return None
    if restitution == "momentum":
        return 1.0
    name, bracket, text = restitution.strip().partition("(")
    if name.strip() != "kalliontzis":
        return None
    found = re.fullmatch(r"\s*k\s*=\s*([0-9.eE+-]{1,30})\s*\)", text) if bracket else None
    if found is None:
        raise InvalidArgumentError(
            "restitution", restitution, "kalliontzis(k=0.8) with k in (0, 1], momentum or a number"
        )
    return number("restitution", plain_number("restitution", found[1]), 0.0, 1.0, closed="right")


def spread_impact(momentum: Any, share: float) -> Any:
    """Restitution of a body with two equal edges whose impact acts at the share k of the half base, not at the edge.

    eta = (S - k^2 b^2)/(S + k^2 b^2), S = r^2 + h^2, from that of k = 1, `momentum`; of a rectangle
    (4 - 3 s (1 + k^2))/(4 - 3 s (1 - k^2)), s = sin^2 alpha (Kalliontzis et al. 2016, after a secondary source).
    """
    if share == 1.0:
        return np.maximum(momentum, 0.0)  # to the last digit
    kept, lost = 1.0 + momentum, share * share * (1.0 - momentum)
    return np.maximum((kept - lost) / (kept + lost), 0.0)


def check_groups(**given: Any) -> dict[str, Array]:
    """The given of `slenderness`, `frequency_ratio`, `restitution` and `alpha` as float64 arrays; alpha = None is 0."""
    return {name: check_alpha(one) if name == "alpha" else _GROUPS[name].convert(one) for name, one in given.items()}


def check_restraint(stiffness: Values, prestress: Values, damping: Values) -> dict[str, Array]:
    """Return the groups kappa, sigma and zeta [-] of a restraint by name; without the numbers that are 0."""
    given = zip(RESTRAINTS, (stiffness, prestress, damping), strict=True)
    checked = {quantity.name: quantity.convert(value) for quantity, value in given}
    return {name: value for name, value in checked.items() if value.ndim or value != 0.0}
