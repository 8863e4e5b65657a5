"""A block in metres under a record in the body: parameters and responses."""

from __future__ import annotations

import math
from typing import Any
from urllib.parse import quote

from pydantic import BaseModel

from rocking_api.models.answer import BY_SOLVER, Answer, InUnits, Q
from rocking_api.models.blocks import ScaleThreshold
from rocking_api.models.body_params import BodyParams, JsonBody
from rocking_api.models.fields import Ended, InUnitsOfOne, ManySolved, OfBlock, Peaked, UnderRecord
from rocking_api.models.params import Params
from rocking_api.models.quantity import (
    SCALES,
    BaselineOrder,
    Column,
    Contact,
    Decimal,
    Delimiter,
    Format,
    Mass,
    RecordFormat,
    Scale,
    Skip,
    TimeStep,
    TimeUnit,
    Unit,
    between,
    said,
)
from rocking_api.models.responses import ContactResponse, Motion
from rocking_api.models.suites import SuiteRecord

MAX_SCALES = 2000  # most factors of a curve over the scale [-]
MAX_DRAWN = 100_000  # most samples of a drawing [-]

CAUTION = (
    "A fitted pulse describes a record and does not replace it: what it leaves out moves blocks as well, so that the "
    "amplitude at which it overturns a block is usually larger than that of the record, which is unconservative."
)


class RecordLayoutParams(Params):
    """Format and layout of the file of a record."""

    name: str = said("name of the file, for messages", "record", max_length=200)
    file_format: RecordFormat = None
    acceleration: Column = said("column or channel of the samples: its name, or its number from 1", None)
    time: Column = said("column of the times: its name, or its number from 1", None)
    time_step: TimeStep = None
    time_unit: TimeUnit = None
    unit: Unit = None
    skip: Skip = 0
    delimiter: Delimiter = None
    decimal: Decimal = "."
    wrapped: bool = said("all values are one series, row by row", False)
    vertical: Column = said("column or channel of the vertical component, upwards", None)
    allow_unusual: bool = said("accept a PGA above 5 g, a PGV above 10 m/s, a step above 0.1 s", False)
    baseline_order: BaselineOrder = None
    mirrored: bool = said("the record with the other sign", False)


class RecordPreviewParams(RecordLayoutParams):
    """The same, and the samples for a drawing."""

    samples: int = between(2, MAX_DRAWN, "most samples of the drawing", default=2000, unit="-")


class RecordFileParams(RecordLayoutParams, BodyParams):
    """A body in SI units, and the format and layout of the file of the record."""


class RecordParams(RecordFileParams):
    """The same, and a factor of the record, of both components."""

    scale: Scale = 1.0


class RecordResponseParams(RecordParams):
    """The same, and whether to search thresholds and to fit a pulse."""

    thresholds: bool = said("find all factors at which the outcome changes; this takes most of the time", True)
    fit: bool = said("fit a pulse and compare when both overturn the block", False)


class RecordHistoryParams(RecordParams):
    """The same, and which samples are wanted."""

    samples: int | None = between(2, math.inf, "uniform samples; absent: those of the record", default=None, unit="-")
    contact: Contact = False
    mass: Mass = None
    format: Format = None


class RecordScalesParams(RecordFileParams):
    """The same, and the window of the factor."""

    scale_min: float | None = between(*SCALES, "smallest factor; absent: that of uplift", default=None, unit="-")
    scale_max: float | None = between(
        *SCALES, "largest factor; absent: ten times that of uplift", default=None, unit="-"
    )
    points: int = between(2, MAX_SCALES, "factors, evenly spaced in their logarithm", default=200, unit="-")
    format: Format = None


class RecordPulseParams(RecordParams):
    """The same, and the samples for a drawing."""

    samples: int = between(2, MAX_DRAWN, "most samples of the drawing", default=2000, unit="-")


