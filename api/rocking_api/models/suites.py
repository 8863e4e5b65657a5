"""Responses of the routes of suites of records. Intensities are in the unit of the measure of the suite."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel

from rocking._dimensional.fields import FIELDS
from rocking_api.models.answer import InUnits, ListAnswer
from rocking_api.models.params import ListParams, Params
from rocking_api.models.quantity import said, with_intervals
from rocking_api.models.responses import Link, declared

_NAME = said("name of the suite")
_TITLE = said("title of its fragility")
_MEASURE = said("measure of intensity, such as pga")
OF_MEASURE = "unit of the measure"  # what descriptions state as the unit of an intensity, which depends on the suite

_UNIT = said("unit of the measure, as CF writes it")


class SuiteParams(Params):
    """The format of the fragility of a suite."""

    format: Literal["json", "csv"] | None = said(
        "format of the response; absent: by the Accept header, else JSON", None
    )


class SuiteSummary(BaseModel):
    """A suite in the catalogue."""

    name: str = _NAME
    title: str = _TITLE
    measure: str = _MEASURE
    unit: str = _UNIT
    records: int = said("number of records [-]")
    blocks: int = said("number of blocks [-]")
    demands: list[str] = said("limit states: overturning, alpha, or a threshold of |theta|/alpha")
    links: list[Link] = said("the suite, and its data sets")


class SuiteCatalogue(ListAnswer[ListParams]):
    """Suites of the results folder."""

    suites: list[SuiteSummary] = said("the suites that can be read")


class SuiteRecord(BaseModel):
    """A record, as recorded."""

    name: str = said("name of the record, of a file without its ending, and of the component")
    peak_acceleration: float = said("peak ground acceleration [m/s2]")
    peak_velocity: float = said("peak ground velocity [m/s]")
    mean_period: float | None = said("mean period [s]; null if no frequency lies between 0.25 and 20 Hz")
    time_step: float = said("time between samples [s]")
    digest: str = said("sha256 of the time step and the samples of all components in m/s2")


@with_intervals(
    median_intensity=(float | None, "intensity of probability 1/2; null: the outcomes do not bound it", OF_MEASURE),
    dispersion=(float | None, "standard deviation of the logarithm of the intensity; null: not bounded", "-"),
)
class FragilityCurve(BaseModel):
    """A curve that was fitted by maximum likelihood, with intervals of the confidence of the suite."""

    model: str = said("lognormal or logistic (log-logistic)")
    fit_status: str = said("FITTED, or why the outcomes determine no curve")
    fit_meaning: str = said("the status in words")
    fitted: list[float | None] = said("probability at each level [-]")


@with_intervals(fraction=(list[float], "k/N at each level, with Clopper-Pearson intervals", "-"))
class LimitState(BaseModel):
    """How many records bring the block to a limit state, at each level."""

    demand: str = said("overturning, alpha (passed at some time), or a threshold of |theta|/alpha")
    exceedances: list[int] = said("number k of the N records that reach it, at each level [-]")
    first_exceedances: list[int] = said("number of records that reach it at this or a milder level [-]; for comparison")
    first_median_intensity: float | None = said("lognormal median of these counts, too low [unit of the measure]")
    curves: list[FragilityCurve] = said("fitted curves")
    records_surviving_above_first: list[str] = said("records that do not reach it at a level above their first")


class RecordMargin(BaseModel):
    """How far a record is from overturning the block; of intensities at most 0.5 % apart."""

    record: str = said("name of the record")
    overturning_intensity: float | None = said(
        "mildest intensity at which the block overturns [unit of the measure], the largest for frequency_ratio; "
        "null if it survives all"
    )
    overturning_scale: float | None = said("factor of the record there [-]")
    levels_survived_above: int = said("number of stronger levels at which the block survives [-]")


class RotationQuantile(BaseModel):
    """The peak rotation that a share of the records does not exceed."""

    quantile: float = said("share of the records [-]")
    peak_rotation: list[float | None] = said("peak |theta|/alpha at each level [-]; null where too many overturn")


class RecordSensitivity(BaseModel):
    """A block under one record at a level, and with other restitution or sampling."""

    record: str = said("name of the record")
    overturned: bool = said("whether the block overturns")
    peak_rotation: float | None = said("peak |theta|/alpha [-]; null if the block overturns")
    friction_demand: float | None = said("largest friction demand |H|/N, impacts excluded [-]; null: it lifts off")
    overturned_low_restitution: bool = said("whether it overturns with the smaller restitution")
    overturned_high_restitution: bool = said("whether it overturns with the larger restitution")
    overturned_resampled: bool = said("whether it overturns with the record interpolated band-limited at half its step")


@with_intervals(fraction=(float, "share of the records that overturn it, with its Clopper-Pearson interval", "-"))
class Sensitivity(BaseModel):
    """A block at one level: friction demand, and the effect of restitution and sampling on the share that overturns."""

    intensity: float = said("level of intensity [unit of the measure]")
    exceedances: int = said("number of records that overturn the block [-]")
    restitution_low: float = said("smaller coefficient of restitution [-]")
    fraction_low_restitution: float = said("share that overturns it with the smaller restitution [-]")
    changed_low_restitution: int = said("number of records whose outcome is then another one [-]")
    restitution_high: float = said("larger coefficient of restitution [-]")
    fraction_high_restitution: float = said("share that overturns it with the larger restitution [-]")
    changed_high_restitution: int = said("number of records whose outcome is then another one [-]")
    fraction_resampled: float = said("share that overturns it with the records interpolated so [-]")
    changed_resampled: int = said("number of records whose outcome is then another one [-]")
    records_changed_by_sampling: list[str] = said("names of these records")
    friction_demand_median: float | None = said("|H|/N that half of the records do not exceed [-]; null if infinite")
    friction_demand_largest: float | None = said("largest |H|/N under all records [-]; null if the block lifts off")
    records: list[RecordSensitivity] = said("each record")


_OF_BLOCK = {"width", "height", "half_diagonal", "alpha", "frequency_parameter", "uplift_acceleration", "restitution"}


@declared([one for one in FIELDS if one.name in _OF_BLOCK])
class SuiteBlock(BaseModel):
    """A block under the records of a suite."""

    limit_states: list[LimitState] = said("counts, intervals and curves of each limit state")
    margins: list[RecordMargin] = said("margin of each record")
    rotation_quantiles: list[RotationQuantile] = said("quantiles of the peak rotation")
    sensitivity: list[Sensitivity] = said("friction, restitution and sampling at the levels that the suite asks for")


class SuiteResponse(InUnits[SuiteParams]):
    """Blocks under a suite of records."""

    name: str = _NAME
    title: str = _TITLE
    measure: str = _MEASURE
    measure_meaning: str = said("the measure in words")
    unit: str = _UNIT
    confidence: float = said("confidence of all intervals [-]")
    intensity: list[float] = said("levels of intensity, ascending [unit of the measure]")
    records: list[SuiteRecord] = said("the records")
    blocks: list[SuiteBlock] = said("the blocks")
    links: list[Link] = said("the data sets of the suite, for download")

    @property
    def units(self) -> dict[str, str]:
        """The units, with that of the measure of the suite."""
        return {name: self.unit if unit == OF_MEASURE else unit for name, unit in super().units.items()}
