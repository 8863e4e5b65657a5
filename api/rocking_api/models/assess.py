"""Objects at a site: parameters and response, from the declared columns of an assessment."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import BaseModel, ConfigDict, Field, SerializeAsAny, create_model

from rocking._assessment.columns import OUTPUTS
from rocking._assessment.site import LENGTH, STRENGTHS, Site
from rocking._assessment.standards import checked_clauses
from rocking._base.errors import InvalidArgumentError, plain_numbers
from rocking._base.quantity import Quantity
from rocking._boundary.scan import RESOLUTION, RESOLUTIONS
from rocking._excitation.pulses import as_pulse, split_pulses
from rocking._excitation.records.record import Record
from rocking_api.models.answer import ECHO, QUERY, Answer
from rocking_api.models.metadata import METADATA_URL_FIELD
from rocking_api.models.params import Params, TableFormat
from rocking_api.models.records import BaselineOrder
from rocking_api.models.responses import BY_SOLVER

MAX_OBJECTS = 2000
"""Most rows of a table [-]."""

MAX_RECORDS = 100
"""Most records of a site [-]."""

MAX_SAMPLES = 20_000
"""Most variants of an object [-]."""

MAX_MODES = 20
"""Most modes of a building [-]."""

MAX_SHAPES = 50
"""Most pulse shapes of a site [-]."""

MAX_LEVELS = 1000
"""Most levels of a hazard curve [-]."""

MAX_RECORD = 1_000_000
"""Most samples of a component of a record [-]."""

Samples = Annotated[list[float], Field(max_length=MAX_RECORD, fail_fast=True)]
Levels = Annotated[list[float], Field(max_length=MAX_LEVELS, fail_fast=True)]

_STRENGTH: dict[str, Any] = {"minimum": STRENGTHS[0], "maximum": STRENGTHS[1]}
_LENGTH: dict[str, Any] = {"minimum": LENGTH[0], "maximum": LENGTH[1]}


class AssessParams(Params):
    """A site, by PGA and PGV, by PGA and a range of periods, or by records in the body."""

    pga: float | None = Field(
        None,
        description="peak ground acceleration [m/s2], required without records, which are scaled to it",
        examples=[3.0],
        json_schema_extra=_STRENGTH,
    )
    pgv: float | None = Field(
        None,
        description="peak ground velocity, from which each pulse has its period [m/s]; either this or periods",
        examples=[0.3],
        json_schema_extra=_STRENGTH,
    )
    period_min: float | None = Field(
        None, description="shortest period of the pulses, with `period_max` [s]", json_schema_extra=_LENGTH
    )
    period_max: float | None = Field(
        None, description="longest period of the pulses, with `period_min` [s]", json_schema_extra=_LENGTH
    )
    shapes: str | None = Field(
        None,
        description="pulses, separated by commas; absent: all that leave the ground at rest",
        examples=["sine,ricker"],
    )
    moving_ground: bool = Field(False, description="also half sine and rectangular, which leave the ground moving")
    floor_periods: str | None = Field(
        None, description="periods of a building of which the objects are on a floor [s], separated by commas"
    )
    floor_damping: str = Field("0.05", description="damping ratios of these modes [-], one or one for each")
    floor_participation: str = Field(
        "1", description="participation factors times mode shapes at the floor [-], one or one for each"
    )
    baseline_order: BaselineOrder = None
    samples: int = Field(
        0,
        description="variants of each object within its tolerance and 0.05 of the restitution that are tried [-]",
        json_schema_extra={"minimum": 0, "maximum": MAX_SAMPLES},
    )
    seed: int = Field(0, description="seed of these variants [-]", json_schema_extra={"minimum": 0, "maximum": 2**53})
    resolution: float = Field(
        RESOLUTION,
        description="largest relative distance of the factors on a record that are tried [-]",
        json_schema_extra={"minimum": RESOLUTIONS[0], "maximum": RESOLUTIONS[1]},
    )
    sensitivity: bool = Field(True, description="find the factors of changed objects, and sizes not overturned")
    standards: str = Field(
        "",
        description="checks by standards to state beside the outcome, separated by commas, or all",
        examples=["static,asce43"],
    )
    format: TableFormat = None

    @classmethod
    def check_field(cls, name: str, value: Any) -> None:
        super().check_field(name, value)
        if name == "standards":
            checked_clauses(value)
        elif name.startswith("floor_") and value is not None:
            modes_of(name, str(value))  # a query with an error elsewhere has its numbers read
        elif name == "shapes" and value is not None:
            for shape in _parts(name, value, MAX_SHAPES, "shapes"):
                as_pulse(shape)

    def site(self, given: AssessBody | None) -> Site:
        """The site, with the records and the hazard curve of a body.

        Raises
        ------
        InvalidArgumentError
            If the parameters do not go together.
        """
        periods: Any = (
            None if self.period_min is None and self.period_max is None else (self.period_min, self.period_max)
        )
        return Site(
            self.pga,
            self.pgv,
            periods,
            []
            if given is None
            else [one.motion(k, self.baseline_order) for k, one in enumerate(given.records, start=1)],
            None if given is None or given.hazard is None else (given.hazard.intensity, given.hazard.annual_rate),
            None if self.shapes is None else split_pulses(self.shapes),
            self.moving_ground,
            None if self.floor_periods is None else modes_of("floor_periods", self.floor_periods),
            modes_of("floor_damping", self.floor_damping),
            modes_of("floor_participation", self.floor_participation),
        )


def modes_of(name: str, text: str) -> list[float]:
    """The numbers of the modes of a building, separated by commas.

    Raises
    ------
    InvalidArgumentError
        If the text holds anything else, or more than `MAX_MODES`.
    """
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

    acceleration: Samples = Field(description="horizontal acceleration at uniform steps, in `unit`")
    second: Samples | None = Field(
        None, description="other horizontal component: the pair is assessed at all angles and counts as one record"
    )
    vertical: Samples | None = Field(None, description="vertical acceleration, upwards")
    time_step: float = Field(description="time between samples [s]")
    unit: str = Field("m/s2", description="unit of the samples")
    name: str = Field("", description="name for the answer", max_length=40)

    def motion(self, number: int, order: int | None) -> Record | tuple[Record, Record]:
        """The record, or the pair, without a baseline of a degree."""
        name = self.name or f"record {number}"

        def record(samples: list[float], vertical: list[float] | None = None) -> Record:
            found = Record(samples, self.time_step, self.unit, name, vertical=vertical)
            return found if order is None else found.baseline_corrected(order=order)

        first = record(self.acceleration, self.vertical)
        return first if self.second is None else (first, record(self.second))


class HazardBody(BaseModel):
    """A hazard curve of PGA."""

    model_config = ConfigDict(extra="forbid")

    intensity: Levels = Field(description="peak ground accelerations, ascending [m/s2]")
    annual_rate: Levels = Field(description="annual rates of exceedance [1/year]")


class AssessBody(AssessParams):
    """Objects, a site, and its records and hazard curve, if it has any."""

    takes_lists: ClassVar = True

    objects: list[dict[str, Any]] = Field(
        description="one object for each row, with the columns of `rocking.Object`", max_length=MAX_OBJECTS
    )
    records: list[SuiteRecordBody] = Field([], description="suite of records of the site", max_length=MAX_RECORDS)
    hazard: HazardBody | None = Field(None, description="hazard curve of the site, with records")


def _field(column: Quantity) -> Any:
    kinds: dict[str, Any] = {"": str, "bool": bool}
    unit = f" [{column.unit}]" if column.unit not in ("", "bool") else ""
    optional = column.name != "uplifts" and column.unit != ""
    kind = kinds.get(column.unit, float)
    return (kind | None if optional else kind), Field(description=f"{column.meaning}{unit}")


AssessedRow: type[BaseModel] = create_model(
    "AssessedRow",
    __doc__="One object in one direction; null: not known, of a factor: none of those tried up to `highest_factor`.",
    **{column.name: _field(column) for column in OUTPUTS},
)


class UnreadRow(BaseModel):
    """A row of the table that was not read."""

    row: int = Field(description="number in the table, from 1 [-]")
    column: str = Field(description="name of the column; empty: the whole row")
    reason: str = Field(description="what was found and what is allowed")


class AssessResponse(Answer):
    """Objects at a site, the worst first."""

    query: Annotated[SerializeAsAny[AssessParams], ECHO] = QUERY
    rows: list[AssessedRow] = Field(description="one for each object and direction, the worst first")  # type: ignore[valid-type]
    motions: list[str] = Field(description="motions of the site; from both sides each")
    highest_factor: float = Field(description="highest factor on the motions that was searched [-]")
    resolution: float = Field(
        description="largest relative distance of the factors on records that were tried, 0 without records [-]"
    )
    bad_rows: list[UnreadRow] = Field(description="rows that were not read; the others are assessed")
    details: dict[str, list[str]] = Field(
        {}, description="cells of the object of each row as they stand, by the headers of the table"
    )
    columns: dict[str, str] = Field(description="what columns of the table were read as, by their headers")
    skipped: list[str] = Field(description="columns of the table that were not read; `details` has their cells")
    source: str = BY_SOLVER
    metadata_url: str = METADATA_URL_FIELD
