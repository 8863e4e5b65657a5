"""Options that several commands share, declared once, and the decorator that gives them to a command.

The fields of the classes `GROUPS` and of those derived from them are the options. A command declares one argument of
that type; `with_options` replaces it in the signature that typer reads by the fields.
"""

from __future__ import annotations

import functools
import inspect
import math
import re
from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from typing import Annotated, Any, Literal, get_type_hints

import typer

import rocking._base.quantities as q
from rocking._base.quantity import Quantity
from rocking._dimensional.body_kinds import BODIES, signatures

_GROUPS = "In groups"
_UNITS = "With units"


def option(quantity: Quantity, *names: str, text: str = "", panel: str | None = None, **more: Any) -> Any:
    """The option of a quantity: its sentence, or a text, range and example in its help, its unit as metavar."""
    said = text or quantity.named
    ends = (quantity.lower > 0.0 or math.isfinite(quantity.upper)) and quantity.unit == "-"
    allowed = f", {quantity.interval}" if ends and not text else ""
    words = "".join(f", or {word}" for word in quantity.words)
    example = quantity.example if " " not in quantity.example else repr(quantity.example)
    such = f", such as {example}" if example else ""
    # a word in brackets would be taken for markup
    described = re.sub(r"\[(?=[a-z])", r"\\[", f"{said[0].upper()}{said[1:]}{allowed}{words}{such}.")
    return typer.Option(*names, help=described, rich_help_panel=panel, metavar=f"[{quantity.unit or 'TEXT'}]", **more)


def said(text: str, metavar: str, *names: str, **more: Any) -> Any:
    """An option of what is no quantity: a file, a name, a flag (without metavar)."""
    return typer.Option(*names, help=text, metavar=metavar and f"[{metavar}]", **more)


def _pulses(incomplete: str) -> list[str]:
    """Names of pulses, for the completion of the shell."""
    from rocking._excitation.pulses import pulse_names

    return [name for name in pulse_names() if name.startswith(incomplete)]


def _bodies(incomplete: str) -> list[str]:
    """Names of the kinds of bodies, for the completion of the shell."""
    return [name for name in BODIES if name.startswith(incomplete)]


BODY = (q.WIDTH, q.HEIGHT, q.OFFSET, q.MASS_HEIGHT, q.GYRATION, q.DIAMETER, q.LEFT, q.RIGHT, q.SIDES, q.REBOUND)
"""Parameters of bodies that are options of their own."""


@dataclass(frozen=True, kw_only=True)
class BodyOptions:
    """A body: its parameters, or a text."""

    width: Annotated[str | None, option(q.WIDTH, panel=_UNITS)] = None
    height: Annotated[str | None, option(q.HEIGHT, panel=_UNITS)] = None
    offset: Annotated[str | None, option(q.OFFSET, panel=_UNITS)] = None
    mass_height: Annotated[str | None, option(q.MASS_HEIGHT, panel=_UNITS)] = None
    gyration: Annotated[str | None, option(q.GYRATION, panel=_UNITS)] = None
    diameter: Annotated[str | None, option(q.DIAMETER, panel=_UNITS)] = None
    left: Annotated[str | None, option(q.LEFT, panel=_UNITS)] = None
    right: Annotated[str | None, option(q.RIGHT, panel=_UNITS)] = None
    sides: Annotated[str | None, option(q.SIDES, panel=_UNITS)] = None
    rebound: Annotated[str | None, option(q.REBOUND, panel=_UNITS)] = None
    body: Annotated[
        str | None,
        typer.Option(
            help=f"A body of any kind in place of these, such as 'hollow(width=40cm, height=1.6m, wall=2cm)': "
            f"{signatures().replace('[', '(').replace(']', ')')}; rigid ones also with sides and rebound.",
            rich_help_panel=_UNITS,
            metavar="[KIND]",
            autocompletion=_bodies,
        ),
    ] = None


