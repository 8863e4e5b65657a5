"""Objects at a site: parameters and response, from the declared columns of an assessment."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, create_model, field_validator, model_validator
from rocking_api.models.answer import Solved
from rocking_api.models.params import Params
from rocking_api.models.quantity import BaselineOrder, TableFormat, between, read_as, said

from rocking.extension import (
    PERIOD,
    PGA,
    PGV,
    RESOLUTION,
    RESOLUTIONS,
    InvalidArgumentError,
    Quantity,
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


class AssessParams(Params):
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

    def site(self, given: AssessBody | None) -> Site:
        """The site, with the records and the hazard curve of a body."""
        ends = self.period_min, self.period_max
        motions = enumerate(() if given is None else given.records, start=1)
        hazard = None if given is None else given.hazard
        return Site(
            self.pga,
            self.pgv,
            None if ends == (None, None) else ends,  # one of them alone is refused there
            [one.motion(k, self.baseline_order) for k, one in motions],
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


def _parts(name: str, text: str, most: int, what: str) -> list[str]:
    """The parts of a text that commas separate, at most so many; those within brackets separate none."""
    parts = split_pulses(text)
    if len(parts) > most:
        raise InvalidArgumentError(name, f"{len(parts)} {what}", f"at most {most} {what}")
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


def _field(column: Quantity) -> Any:
    kinds: dict[str, Any] = {"": str, "bool": bool}
    unit = column.unit if column.unit != "bool" else ""
    optional = column.name != "uplifts" and column.unit != ""
    kind = kinds.get(column.unit, float)
    return (kind | None if optional else kind), said(column.meaning, unit=unit)


AssessedRow: type[BaseModel] = create_model(
    "AssessedRow",
    __doc__="One object in one direction; null: not known, of a factor: none of those tried up to `highest_factor`.",
    **{column.name: _field(column) for column in OUTPUTS},
)


class UnreadRow(BaseModel):
    """A row of the table that was not read."""

    row: int = said("number in the table, from 1", unit="-")
    column: str = said("name of the column; empty: the whole row")
    reason: str = said("what was found and what is allowed")


class AssessResponse(Solved[AssessParams]):
    """Objects at a site, the worst first."""

    rows: list[AssessedRow] = said("one for each object and direction, the worst first")  # type: ignore[valid-type]
    motions: list[str] = said("motions of the site; each acts from both sides")
    highest_factor: float = said("highest factor searched", unit="-")
    resolution: float = said(
        "largest relative distance between the factors tried on records, 0 without records", unit="-"
    )
    bad_rows: list[UnreadRow] = said("rows that were not read; the others are assessed")
    details: dict[str, list[str]] = said("unchanged cells of the object of each row, by the headers of the table", {})
    columns: dict[str, str] = said("meaning of the columns that were read, by header")
    skipped: list[str] = said("columns of the table that were not read; `details` has their cells")
    totals: list[str] = said("rows of totals of the table, which are no objects, with their first cells")
