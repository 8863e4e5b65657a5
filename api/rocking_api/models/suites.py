"""Responses of the routes of suites of records. Intensities are in the unit of the measure of the suite."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, Field

from rocking_api.models.answer import QUERY, Answer, ListAnswer
from rocking_api.models.metadata import METADATA_FIELD, Metadata
from rocking_api.models.params import Params
from rocking_api.models.responses import Link

_NAME = Field(description="name of the suite")
_TITLE = Field(description="title of its fragility")
_MEASURE = Field(description="measure of intensity, such as pga")
OF_MEASURE = "unit of the measure"
"""What descriptions state as the unit of an intensity, which depends on the suite."""

_UNIT = Field(description="unit of the measure, as CF writes it")


class SuiteParams(Params):
    """The format of the fragility of a suite."""

    format: Literal["json", "csv", "nrml"] | None = Field(
        None, description="format of the response; absent: by the Accept header, else JSON (nrml: of OpenQuake)"
    )
    curves: Literal["discrete", "lognormal"] = Field(
        "discrete", description="what NRML holds: fractions at the levels, or curves fitted to them"
    )


class SuiteSummary(BaseModel):
    """A suite in the catalogue."""

    name: str = _NAME
    title: str = _TITLE
    measure: str = _MEASURE
    unit: str = _UNIT
    records: int = Field(description="number of records [-]")
    blocks: int = Field(description="number of blocks [-]")
    demands: list[str] = Field(description="limit states: overturning, alpha, or a threshold of |theta|/alpha")
    links: list[Link] = Field(description="the suite, and its data sets")


class SuiteCatalogue(ListAnswer):
    """Suites of the results folder."""

    suites: list[SuiteSummary] = Field(description="the suites that can be read")


class SuiteRecord(BaseModel):
    """A record of a suite, as recorded."""

    name: str = Field(description="name of the record")
    peak_acceleration: float = Field(description="peak ground acceleration [m/s2]")
    peak_velocity: float = Field(description="peak ground velocity [m/s]")
    mean_period: float | None = Field(description="mean period [s]; null if it has none")
    time_step: float = Field(description="time between samples [s]")
    digest: str = Field(description="sha256 of the time step and the samples in m/s2")


class FragilityCurve(BaseModel):
    """A curve that was fitted by maximum likelihood, with intervals of the confidence of the suite."""

    model: str = Field(description="lognormal or logistic (log-logistic)")
    fit_status: str = Field(description="FITTED, or why the outcomes determine no curve")
    fit_meaning: str = Field(description="the status in words")
    median_intensity: float | None = Field(description="intensity of probability 1/2 [unit of the measure]")
    median_intensity_lower: float | None = Field(description="lower end of its interval [unit of the measure]")
    median_intensity_upper: float | None = Field(
        description="upper end of its interval [unit of the measure]; null if the outcomes do not bound it"
    )
    dispersion: float | None = Field(description="standard deviation of the logarithm of the intensity [-]")
    dispersion_lower: float | None = Field(description="lower end of its interval [-]")
    dispersion_upper: float | None = Field(description="upper end of its interval [-]; null if it is not bounded")
    annual_rate: float | None = Field(
        None, description="annual rate of reaching the limit state [1/year]; null without a hazard curve"
    )
    fitted: list[float | None] = Field(description="probability at each level [-]")


class LimitState(BaseModel):
    """How many records bring the block to a limit state, at each level."""

    demand: str = Field(description="overturning, alpha (passed at some time), or a threshold of |theta|/alpha")
    exceedances: list[int] = Field(description="number k of the N records that reach it, at each level [-]")
    fraction: list[float] = Field(description="k/N at each level [-]")
    fraction_lower: list[float] = Field(description="lower end of the Clopper-Pearson interval at each level [-]")
    fraction_upper: list[float] = Field(description="upper end of the Clopper-Pearson interval at each level [-]")
    first_exceedances: list[int] = Field(
        description="number of records that reach it at this or a milder level [-]; for comparison"
    )
    first_median_intensity: float | None = Field(
        description="lognormal median of these counts [unit of the measure]; for comparison: it is on the low side"
    )
    curves: list[FragilityCurve] = Field(description="fitted curves")
    records_surviving_above_first: list[str] = Field(
        description="records that do not reach it at a level above the first at which they do"
    )


class RecordMargin(BaseModel):
    """How far a record is from overturning the block; of intensities at most 0.5 % apart."""

    record: str = Field(description="name of the record")
    overturning_intensity: float | None = Field(
        description="mildest intensity at which the block overturns [unit of the measure], which is the largest one "
        "for frequency_ratio; null if it survives all"
    )
    overturning_scale: float | None = Field(description="factor of the record there [-]")
    levels_survived_above: int = Field(description="number of stronger levels at which the block survives [-]")


class RotationQuantile(BaseModel):
    """The peak rotation that a share of the records does not exceed."""

    quantile: float = Field(description="share of the records [-]")
    peak_rotation: list[float | None] = Field(
        description="peak |theta|/alpha at each level [-]; null where too many records overturn the block"
    )


class RecordSensitivity(BaseModel):
    """A block under one record at a level, and with other restitution or sampling."""

    record: str = Field(description="name of the record")
    overturned: bool = Field(description="whether the block overturns")
    peak_rotation: float | None = Field(description="peak |theta|/alpha [-]; null if the block overturns")
    friction_demand: float | None = Field(
        description="largest friction demand |H|/N [-], impacts excluded; null if the block lifts off the ground"
    )
    overturned_low_restitution: bool = Field(description="whether it overturns with the smaller restitution")
    overturned_high_restitution: bool = Field(description="whether it overturns with the larger restitution")
    overturned_resampled: bool = Field(
        description="whether it overturns under the record interpolated band-limited at half its step"
    )


class Sensitivity(BaseModel):
    """A block at one level: friction demand, and the effect of restitution and sampling on the share that overturns."""

    intensity: float = Field(description="level of intensity [unit of the measure]")
    exceedances: int = Field(description="number of records that overturn the block [-]")
    fraction: float = Field(description="share of the records that overturn it [-]")
    fraction_lower: float = Field(description="lower end of the Clopper-Pearson interval of the probability [-]")
    fraction_upper: float = Field(description="upper end of the Clopper-Pearson interval of the probability [-]")
    restitution_low: float = Field(description="smaller coefficient of restitution [-]")
    fraction_low_restitution: float = Field(description="share that overturns it with the smaller restitution [-]")
    changed_low_restitution: int = Field(description="number of records whose outcome is then another one [-]")
    restitution_high: float = Field(description="larger coefficient of restitution [-]")
    fraction_high_restitution: float = Field(description="share that overturns it with the larger restitution [-]")
    changed_high_restitution: int = Field(description="number of records whose outcome is then another one [-]")
    fraction_resampled: float = Field(
        description="share that overturns it with the records interpolated band-limited at half their step [-]"
    )
    changed_resampled: int = Field(description="number of records whose outcome is then another one [-]")
    records_changed_by_sampling: list[str] = Field(description="names of these records")
    friction_demand_median: float | None = Field(
        description="largest friction demand |H|/N that half of the records do not exceed [-]; null if infinite"
    )
    friction_demand_largest: float | None = Field(
        description="largest friction demand |H|/N under all records [-]; null if the block lifts off"
    )
    records: list[RecordSensitivity] = Field(description="each record")


class SuiteBlock(BaseModel):
    """A block under the records of a suite."""

    width: float = Field(description="width 2b [m]")
    height: float = Field(description="height 2h [m]")
    half_diagonal: float = Field(description="half diagonal R [m]")
    alpha_deg: float = Field(description="slenderness angle [deg]")
    frequency_parameter: float = Field(description="frequency parameter p [rad/s]")
    uplift_acceleration: float = Field(description="peak ground acceleration of uplift, g tan(alpha) [m/s2]")
    restitution: float = Field(description="coefficient of restitution eta [-]")
    limit_states: list[LimitState] = Field(description="counts, intervals and curves of each limit state")
    margins: list[RecordMargin] = Field(description="margin of each record")
    rotation_quantiles: list[RotationQuantile] = Field(description="quantiles of the peak rotation")
    sensitivity: list[Sensitivity] = Field(
        description="friction demand, and the effect of restitution and sampling, at the levels that the suite asks for"
    )


class SuiteResponse(Answer):
    """Blocks under a suite of records."""

    query: SuiteParams = QUERY
    name: str = _NAME
    title: str = _TITLE
    measure: str = _MEASURE
    measure_meaning: str = Field(description="the measure in words")
    unit: str = _UNIT
    confidence: float = Field(description="confidence of all intervals [-]")
    intensity: list[float] = Field(description="levels of intensity, ascending [unit of the measure]")
    records: list[SuiteRecord] = Field(description="the records")
    blocks: list[SuiteBlock] = Field(description="the blocks")
    links: list[Link] = Field(description="the data sets of the suite, for download")
    metadata: Metadata = METADATA_FIELD

    @property
    def units(self) -> dict[str, str]:
        """The units, with that of the measure of the suite."""
        return {name: self.unit if unit == OF_MEASURE else unit for name, unit in super().units.items()}
