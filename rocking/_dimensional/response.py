"""The response of a block in SI units: rotation, displacement, outcome in words, margins and warnings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any

from rocking._base.equality import EqualByValue
from rocking._dimensional.assessment import SEARCH_SECONDS, Assessment, assess
from rocking._dimensional.margins import Margins
from rocking._dimensional.problem import BlockProblem
from rocking._dimensional.thresholds import BodyThresholds
from rocking._excitation.records.record import Record
from rocking._model.block import AbstractBlock
from rocking._model.fields import (
    ERROR_BOUND,
    EXCEEDED_ALPHA,
    IMPACTS,
    OUTCOME,
    OVERTURNED,
    PEAK_ROTATION,
    ResponseField,
)
from rocking._model.outcome import Outcome
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import BoundedResponse

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

ROTATION = ResponseField("rotation", "f8", "rad", "3.2", "peak rotation max |theta|", "the block overturns")
DISPLACEMENT = ResponseField(
    "displacement", "f8", "m", "3.2", "largest horizontal displacement of the top", "the block overturns"
)

FIELDS = (
    ROTATION,
    DISPLACEMENT,
    OVERTURNED,
    OUTCOME,
    IMPACTS,
    EXCEEDED_ALPHA,
    PEAK_ROTATION,
    ERROR_BOUND,
    ResponseField("width", "f8", "m", "2.1", "width 2b of the block"),
    ResponseField("height", "f8", "m", "2.1", "height 2h of the block"),
    ResponseField("half_diagonal", "f8", "m", "2.2", "half-diagonal R of the block"),
    ResponseField("alpha", "f8", "rad", "2.1", "slenderness angle"),
    ResponseField("frequency_parameter", "f8", "rad s-1", "2.2", "frequency parameter p"),
    ResponseField("uplift_acceleration", "f8", "m s-2", "2.1", "smallest ground acceleration that starts rocking"),
    ResponseField("scale", "f8", "1", "2.2", "factor of the record"),
    ResponseField("peak_acceleration", "f8", "m s-2", "3.2", "peak ground acceleration a_g"),
    ResponseField("period", "f8", "s", "3.2", "period T_p of the pulse"),
    ResponseField("slenderness", "f8", "1", "5.3", "dimensionless slenderness g tan(alpha)/a_g"),
    ResponseField("frequency_ratio", "f8", "1", "5.3", "frequency ratio omega_g/p"),
    ResponseField("restitution", "f8", "1", "2.4", "coefficient of restitution eta"),
)
"""Fields of a response in SI units, in order; each is an attribute of the response, of its groups or of its block."""

OF_PULSES, OF_RECORDS = ("error_bound", "period", "frequency_ratio"), ("scale",)
"""Names of the fields of one kind of motion only."""


@dataclass(frozen=True, eq=False, repr=False)
class BlockResponse(EqualByValue):
    """What happens to a block under a pulse or a record.

    Margins, contact forces and warnings are found when they are first asked for, in some hundredths of a second under a
    pulse, some tenths under a record.

    Attributes
    ----------
    dimensionless : Response or BoundedResponse
        The response in groups, arrays of shape (); under a pulse with a bound of its error.
    problem : BlockProblem
        The block and the motion.
    searches_thresholds : bool
        Whether the strengths at which the outcome changes are searched.
    """

    dimensionless: Response | BoundedResponse
    problem: BlockProblem
    searches_thresholds: bool = True

    @property
    def fields(self) -> tuple[ResponseField, ...]:
        """The fields of the exports, in order: those of `FIELDS` that the kind of motion has."""
        others = OF_PULSES if isinstance(self.problem.motion, Record) else OF_RECORDS
        return tuple(one for one in FIELDS if one.name not in others)

    @property
    def block(self) -> AbstractBlock:
        """The block."""
        return self.problem.block

    @property
    def record(self) -> Record:
        """The record, without its factor; not of a pulse."""
        return self.problem.record

    @property
    def motion(self) -> Mapping[str, str]:
        """Kind of the ground motion and its name, {"pulse": NAME} or {"record": NAME}."""
        motion = self.problem.motion
        return {"record" if isinstance(motion, Record) else "pulse": motion.name}

    @property
    def scale(self) -> float:
        """Factor of the record [-]; 1 for a pulse."""
        return self.problem.scale

    @property
    def peak_acceleration(self) -> float:
        """Peak ground acceleration a_g [m/s2], of the scaled record."""
        return self.problem.peak_acceleration

    @property
    def period(self) -> float:
        """Period T_p of the pulse [s]; 1 for a record."""
        return self.problem.period

    @property
    def slenderness(self) -> float:
        """g tan(alpha)/a_g [-]: depends on the motion, unlike h/b."""
        return float(self.problem.groups["slenderness"])

    @property
    def frequency_ratio(self) -> float:
        """omega_g/p [-]; of a pulse."""
        return float(self.problem.groups["frequency_ratio"])

    @property
    def restitution(self) -> float:
        """eta [-]."""
        return float(self.problem.groups["restitution"])

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

    @cached_property
    def assessment(self) -> Assessment:
        """Margins, contact forces, conditioning and warnings."""
        return self.assess()

    def assess(self, *, seconds: float = SEARCH_SECONDS, stop: StopFlag | None = None) -> Assessment:
        """The assessment, with a time limit [s] of each search and a flag that cancels the work."""
        return assess(self.problem, self.dimensionless, thresholds=self.searches_thresholds, seconds=seconds, stop=stop)

    @property
    def sentence(self) -> str:
        """The outcome in words, without a subject; first whether the rocking model does not apply."""
        return self.assessment.sentence

    @property
    def margin(self) -> str | None:
        """From which strength of the motion the block overturns, in words; None if that was not searched."""
        return self.assessment.margin

    @property
    def rocking_model_applies(self) -> bool:
        """False if pure rocking needs a coefficient of friction beyond 1, or the block lifts off."""
        return self.assessment.rocking_model_applies

    @property
    def thresholds(self) -> BodyThresholds | None:
        """Peak accelerations of the pulse [m/s2], or factors of the record, at which the outcome changes.

        At this period; None if they are not searched, or not found in time.
        """
        return self.assessment.thresholds

    @property
    def margins(self) -> Margins | None:
        """Distances to another outcome under a pulse; None of a record, if not searched, or not found in time."""
        return self.assessment.margins

    @property
    def resampled(self) -> Response | BoundedResponse | None:
        """The response to the record interpolated band-limited at an eighth of its step; None if it is not computed."""
        return self.assessment.resampled

    @property
    def warnings(self) -> list[str]:
        """Where the response is in doubt."""
        return self.assessment.warnings

    def to_dict(self) -> dict[str, Any]:
        """The fields with numbers, and the outcome by its name."""
        values: dict[str, Any] = {}
        for field in self.fields:
            source = next(one for one in (self, self.dimensionless, self.block) if hasattr(one, field.name))
            value = getattr(source, field.name)
            values[field.name] = value.name if field is OUTCOME else float(value) if field.dtype == "f8" else value
        return values

    def to_xarray(self) -> xr.Dataset:
        """The fields as a data set of scalars, with units, meanings and equation numbers."""
        import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

        values = self.to_dict() | {OUTCOME.name: int(self.outcome)}
        return xr.Dataset(
            {one.name: one.variable((), values[one.name]) for one in self.fields}, attrs=dict(self.motion)
        )

    def to_pandas(self) -> pd.Series:
        """The fields as a series; units are those of `to_xarray`."""
        import pandas as pd  # noqa: PLC0415  # takes longer to load than the solver

        return pd.Series({**self.motion, **self.to_dict()})

    def __repr__(self) -> str:
        """What happened, in words and SI units; under a record with the margin, for which it is assessed."""
        return f"<rocking.BlockResponse: {self._summary()}>"

    def _repr_html_(self) -> str:
        values = self.to_dict()
        rows = "".join(
            f"<tr><td>{escape(one.meaning)}</td><td>{escape(_text(values[one.name]))}</td>"
            f"<td>{'' if one.unit == '1' else escape(one.unit)}</td></tr>"
            for one in self.fields
        )
        return f"<p>{escape(self._summary())}</p><table>{rows}</table>"

    def _summary(self) -> str:
        motion, happened, doubt, margin = self.problem.motion, self.outcome.sentence, "", ""
        impacts = count_of_impacts(self.impacts)
        if isinstance(motion, Record):
            found = self.assessment
            happened, margin = found.sentence, f"; {found.margin}" if found.margin else ""
            if not found.peak_is_determined:
                doubt = f" (not determined: amplification {found.amplification:.1e})"
            under = f"{motion.name or 'a record'} scaled to {self.peak_acceleration:.4g} m/s2"
        else:
            impacts += " during the pulse"
            under = f"{motion.name} of {self.peak_acceleration:.4g} m/s2 and {self.period:.4g} s"
        if self.outcome == Outcome.SAFE:
            happened += f": {described_peak(self.rotation, self.displacement, doubt)}, {impacts}"
        return f"{happened}{margin}; {self.block.description} under {under}"


def respond(problem: BlockProblem, *, thresholds: bool = True, stop: StopFlag | None = None) -> BlockResponse:
    """The response of a block, by the solver; `stop` cancels it, `BlockResponse.assess` has its own."""
    return BlockResponse(problem.solve(stop), problem, thresholds)


def described_peak(rotation: float, displacement: float, doubt: str = "") -> str:
    """Peak rotation [rad] and displacement [m] in words."""
    return f"peak rotation {math.degrees(rotation):.4g} deg{doubt}, top displacement {displacement:.4g} m"


def count_of_impacts(impacts: int) -> str:
    """A number of impacts in words."""
    return f"{impacts} impact{'' if impacts == 1 else 's'}"


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
