"""Parameters of the routes and their ranges."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from rocking._base.quantities import RESTITUTION
from rocking_api.models import quantity as q

GROUPS = {one.name: one for one in (q.SLENDERNESS, q.FREQUENCY_RATIO, RESTITUTION)}

MAX_NUMBERS = 1_000_000
"""Most numbers of a list in JSON [-]; the points of a batch have a limit of their own, see `Settings`."""

_FAIL_FAST = Field(fail_fast=True, max_length=MAX_NUMBERS)  # one error for an array, not one for each entry

MAX_DURATION = 1e9  # duration of a history, tau = p t [-]


class Params(BaseModel):
    """Base of all parameter models. Unknown parameters are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class ListParams(Params):
    """A part of a list."""

    limit: int | None = q.between(1, 10_000, "most entries; absent: all", default=None, examples=[10], unit="-")
    cursor: str | None = q.said("`next_cursor` of the answer before; absent: the start of the list", None)

    def part(self, names: Sequence[str]) -> tuple[list[str], str | None]:
        """The names of this part, of ascending names, and the cursor of the next one; None at the end."""
        rest = [name for name in names if self.cursor is None or name > self.cursor]
        part = rest[: self.limit]
        return part, part[-1] if len(part) < len(rest) else None


class LookupOptions(Params):
    """Options of a lookup."""

    pulse: q.PulseName
    alpha_deg: q.AlphaDeg = None
    method: q.Method = "auto"
    absolute_tolerance: q.AbsoluteTolerance = 1e-4


class ResponseParams(LookupOptions):
    """One block."""

    slenderness: q.Slenderness
    frequency_ratio: q.FrequencyRatio
    restitution: q.Restitution


_Slenderness: Any = q.read_as(q.SLENDERNESS, kind=float | None)
_FrequencyRatio: Any = q.read_as(q.FREQUENCY_RATIO, kind=float | None)
_Restitution: Any = q.read_as(q.RESTITUTION, kind=float | None)


class TableParams(Params):
    """Beside a table in the body: options of its blocks, and groups that the table does not hold."""

    pulse: q.PulseName | None = q.said("required beside CSV and netCDF; JSON holds it", None, examples=["sine"])
    alpha_deg: q.AlphaDeg = None
    method: q.Method = "auto"
    absolute_tolerance: q.AbsoluteTolerance = 1e-4
    slenderness: _Slenderness = None
    frequency_ratio: _FrequencyRatio = None
    restitution: _Restitution = None
    format: q.BodyFormat = None


class BatchParams(LookupOptions):
    """Many blocks in a JSON body: numbers, or arrays of one length. The pulse has a name, or is given by samples."""

    slenderness: float | Annotated[list[float], _FAIL_FAST] = q.said(q.SLENDERNESS.named, unit="-")
    frequency_ratio: float | Annotated[list[float], _FAIL_FAST] = q.said(q.FREQUENCY_RATIO.named, unit="-")
    restitution: float | Annotated[list[float], _FAIL_FAST] = q.said(RESTITUTION.named, unit="-")
    format: q.BodyFormat = None


class ShapeParams(Params):
    """A pulse and blocks of one shape and restitution."""

    pulse: q.PulseName
    restitution: q.Restitution
    alpha_deg: q.AlphaDeg = None


class BlockInGroups(ShapeParams):
    """A pulse without amplitude, and a block."""

    frequency_ratio: q.FrequencyRatio

    @property
    def groups(self) -> dict[str, Any]:
        """Keyword arguments of the solver."""
        alpha = alpha_of(self.alpha_deg)
        return {"frequency_ratio": self.frequency_ratio, "restitution": self.restitution, "alpha": alpha}


class SpectrumParams(LookupOptions):
    """Blocks of one slenderness over a window of the frequency ratio, spaced evenly in its logarithm."""

    slenderness: q.Slenderness
    restitution: q.Restitution
    frequency_ratio_min: q.FrequencyRatio = Field(0.5, examples=[0.5])
    frequency_ratio_max: q.FrequencyRatio = Field(12.0, examples=[12.0])
    points: int = q.between(2, math.inf, "points of the curve", default=200, unit="-")
    format: q.Format = None


class OverturningParams(ShapeParams):
    """Boundary curves of overturning."""

    format: q.Format = None


class HistoryParams(BlockInGroups):
    """The motion of one block."""

    slenderness: q.Slenderness
    duration: float | None = q.said(
        "length p t; absent: the pulse and free rocking", None, gt=0, le=MAX_DURATION, unit="-"
    )
    samples: int = q.between(2, 1_000_000, "uniform samples; the events are added", default=400, unit="-")
    contact: q.Contact = False
    format: q.Format = None


class ThresholdsParams(BlockInGroups):
    """A block and a pulse without amplitude."""

    highest: float = q.said("largest a = a_g/(g tan alpha) searched", 100.0, gt=1, le=1e6, unit="-")


class MapParams(ShapeParams):
    """A window of the control space: columns uniform in log frequency ratio, rows uniform in slenderness."""

    frequency_ratio_min: q.FrequencyRatio = Field(0.5, examples=[0.5])
    frequency_ratio_max: q.FrequencyRatio = Field(12.0, examples=[12.0])
    slenderness_min: q.Slenderness = Field(0.01, examples=[0.01])
    slenderness_max: q.Slenderness = Field(1.05, examples=[1.05])
    columns: int = q.between(2, math.inf, "frequency ratios", default=120, unit="-")
    rows: int = q.between(2, math.inf, "slendernesses", default=90, unit="-")
    format: q.Format = None


def alpha_of(alpha_deg: float | None) -> float | None:
    """Slenderness angle [rad], None for the slender limit."""
    return math.radians(float(q.ALPHA_DEG.convert(alpha_deg))) if alpha_deg else None
