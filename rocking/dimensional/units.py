"""Conversion of quantities with units, as given on the command line, to SI units and radians."""

from __future__ import annotations

import math
import re
from functools import lru_cache

import pint

from rocking.errors import InvalidArgumentError

_EXAMPLES = {"m": "0.3 m, 30 cm", "m/s**2": "4 m/s^2, 0.4 g", "s": "0.5 s, 500 ms", "rad": "20 deg, 0.35 rad"}


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
        A number and a unit, such as "1.2 m", "30cm", "4 m/s^2", "0.4 g", "20 deg".
    unit : {"m", "m/s**2", "s", "rad"}
        Unit of the result.

    Raises
    ------
    InvalidArgumentError
        If the unit is missing, unknown or of another dimension, or the value is not finite.
    """
    allowed = f"a number with its unit, such as {_EXAMPLES[unit]}"
    written = re.sub(r"\bs2\b", "s**2", text)
    if unit == "m/s**2":  # in an acceleration, g is standard gravity, not gram
        written = re.sub(r"(?<![A-Za-z_])g(?![A-Za-z_])", " standard_gravity", written)
    try:
        quantity: pint.Quantity[float] = _registry().Quantity(written)
        if quantity.unitless:  # a number without unit, which pint would accept as radians
            raise InvalidArgumentError(parameter, text, allowed)
        value = float(quantity.to(unit).magnitude)
    except InvalidArgumentError:
        raise
    except Exception:  # noqa: BLE001  (pint raises its own errors, and those of the tokenizer underneath)
        raise InvalidArgumentError(parameter, text, allowed) from None
    if not math.isfinite(value):
        raise InvalidArgumentError(parameter, text, allowed)
    return value
