"""Conversion of quantities with units, as people type them, to SI units and radians."""

from __future__ import annotations

import math
import re
from functools import lru_cache

import pint

from rocking.errors import InvalidArgumentError

_EXAMPLES = {"m": "0.3 m, 30 cm", "m/s**2": "4 m/s^2, 0.4 g, 400 gal", "s": "0.5 s, 500 ms", "rad": "20 deg, 0.35 rad"}

_USUAL = {"m": ("m",), "m/s**2": ("m/s2", "g"), "s": ("s",), "rad": ("deg",)}
"""The units that an error proposes where there is none."""

_IN_ACCELERATIONS = {r"g": "standard_gravity", r"gals?": "cm/s**2"}
"""Units that mean something else otherwise: gram, gallon."""


class MissingUnitError(InvalidArgumentError):
    """A number without a unit."""

    def __init__(self, parameter: str, value: str, allowed: str) -> None:
        super().__init__(parameter, value, allowed)
        self.args = (f"`{parameter}` = {value!r}: {allowed}",)


@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry[float]:
    return pint.UnitRegistry()


def si_value(parameter: str, text: str, unit: str) -> float:
    """The value of a quantity in an SI unit.

    Parameters
    ----------
    parameter : str
        Name for the error message.
    text : str
        A number and a unit, such as "1.2 m", "30cm", "4 m/s^2", "0.4 g", "400 gal", "20 deg".
    unit : {"m", "m/s**2", "s", "rad"}
        Unit of the result.

    Raises
    ------
    MissingUnitError
        If there is no unit; the message proposes one.
    InvalidArgumentError
        If the unit is unknown or of another dimension, or the value is not finite.
    """
    allowed = f"a number with its unit, such as {_EXAMPLES[unit]}"
    written = re.sub(r"\bs2\b", "s**2", text)
    if unit == "m/s**2":
        for name, meaning in _IN_ACCELERATIONS.items():
            written = re.sub(rf"(?i:(?<![A-Za-z_]){name}(?![A-Za-z_]))", f" {meaning}", written)
    try:
        quantity: pint.Quantity[float] = _registry().Quantity(written)
        if quantity.unitless:  # a number without unit, which pint would accept as radians
            given = text.strip()
            if given:
                written = " or ".join(f"{given}{usual}" for usual in _USUAL[unit])
                allowed = f"missing unit: write {written} (such as {_EXAMPLES[unit]})"
            raise (MissingUnitError if given else InvalidArgumentError)(parameter, text, allowed)
        value = float(quantity.to(unit).magnitude)
    except InvalidArgumentError:
        raise
    except Exception:  # noqa: BLE001  (pint raises its own errors, and those of the tokenizer underneath)
        raise InvalidArgumentError(parameter, text, allowed) from None
    if not math.isfinite(value):
        raise InvalidArgumentError(parameter, text, allowed)
    return value


def si_factor(parameter: str, unit_text: str, unit: str) -> float:
    """The value of one unit, such as "cm", in an SI unit.

    Raises
    ------
    InvalidArgumentError
        If the unit is unknown or of another dimension.
    """
    return si_value(parameter, f"1 {unit_text}", unit)
