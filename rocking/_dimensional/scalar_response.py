"""What responses in SI units have in common, whatever the ground motion: outcome, rotation, displacement, exports."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any, ClassVar

from rocking._base.equality import EqualByValue
from rocking._model.block import AbstractBlock
from rocking._model.fields import OUTCOME, ResponseField
from rocking._model.outcome import Outcome
from rocking._model.response import Response
from rocking._solver.bounded_response import BoundedResponse

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

ROTATION = ResponseField("rotation", "f8", "rad", "3.2", "peak rotation max |theta|", "the block overturns")
DISPLACEMENT = ResponseField(
    "displacement", "f8", "m", "3.2", "largest horizontal displacement of a top corner", "the block overturns"
)

BLOCK_FIELDS = (
    ResponseField("width", "f8", "m", "2.1", "width 2b of the block"),
    ResponseField("height", "f8", "m", "2.1", "height 2h of the block"),
    ResponseField("half_diagonal", "f8", "m", "2.2", "half-diagonal R of the block"),
    ResponseField("alpha", "f8", "rad", "2.1", "slenderness angle"),
    ResponseField("frequency_parameter", "f8", "rad s-1", "2.2", "frequency parameter p"),
    ResponseField("uplift_acceleration", "f8", "m s-2", "2.1", "smallest ground acceleration that starts rocking"),
)
"""Fields of a block."""

SLENDERNESS = ResponseField("slenderness", "f8", "1", "5.3", "dimensionless slenderness g tan(alpha)/a_g")
RESTITUTION = ResponseField("restitution", "f8", "1", "2.4", "coefficient of restitution eta")


@dataclass(frozen=True, eq=False, repr=False)
class ScalarResponse(EqualByValue, ABC):
    """The response of one block to one ground motion.

    Attributes
    ----------
    block : Block
        The block.
    dimensionless : Response or BoundedResponse
        The response in groups, arrays of shape ().
    """

    FIELDS: ClassVar[tuple[ResponseField, ...]]
    """Fields of the exports in order; each is an attribute of the response, of its groups or of its block."""

    block: AbstractBlock
    dimensionless: Response | BoundedResponse

    @property
    @abstractmethod
    def motion(self) -> Mapping[str, str]:
        """Kind of the ground motion and its name, {"pulse": NAME} or {"record": NAME}."""

    @abstractmethod
    def _describe_motion(self) -> str:
        """The ground motion in words."""

    @abstractmethod
    def _describe_impacts(self) -> str:
        """The number of impacts in words."""

    @property
    def outcome(self) -> Outcome:
        """Final outcome by the rocking model."""
        return Outcome(int(self.dimensionless.outcome))

    @property
    def overturned(self) -> bool:
        """Whether the block overturns in the end."""
        return bool(self.dimensionless.overturned)

    @property
    def impacts(self) -> int:
        """Number of impacts until the outcome is certain, as `Response.impacts`."""
        return int(self.dimensionless.impacts)

    @property
    def exceeded_alpha(self) -> bool:
        """Whether |theta| passed alpha at some time."""
        return bool(self.dimensionless.exceeded_alpha)

    @property
    def peak_rotation(self) -> float:
        """Peak rotation max |theta|/alpha [-]; nan where the block overturns, 0 without uplift."""
        return float(self.dimensionless.peak_rotation)

    @property
    def rotation(self) -> float:
        """Peak rotation [rad]; nan where the block overturns, 0 without uplift."""
        return self.peak_rotation * self.block.alpha

    @property
    def displacement(self) -> float:
        """Largest horizontal displacement of a top corner [m]; nan where the block overturns."""
        return self.block.top_displacement(self.rotation)

    def to_dict(self) -> dict[str, Any]:
        """The fields of `FIELDS` with numbers, and the outcome by its name."""
        values: dict[str, Any] = {}
        for field in self.FIELDS:
            source = next(one for one in (self, self.dimensionless, self.block) if hasattr(one, field.name))
            value = getattr(source, field.name)
            values[field.name] = value.name if field is OUTCOME else float(value) if field.dtype == "f8" else value
        return values

    def to_xarray(self) -> xr.Dataset:
        """The fields as a data set of scalars, with units, meanings and equation numbers."""
        import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

        values = self.to_dict() | {OUTCOME.name: int(self.outcome)}
        variables = {one.name: ((), values[one.name], {"units": one.unit} | one.attributes) for one in self.FIELDS}
        return xr.Dataset(variables, attrs=dict(self.motion))

    def to_pandas(self) -> pd.Series:
        """The fields as a series; units are those of `to_xarray`."""
        import pandas as pd  # noqa: PLC0415  # takes longer to load than the solver

        return pd.Series({**self.motion, **self.to_dict()})

    def __repr__(self) -> str:
        """What happened, in words and SI units."""
        return f"<rocking.{type(self).__name__}: {self._summary()}>"

    def _repr_html_(self) -> str:
        return html_table(self._summary(), self.FIELDS, self.to_dict())

    def _summary(self) -> str:
        happened = self._describe_outcome()
        if self.outcome == Outcome.SAFE:
            moved = f"top displacement {self.displacement:.4g} m"
            happened = f"{happened}: {self._describe_peak()}, {moved}, {self._describe_impacts()}"
        return f"{happened}{self._describe_margin()}; {self.block.description} under {self._describe_motion()}"

    def _describe_outcome(self) -> str:
        return self.outcome.sentence

    def _describe_peak(self) -> str:
        return f"peak rotation {math.degrees(self.rotation):.4g} deg"

    def _describe_margin(self) -> str:
        return ""


def count_of_impacts(impacts: int) -> str:
    """A number of impacts in words."""
    return f"{impacts} impact{'' if impacts == 1 else 's'}"


def html_table(caption: str, fields: tuple[ResponseField, ...], values: Mapping[str, Any]) -> str:
    """A paragraph and a table of meanings, values and units."""
    rows = "".join(
        f"<tr><td>{escape(one.meaning)}</td><td>{escape(_text(values[one.name]))}</td>"
        f"<td>{'' if one.unit == '1' else escape(one.unit)}</td></tr>"
        for one in fields
    )
    return f"<p>{escape(caption)}</p><table>{rows}</table>"


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