Pulse = Annotated[
    str,
    typer.Option(
        help="Pulse, such as sine or 'mavroeidis_papageorgiou (cycles=3, phase=90deg)', or a file of samples: "
        "columns of numbers (accelerations, or times and accelerations) or JSON; a leading minus mirrors it.",
        metavar="[NAME|FILE]",
        autocompletion=_pulses,
    ),
]


@dataclass(frozen=True, kw_only=True)
class ShapeOptions(BodyOptions):
    """A pulse without amplitude and a block: its slenderness angle, or its size."""

    pulse: Pulse
    restitution: Annotated[str | None, option(q.RESTITUTION)] = None
    alpha: Annotated[str | None, option(q.ALPHA, panel=_GROUPS)] = None


@dataclass(frozen=True, kw_only=True)
class ProblemOptions(ShapeOptions):
    """A block under a pulse: in groups, or with units."""

    slenderness: Annotated[float | None, option(q.SLENDERNESS, panel=_GROUPS)] = None
    frequency_ratio: Annotated[float | None, option(q.FREQUENCY_RATIO, panel=_GROUPS)] = None
    peak_acceleration: Annotated[str | None, option(q.PEAK_ACCELERATION, panel=_UNITS)] = None
    period: Annotated[str | None, option(q.PERIOD, panel=_UNITS)] = None


@dataclass(frozen=True, kw_only=True)
class HistoryOptions(ProblemOptions):
    """The same, or a body that is released."""

    pulse: Pulse = ""
    start: Annotated[str | None, option(q.START, panel=_UNITS)] = None


@dataclass(frozen=True, kw_only=True)
class WindowOptions(ShapeOptions):
    """A block under pulses of all periods of a window."""

    frequency_ratio_min: Annotated[
        float | None, said("Lower end of omega_g/p; by default 0.5, of boundaries 0.2.", "-")
    ] = None
    frequency_ratio_max: Annotated[
        float | None, said("Upper end of omega_g/p; by default 12, of boundaries 15.", "-")
    ] = None
    period_min: Annotated[str | None, option(q.PERIOD, text="Shortest T_p", panel=_UNITS)] = None
    period_max: Annotated[str | None, option(q.PERIOD, text="Longest T_p", panel=_UNITS)] = None


@dataclass(frozen=True, kw_only=True)
class SpectrumOptions(WindowOptions):
    """The same with an amplitude."""

    slenderness: Annotated[float | None, option(q.SLENDERNESS, panel=_GROUPS)] = None
    peak_acceleration: Annotated[str | None, option(q.PEAK_ACCELERATION, panel=_UNITS)] = None


BaselineOrder = Annotated[
    int | None, said("Remove a baseline of this degree, 0 to 6; by default only the offset of K-NET counts.", "NUMBER")
]


_LAYOUT = "Layout of files of columns"


def _layout(text: str, metavar: str, *names: str) -> Any:
    """An option about the layout of a file."""
    return said(text, metavar, *names, rich_help_panel=_LAYOUT)


@dataclass(frozen=True, kw_only=True)
class ColumnOptions:
    """Layout of a file of columns: arguments of `read_record` of the same names."""

    time: Annotated[str | None, _layout("Column of the times: its name, or its number from 1.", "NAME|NUMBER")] = None
    time_unit: Annotated[str | None, _layout("Unit of these times: s, ms, us, min.", "UNIT")] = None
    time_step: Annotated[
        str | None, option(q.TIME_STEP, text="Time step, in place of a column of times", panel=_LAYOUT)
    ] = None
    unit: Annotated[str | None, _layout("Unit of the samples.", "UNIT")] = None
    skip: Annotated[int, _layout("Lines above the names of the columns, or above the rows.", "NUMBER")] = 0
    delimiter: Annotated[
        str | None,
        _layout("comma, semicolon, tab or blank; or the Fortran format of numbers of fixed width: 8f10.6.", "NAME"),
    ] = None
    decimal: Annotated[str, _layout("Decimal sign, a dot or a comma.", "SIGN")] = "."