def as_parameter(name: str, value: Any) -> str:
    """An argument of `read_record` as a parameter of the query."""
    name = "file_format" if name == "format" else name
    if value is None:
        return f"`{name}`"
    return f"{name}={'...' if value is ... else str(value).lower() if value is True else quote(str(value))}"


class RecordText(Params):
    """What a JSON body with a record has beside the parameters of its route."""

    record: str = said("text of the file", exclude=True)
    vertical_record: str | None = said(
        "text of the file of the vertical component, upwards, in the same layout", None, exclude=True
    )


class RecordPreviewBody(RecordText, RecordPreviewParams):
    """The record, and the parameters of /v1/records/preview."""


class BlockRecordText(RecordText):
    """The same, and a body."""

    body: JsonBody  # a text once it is read


class RecordResponseBody(BlockRecordText, RecordResponseParams):
    """The record, and the parameters of /v1/records/response."""


class RecordHistoryBody(BlockRecordText, RecordHistoryParams):
    """The record, and the parameters of /v1/records/history."""


class RecordScalesBody(BlockRecordText, RecordScalesParams):
    """The record, and the parameters of /v1/records/scales."""


class RecordPulseBody(BlockRecordText, RecordPulseParams):
    """The record, and the parameters of /v1/records/pulse."""


class RecordDescription(SuiteRecord):
    """The record, as read; SI units."""

    source: str = said("file, format, and what was done to the record")
    remarks: list[str] = said("warnings of the reader of the file")
    samples: int = said("number of samples", unit="-")
    peak_vertical_acceleration: float | None = said("largest vertical acceleration; null: there is none", unit="m/s2")
    peak_displacement: float = said("PGD", unit="m")
    arias_intensity: float = said("Arias intensity", unit="m/s")
    significant_duration: float = said("between 5 % and 95 % of the Arias intensity", unit="s")
    final_velocity: float = said("velocity at the last sample; large if the acceleration has an offset", unit="m/s")


class RecordLine(BaseModel):
    """A line of a file."""

    number: int = said("its number, from 1", unit="-")
    text: str = said("its first 200 characters")
    cells: list[str] = said("its cells, if it is a line of names or of numbers")


class RecordColumns(BaseModel):
    """What is read from a file of columns."""

    acceleration: int | None = said("column of the samples, from 1; null: not stated", unit="-")
    unit: str | None = said("unit of the samples; null: not stated")
    time: int | None = said("column of the times, from 1; null: not stated", unit="-")
    time_unit: str | None = said("unit of the times; null: not stated")


class RecordProblem(BaseModel):
    """Why a file is not read, or what is asked about it. Arguments of `read_record` are between backticks."""

    line: int | None = said("number of the line; null: the whole file", unit="-")
    was: str = said("what is there")
    expected: str = said("what should be there")


class RecordPreviewResponse(Answer[RecordPreviewParams]):
    """What a file holds, and the record that would be read. Nothing is solved."""

    file_format: RecordFormat = said("format in which it is read; null: a format that is not read", None)
    encoding: str | None = said("encoding of the text; null: binary")
    lines: list[RecordLine] = said("the first lines, and those around the first row")
    columns: list[str] = said("names of the columns or channels, empty for one without a name")
    names_line: int | None = said("number of the line with the names of the columns; null: there is none", unit="-")
    in_file: RecordColumns = said("what the header states by itself")
    chosen: RecordColumns = said("what is read, with the parameters")
    missing: list[str] = said("parameters that are missing")
    problem: RecordProblem | None = said("why no record is read, or what is asked about it; null: nothing")
    record: RecordDescription | None = said("the record; null: it cannot be read")
    time: list[float] = said("of the drawing: from the first sample", unit="s")
    acceleration: list[float] = said(
        "of the drawing: all samples, or the least and the largest of every few samples", unit="m/s2"
    )


class RecordAnswer(InUnits[Q]):
    """Base of the models of what is found under a record."""

    record: RecordDescription = said("the record, as read")
    source: str = BY_SOLVER


