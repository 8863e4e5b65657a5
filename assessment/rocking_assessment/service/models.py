"""Objects at a site: parameters and response, from the declared columns of an assessment."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, field_validator, model_validator
from rocking_api.models.answer import Solved
from rocking_api.models.quantity import BaselineOrder, TableFormat, between, read_as, said
from rocking_api.models.table import TableParams

from rocking.extension import (
    PERIOD,
    PGA,
    PGV,
    RESOLUTION,
    RESOLUTIONS,
    InvalidArgumentError,
    Record,
    as_pulse,
    plain_numbers,
    split_pulses,
)
from rocking_assessment._objects.columns import OUTPUTS
from rocking_assessment._objects.site import LENGTH, STRENGTHS, Site
from rocking_assessment._objects.standards import checked_clauses

MAX_OBJECTS = 2000  # most rows of a table [-]
MAX_RECORDS = 100  # most records of a site [-]
MAX_SAMPLES = 20_000  # most variants of an object [-]
MAX_MODES = 20  # most modes of a building [-]
MAX_SHAPES = 50  # most pulse shapes of a site [-]
MAX_LEVELS = 1000  # most levels of a hazard curve [-]
MAX_RECORD = 1_000_000  # most samples of a component of a record [-]

Samples = Annotated[list[float], Field(max_length=MAX_RECORD, fail_fast=True)]
Levels = Annotated[list[float], Field(max_length=MAX_LEVELS, fail_fast=True)]


Pga: Any = read_as(PGA.restricted(*STRENGTHS), f"{PGA.meaning}, required without records", float | None, examples=[3.0])
Pgv: Any = read_as(
    PGV.restricted(*STRENGTHS),
    "PGV, sets the period of each pulse; either this or periods",
    float | None,
    examples=[0.3],
)
_PERIOD = PERIOD.restricted(*LENGTH)
PeriodMin: Any = read_as(_PERIOD, "shortest period of the pulses, with `period_max`", float | None)
PeriodMax: Any = read_as(_PERIOD, "longest period of the pulses, with `period_min`", float | None)


class AssessParams(TableParams):
    """A site, by PGA and PGV, by PGA and a range of periods, or by records in the body."""

    pga: Pga = None
    pgv: Pgv = None
    period_min: PeriodMin = None
    period_max: PeriodMax = None
    shapes: str | None = said(
        "pulses, with commas; absent: all that end at rest", None, max_length=10_000, examples=["sine,ricker"]
    )
    moving_ground: bool = said("also half sine and rectangular, which leave the ground moving", False)
    floor_periods: str | None = said(
        "periods of the building, for objects on a floor, separated by commas", None, unit="s"
    )
    floor_damping: str = said("damping ratios of these modes, one for all or one for each", "0.05", unit="-")
    floor_participation: str = said("participation factors times mode shapes at the floor, likewise", "1", unit="-")
    baseline_order: BaselineOrder = None
    samples: int = between(
        0, MAX_SAMPLES, "variants of each object in its tolerance and 0.05 of eta", default=0, unit="-"
    )
    seed: int = between(0, 2**53, "seed of these variants", default=0, unit="-")
    resolution: float = between(
        *RESOLUTIONS,
        "largest relative step of factors on a record, 2.5 times that on a pulse",
        default=RESOLUTION,
        unit="-",
    )
    sensitivity: bool = said("find the factors of changed objects, and the sizes that survive", True)
    standards: str = said("checks by standards, with commas between, or all", "", examples=["static,asce43"])
    format: TableFormat = None

    @field_validator("standards", "shapes", "floor_periods", "floor_damping", "floor_participation")
    @classmethod
    def _check(cls, value: str | None, info: ValidationInfo) -> str | None:
        name = str(info.field_name)
        if name == "standards":
            checked_clauses(value or "")
        elif name == "shapes" and value is not None:
            for shape in _parts(name, value, MAX_SHAPES, "shapes"):
                as_pulse(shape)
        elif value is not None:
            modes_of(name, value)
        return value

    def site(self, body: AssessBody | None) -> Site:
        """The site, with the records and the hazard curve of a body."""
        ends = self.period_min, self.period_max
        records: list[Record | tuple[Record, Record]] = []
        hazard = None
        if body is not None:
            records = [item.motion(k, self.baseline_order) for k, item in enumerate(body.records, start=1)]
            hazard = body.hazard
        return Site(
            self.pga,
            self.pgv,
            None if ends == (None, None) else ends,  # one of them alone is refused there
            records,
            None if hazard is None else (hazard.intensity, hazard.annual_rate),
            None if self.shapes is None else split_pulses(self.shapes),
            self.moving_ground,
            None if self.floor_periods is None else modes_of("floor_periods", self.floor_periods),
            modes_of("floor_damping", self.floor_damping),
            modes_of("floor_participation", self.floor_participation),
        )


def modes_of(name: str, text: str) -> list[float]:
    """The numbers of the modes of a building, separated by commas."""
    _parts(name, text, MAX_MODES, "modes")
    return plain_numbers(name, text)


def _parts(name: str, text: str, limit: int, kind: str) -> list[str]:
    """The parts of a text that commas separate, at most `limit`; commas within brackets separate none."""
    parts = split_pulses(text)
    if len(parts) > limit:
        raise InvalidArgumentError(name, f"{len(parts)} {kind}", f"at most {limit} {kind}")
    return parts


class SuiteRecordBody(BaseModel):
    """A record of the suite of a site."""

    model_config = ConfigDict(extra="forbid")

    acceleration: Samples = said("horizontal acceleration at uniform steps, in `unit`")
    second: Samples | None = said("other horizontal component; the pair counts as one record at all angles", None)
    vertical: Samples | None = said("vertical acceleration, upwards", None)
    time_step: float = said("time between samples", unit="s")
    unit: str = said("unit of the samples", "m/s2")
    name: str = said("name for the answer", "", max_length=200)

    def motion(self, number: int, order: int | None) -> Record | tuple[Record, Record]:
        """The record, or the pair, without a baseline of a degree."""
        name = self.name or f"record {number}"

        def record(samples: list[float], vertical: list[float] | None = None) -> Record:
            return Record(samples, self.time_step, self.unit, name, vertical=vertical).baseline_corrected(order=order)

        first = record(self.acceleration, self.vertical)
        return first if self.second is None else (first, record(self.second))


class HazardBody(BaseModel):
    """A hazard curve of PGA."""

    model_config = ConfigDict(extra="forbid")

    intensity: Levels = said("peak ground accelerations, ascending", unit="m/s2")
    annual_rate: Levels = said("annual rates of exceedance", unit="1/year")


class AssessBody(AssessParams):
    """Objects, a site, and its records and hazard curve, if it has any."""

    objects: list[dict[str, Any]] = said(
        "one a row, with the columns of `rocking_assessment.Object`", max_length=MAX_OBJECTS, exclude=True
    )
    records: list[SuiteRecordBody] = said("suite of records of the site", [], max_length=MAX_RECORDS, exclude=True)
    hazard: HazardBody | None = said("hazard curve of the site, with records", None, exclude=True)

    @model_validator(mode="before")
    @classmethod
    def _of_list(cls, value: Any) -> Any:
        """A list is one of objects, with the site in the query."""
        return {"objects": value} if isinstance(value, list) else value


def _column(name: str) -> Any:
    """Describe the field of a column of an assessment, by its declaration."""
    column = next(column for column in OUTPUTS if column.name == name)
    return said(column.meaning, unit=column.unit if column.unit != "bool" else "")


class AssessedRow(BaseModel):
    """One object in one direction; null: not known, of a factor: none of those tried up to `highest_factor`."""

    object: str = _column("object")
    direction: str = _column("direction")
    verdict: str = _column("verdict")
    uplifts: bool = _column("uplifts")
    uplift_acceleration: float | None = _column("uplift_acceleration")
    factor: float | None = _column("factor")
    governing: str = _column("governing")
    overturned_by: str = _column("overturned_by")
    overturned_at_full_strength: str = _column("overturned_at_full_strength")
    share: float | None = _column("share")
    share_at_full_strength: float | None = _column("share_at_full_strength")
    share_lower: float | None = _column("share_lower")
    share_upper: float | None = _column("share_upper")
    rotation: float | None = _column("rotation")
    displacement: float | None = _column("displacement")
    annual_rate: float | None = _column("annual_rate")
    annual_rate_lower: float | None = _column("annual_rate_lower")
    annual_rate_upper: float | None = _column("annual_rate_upper")
    friction_needed: float | None = _column("friction_needed")
    slides_first: bool | None = _column("slides_first")
    slides_under: str = _column("slides_under")
    slides_at: float | None = _column("slides_at")
    sliding: float | None = _column("sliding")
    smallest_width: float | None = _column("smallest_width")
    largest_height: float | None = _column("largest_height")
    factor_less_restitution: float | None = _column("factor_less_restitution")
    factor_more_restitution: float | None = _column("factor_more_restitution")
    factor_slenderer: float | None = _column("factor_slenderer")
    factor_stockier: float | None = _column("factor_stockier")
    sampled_share: float | None = _column("sampled_share")
    static_ratio: float | None = _column("static_ratio")
    ishiyama_ratio: float | None = _column("ishiyama_ratio")
    asce43_ratio: float | None = _column("asce43_ratio")
    circolare_linear_ratio: float | None = _column("circolare_linear_ratio")
    circolare_nonlinear_ratio: float | None = _column("circolare_nonlinear_ratio")
    circolare2019_nonlinear_ratio: float | None = _column("circolare2019_nonlinear_ratio")
    contact_tolerance: float | None = _column("contact_tolerance")
    warnings: str = _column("warnings")


class UnreadRow(BaseModel):
    """A row of the table that was not read."""

    row: int = said("number in the table, from 1", unit="-")
    columns: list[str] = said("the quantity of each reason; row: the whole row")
    reasons: list[str] = said("what was found and what is allowed")
    cells: dict[str, str | float] = said("the row as it stands, by the headers of the table", {})


class AssessResponse(Solved[AssessParams]):
    """Objects at a site, the worst first."""

    rows: list[AssessedRow] = said("one for each object and direction, the worst first")
    motions: list[str] = said("motions of the site; each acts from both sides")
    highest_factor: float = said("highest factor searched", unit="-")
    resolution: float = said(
        "largest relative distance between the factors tried on records, 0 without records", unit="-"
    )
    bad_rows: list[UnreadRow] = said("rows that were not read; the others are assessed")
    details: dict[str, list[str | float]] = said(
        "unchanged cells of the object of each row, by the headers of the table", {}
    )
    columns: dict[str, str] = said("canonical header of each column that was read, by header")
    skipped: list[str] = said("columns of the table that were not read; `details` has their cells")
    remarks: list[str] = said("where `columns` states another unit than the header of the table")