@dataclass(frozen=True, kw_only=True)
class SeriesOptions(ColumnOptions):
    """Format and layout of files of records."""

    file_format: Annotated[
        str | None,
        _layout(
            "AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet, SAC, miniSEED, TSPAIR, SLIST, columns; by default the one whose "
            "signature the file has, else columns.",
            "NAME",
        ),
    ] = None
    acceleration: Annotated[
        str | None, _layout("Column or channel of the samples: its name, or its number from 1.", "NAME|NUMBER")
    ] = None
    wrapped: Annotated[bool, _layout("All values are one series, row by row.", "", "--wrapped")] = False
    allow_unusual: Annotated[
        bool, _layout("Accept a PGA above 5 g, a PGV above 10 m/s, a step above 0.1 s.", "", "--allow-unusual")
    ] = False

    def stated(self) -> dict[str, Any]:
        """The arguments of `read_record`, without that of a vertical component."""
        names = [field.name for field in fields(SeriesOptions) if field.name != "file_format"]
        return {"format": self.file_format, **{name: getattr(self, name) for name in names}}


@dataclass(frozen=True, kw_only=True)
class TraceOptions(ColumnOptions):
    """Layout of the trace of a rotation."""

    rotation: Annotated[
        str | None, _layout("Column of the rotations: its name, or its number from 1.", "NAME|NUMBER")
    ] = None


@dataclass(frozen=True, kw_only=True)
class FileOptions(SeriesOptions):
    """The same, and the vertical component."""

    vertical: Annotated[
        str | None, said("File of the vertical component, upwards, or its column or channel in the file.", "FILE|NAME")
    ] = None


@dataclass(frozen=True, kw_only=True)
class RecordOptions(FileOptions, BodyOptions):
    """A block, and a record."""

    restitution: Annotated[str, option(q.RESTITUTION)] = "momentum"
    scale: Annotated[float, option(q.SCALE)] = 1.0
    baseline_order: BaselineOrder = None


@dataclass(frozen=True)
class OutputOptions:
    """Format of the output."""

    format: Annotated[
        Literal["table", "csv", "json"],
        typer.Option(
            help="table: for people; csv: for spreadsheets, in the same units; json: for programs, in SI units."
        ),
    ] = "table"
    all: Annotated[bool, said("Show all values; CSV and JSON always have them.", "", "--all")] = False


@dataclass(frozen=True)
class PictureOptions:
    """Where a picture goes."""

    output: Annotated[
        str | None, said("File to write, .png or .svg; by default a window opens.", "FILE", "--output", "-o")
    ] = None


GROUPS = (BodyOptions, ColumnOptions, OutputOptions, PictureOptions)  # types of arguments whose fields are options

Duration = Annotated[
    str | None, said("Length: a number tau = p t, or a time such as 3s for a block with units.", "-|s")
]


def with_options(command: Callable[..., None]) -> Callable[..., None]:
    """A command whose arguments of the above types are options of the command line, one for each field."""
    hints = get_type_hints(command, include_extras=True)
    parameters: list[inspect.Parameter] = []
    groups: dict[str, type[Any]] = {}
    for parameter in inspect.signature(command).parameters.values():
        hint = hints[parameter.name]
        if not (isinstance(hint, type) and issubclass(hint, GROUPS)):
            parameters.append(parameter.replace(annotation=hint, kind=parameter.KEYWORD_ONLY))
            continue
        groups[parameter.name] = hint
        types = get_type_hints(hint, include_extras=True)
        for field in fields(hint):
            default = inspect.Parameter.empty if field.default is MISSING else field.default
            parameters.append(
                inspect.Parameter(
                    field.name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=types[field.name]
                )
            )

    @functools.wraps(command)
    def run(**values: Any) -> None:
        given = {
            name: kind(**{field.name: values.pop(field.name) for field in fields(kind)})
            for name, kind in groups.items()
        }
        command(**given, **values)

    run.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run
