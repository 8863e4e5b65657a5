"""The declaration of a parameter: name, symbol, unit, range and meaning. It imports nothing heavy."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

MAX_LABEL = 25
"""Characters of a label that xarray writes in one line, with a unit [-]."""


@dataclass(frozen=True)
class Parameter:
    """A parameter with its range.

    Attributes
    ----------
    name : str
        As in the signatures of the library.
    symbol : str
        As in the paper.
    unit : str
        "-" if it has none.
    lower, upper : float
        Ends of the range; `upper` may be infinite.
    closed : {"both", "left", "right", "neither"}
        Which ends belong to the range.
    description : str
        Meaning in a few words.
    """

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    closed: str
    description: str

    @property
    def interval(self) -> str:
        """The range, such as `[0, 1]`."""
        left = "[" if self.closed in ("both", "left") else "("
        right = "]" if self.closed in ("both", "right") and math.isfinite(self.upper) else ")"
        return f"{left}{self.lower:g}, {self.upper:g}{right}"

    @property
    def help(self) -> str:
        """Meaning, symbol and unit in one line."""
        return f"{self.description}, {self.symbol} [{self.unit}]"

    @property
    def label(self) -> str:
        """Meaning and symbol for the axis of a picture; the symbol alone if both are longer than a label may be."""
        symbol = self.symbol.partition(" = ")[0]
        text = f"{self.description} {symbol}"
        return text if len(text) <= MAX_LABEL else symbol

    def restricted(self, lower: float, upper: float) -> Parameter:
        """The same parameter on a smaller range, closed at its finite ends.

        Raises
        ------
        ValueError
            If the range is not a part of that of the parameter.
        """
        if not self.lower <= lower < upper <= self.upper:
            raise ValueError(f"[{lower:g}, {upper:g}] is not a part of {self.interval}, the range of {self.name}")
        return replace(self, lower=lower, upper=upper, closed="both" if math.isfinite(upper) else "left")

    def in_degrees(self) -> Parameter:
        """The same angle in degrees, with the ending `_deg` of its name."""
        lower, upper = math.degrees(self.lower), math.degrees(self.upper)
        return replace(self, name=f"{self.name}_deg", unit="deg", lower=lower, upper=upper)