class FittedPulse(BaseModel):
    """A pulse fitted to the velocity of the record: a description, not a substitute."""

    pulse: str = said("kind of pulse")
    period: float = said("T_p", unit="s")
    peak_acceleration: float = said("a_g", unit="m/s2")
    centre: float = said("time of its centre from the first sample", unit="s")
    cycles: float | None = said("gamma of Mavroeidis & Papageorgiou; null for others", unit="-")
    phase: float | None = said("nu of Mavroeidis & Papageorgiou; null for others", unit="rad")
    explained: float = said("share of the sum of squares of the velocity that the pulse explains", unit="-")
    scale_ratio: float | None = said(
        "lowest scale at which the pulse overturns the block over that of the record; above 1: unconservative; "
        "null: one of them does not overturn it",
        unit="-",
    )


_SCALES = said("all scales at which the outcome changes, ascending; null: not asked for, or not found in time")


class RecordResponse(UnderRecord, OfBlock, RecordAnswer[RecordResponseParams]):
    """Response of the block; the fields mean the same as those of /v1/blocks/response."""

    thresholds: list[ScaleThreshold] | None = _SCALES
    pulse: FittedPulse | None = said("null unless requested", None)


class RecordBodyResponse(UnderRecord, InUnitsOfOne, RecordAnswer[RecordResponseParams]):
    """What happens to a body whose centre of mass is not that of the block."""

    thresholds: list[ScaleThreshold] | None = _SCALES


class RecordHistoryResponse(Motion, Peaked, RecordAnswer[RecordHistoryParams]):
    """A motion under a record."""

    time: list[float] = said("from the first sample", unit="s")
    impact_time: list[float] = said("times of the impacts", unit="s")
    vertical_acceleration: list[float] | None = said(
        "of the ground over g, upwards; null: there is none", None, unit="-"
    )


class RecordBodyHistoryResponse(Ended, RecordAnswer[RecordHistoryParams]):
    """Motion under a record of a body whose edges differ from those of a block, in SI units."""

    time: list[float] = said("from the first sample", unit="s")
    impact_time: list[float] = said("times of the impacts", unit="s")
    rotation: list[float] = said("theta, positive about the right edge", unit="rad")
    angular_velocity: list[float] = said("theta'", unit="rad/s")
    edge: list[int] = said("edge in contact: 1 right, -1 left, 0 both", unit="-")
    ground_acceleration: list[float] = said("horizontal", unit="m/s2")
    vertical_acceleration: list[float] = said("upwards", unit="m/s2")
    displacement: list[float] = said("horizontal displacement of the top", unit="m")
    contact: ContactResponse | None = said("null unless requested", None)


class RecordScalesResponse(ManySolved, RecordAnswer[RecordScalesParams]):
    """The response over the scale of a record, and every scale at which the outcome changes."""

    scale: list[float] = said("factors of the record", unit="-")
    peak_acceleration: list[float] = said("PGA of the scaled record", unit="m/s2")
    thresholds: list[ScaleThreshold] = said(
        "scales at which the outcome changes, ascending, from that of uplift to the largest: of factors at most "
        "0.5 % apart up to the lowest, 0.2 % above it"
    )


class RecordPulseResponse(RecordAnswer[RecordPulseParams]):
    """The pulse fitted to the velocity of a record, and both motions for a drawing."""

    pulse: FittedPulse = said("parameters of the pulse")
    time: list[float] = said("from the first sample; every few samples of a long record", unit="s")
    record_acceleration: list[float] = said("of the record, factor included", unit="m/s2")
    pulse_acceleration: list[float] = said("of the pulse, factor included", unit="m/s2")
    record_velocity: list[float] = said("of the record, factor included", unit="m/s")
    pulse_velocity: list[float] = said("of the pulse, factor included", unit="m/s")
    caution: str = said("why the pulse does not replace the record", CAUTION)
