"""Responses of the routes of suites of records. Intensities are in the unit of the measure of the suite."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel

from rocking_api.models.answer import InUnits, ListAnswer
from rocking_api.models.fields import Size
from rocking_api.models.params import ListParams, Params
from rocking_api.models.quantity import said
from rocking_api.models.responses import Link

_NAME = said("name of the suite")
_TITLE = said("title of its fragility")
_MEASURE = said("measure of intensity, such as pga")
OF_MEASURE = "unit of the measure"  # what descriptions state as the unit of an intensity, which depends on the suite

_UNIT = said("unit of the measure, as CF writes it")


class SuiteParams(Params):
    """The format of the fragility of a suite."""

    format: Literal["json", "csv"] | None = said("format of the response; absent: JSON", None)


class SuiteSummary(BaseModel):
    """A suite in the catalogue."""

    name: str = _NAME
    title: str = _TITLE
    measure: str = _MEASURE
    unit: str = _UNIT
    records: int = said("number of records", unit="-")
    blocks: int = said("number of blocks", unit="-")
    demands: list[str] = said("limit states: overturning, alpha, or a threshold of |theta|/alpha")
    links: list[Link] = said("the suite, and its data sets")


class SuiteCatalogue(ListAnswer[ListParams]):
    """Suites of the results folder."""

    suites: list[SuiteSummary] = said("the suites that can be read")


class SuiteRecord(BaseModel):
    """A record, as recorded."""

    name: str = said("name of the record, of a file without its ending, and of the component")
    peak_acceleration: float = said("peak ground acceleration", unit="m/s2")
    peak_velocity: float = said("peak ground velocity", unit="m/s")
    mean_period: float | None = said("mean period; null if no frequency lies between 0.25 and 20 Hz", unit="s")
    time_step: float = said("time between samples", unit="s")
    digest: str = said("sha256 of the time step and the samples of all components in m/s2")


class FragilityCurve(BaseModel):
    """A curve that was fitted by maximum likelihood, with intervals of the confidence of the suite."""

    median_intensity: float | None = said(
        "intensity of probability 1/2; null: the outcomes do not bound it", unit=OF_MEASURE
    )
    median_intensity_lower: float | None = said("lower end of its interval", unit=OF_MEASURE)
    median_intensity_upper: float | None = said("upper end of its interval", unit=OF_MEASURE)
    dispersion: float | None = said("standard deviation of the logarithm of the intensity; null: not bounded", unit="-")
    dispersion_lower: float | None = said("lower end of its interval", unit="-")
    dispersion_upper: float | None = said("upper end of its interval", unit="-")

    model: str = said("lognormal or logistic (log-logistic)")
    fit_status: str = said("FITTED, or why the outcomes determine no curve")
    fit_meaning: str = said("the status in words")
    fitted: list[float | None] = said("probability at each level", unit="-")


class LimitState(BaseModel):
    """How many records bring the block to a limit state, at each level."""

    fraction: list[float] = said("k/N at each level, with Clopper-Pearson intervals", unit="-")
    fraction_lower: list[float] = said("lower end of its interval", unit="-")
    fraction_upper: list[float] = said("upper end of its interval", unit="-")

    demand: str = said("overturning, alpha (passed at some time), or a threshold of |theta|/alpha")
    exceedances: list[int] = said("number k of the N records that reach it, at each level", unit="-")
    first_exceedances: list[int] = said(
        "number of records that reach it at this or a milder level; for comparison", unit="-"
    )
    first_median_intensity: float | None = said("lognormal median of these counts, too low", unit="unit of the measure")
    curves: list[FragilityCurve] = said("fitted curves")
    records_surviving_above_first: list[str] = said("records that do not reach it at a level above their first")


class RecordMargin(BaseModel):
    """How far a record is from overturning the block; of intensities at most 0.5 % apart."""

    record: str = said("name of the record")
    overturning_intensity: float | None = said(
        "mildest intensity at which the block overturns, the largest for frequency_ratio; null if it survives all",
        unit="unit of the measure",
    )
    overturning_scale: float | None = said("factor of the record there", unit="-")
    levels_survived_above: int = said("number of stronger levels at which the block survives", unit="-")


class RotationQuantile(BaseModel):
    """The peak rotation that a share of the records does not exceed."""

    quantile: float = said("share of the records", unit="-")
    peak_rotation: list[float | None] = said("peak |theta|/alpha at each level; null where too many overturn", unit="-")


class RecordSensitivity(BaseModel):
    """A block under one record at a level, and with other restitution or sampling."""

    record: str = said("name of the record")
    overturned: bool = said("whether the block overturns")
    peak_rotation: float | None = said("peak |theta|/alpha; null if the block overturns", unit="-")
    friction_demand: float | None = said(
        "largest friction demand |H|/N, impacts excluded; null: it lifts off", unit="-"
    )
    overturned_low_restitution: bool = said("whether it overturns with the smaller restitution")
    overturned_high_restitution: bool = said("whether it overturns with the larger restitution")
    overturned_resampled: bool = said("whether it overturns with the record interpolated band-limited at half its step")


class Sensitivity(BaseModel):
    """A block at one level: friction demand, and the effect of restitution and sampling on the share that overturns."""

    fraction: float = said("share of the records that overturn it, with its Clopper-Pearson interval", unit="-")
    fraction_lower: float = said("lower end of its interval", unit="-")
    fraction_upper: float = said("upper end of its interval", unit="-")

    intensity: float = said("level of intensity", unit="unit of the measure")
    exceedances: int = said("number of records that overturn the block", unit="-")
    restitution_low: float = said("smaller coefficient of restitution", unit="-")
    fraction_low_restitution: float = said("share that overturns it with the smaller restitution", unit="-")
    changed_low_restitution: int = said("number of records whose outcome is then another one", unit="-")
    restitution_high: float = said("larger coefficient of restitution", unit="-")
    fraction_high_restitution: float = said("share that overturns it with the larger restitution", unit="-")
    changed_high_restitution: int = said("number of records whose outcome is then another one", unit="-")
    fraction_resampled: float = said("share that overturns it with the records interpolated so", unit="-")
    changed_resampled: int = said("number of records whose outcome is then another one", unit="-")
    records_changed_by_sampling: list[str] = said("names of these records")
    friction_demand_median: float | None = said(
        "|H|/N that half of the records do not exceed; null if infinite", unit="-"
    )
    friction_demand_largest: float | None = said(
        "largest |H|/N under all records; null if the block lifts off", unit="-"
    )
    records: list[RecordSensitivity] = said("each record")


class SuiteBlock(Size):
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
    confidence: float = said("confidence of all intervals", unit="-")
    intensity: list[float] = said("levels of intensity, ascending", unit="unit of the measure")
    records: list[SuiteRecord] = said("the records")
    blocks: list[SuiteBlock] = said("the blocks")
    links: list[Link] = said("the data sets of the suite, for download")

    @property
    def units(self) -> dict[str, str]:
        """The units, with that of the measure of the suite."""
        return {name: self.unit if unit == OF_MEASURE else unit for name, unit in super().units.items()}
