"""Options that several commands share, declared once, and the decorator that gives them to a command.

The fields of the classes `GROUPS` and of those derived from them are the options. A command declares one argument of
that type; `with_options` replaces it in the signature that typer reads by the fields.
"""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from typing import Annotated, Any, Literal, get_type_hints

import typer

from rocking._base.quantities import ALPHA, FREQUENCY_RATIO, RESTITUTION, SLENDERNESS

_GROUPS = "In groups"
_UNITS = "With units"


def _in_groups(text: str, unit: str = "-") -> Any:
    # a word in brackets would be taken for markup
    return typer.Option(help=re.sub(r"\[(?=[a-z])", r"\\[", text), rich_help_panel=_GROUPS, metavar=f"[{unit}]")


def _pulses(incomplete: str) -> list[str]:
    """Names of pulses, for the completion of the shell."""
    from rocking._excitation.pulses import pulse_names

    return [name for name in pulse_names() if name.startswith(incomplete)]


def _with_units(text: str, unit: str) -> Any:
    return typer.Option(help=text, rich_help_panel=_UNITS, metavar=f"[{unit}]")


@dataclass(frozen=True, kw_only=True)
class SizeOptions:
    """The size of a block."""

    width: Annotated[str | None, _with_units("Width 2b, such as 0.4m.", "m")] = None
    height: Annotated[str | None, _with_units("Height 2h, such as '160 cm'.", "m")] = None


@dataclass(frozen=True)
class MassOptions:
    """The place of the centre of mass, where it is not that of the block."""

    offset: Annotated[
        str | None,
        _with_units("Distance of the centre of mass from the middle of the width, positive to the right.", "m"),
    ] = None
    mass_height: Annotated[
        str | None, _with_units("Height of the centre of mass; half the height by default.", "m")
    ] = None


@dataclass(frozen=True, kw_only=True)
class ShapeOptions(SizeOptions):
    """A pulse without amplitude and a block: its slenderness angle, or its size."""

    pulse: Annotated[
        str,
        typer.Option(
            help="Pulse, such as sine or 'mavroeidis_papageorgiou(cycles=3, phase=90deg)', or a file of samples: "
            "columns of numbers (accelerations, or times and accelerations) or JSON; a leading minus mirrors it.",
            metavar="[NAME|FILE]",
            autocompletion=_pulses,
        ),
    ]
    restitution: Annotated[
        str | None,
        typer.Option(
            help=f"{RESTITUTION.help}, {RESTITUTION.interval}; momentum for a block with units (its default): (2.4), 0 "
            "where negative.",
            metavar="[-]",
        ),
    ] = None
    alpha: Annotated[str | None, _in_groups(f"{ALPHA.help}, such as '20 deg'.", "rad")] = None


@dataclass(frozen=True, kw_only=True)
class ProblemOptions(ShapeOptions):
    """A block under a pulse: in groups, or with units."""

    slenderness: Annotated[float | None, _in_groups(f"{SLENDERNESS.help}.")] = None
    frequency_ratio: Annotated[float | None, _in_groups(f"{FREQUENCY_RATIO.help}.")] = None
    peak_acceleration: Annotated[str | None, _with_units("a_g, such as '4 m/s^2', 0.4g or '400 gal'.", "m/s2")] = None
    period: Annotated[
        str | None,
        _with_units("T_p = 2 pi/omega_g, such as 0.5s; a half sine or rectangular pulse lasts half of it.", "s"),
    ] = None


@dataclass(frozen=True, kw_only=True)
class WindowOptions(ShapeOptions):
    """A block under pulses of all periods of a window."""

    period_min: Annotated[str | None, _with_units("Shortest T_p, such as 0.1s.", "s")] = None
    period_max: Annotated[str | None, _with_units("Longest T_p, such as 2s.", "s")] = None


@dataclass(frozen=True, kw_only=True)
class SpectrumOptions(WindowOptions):
    """The same with an amplitude."""

    slenderness: Annotated[float | None, _in_groups(f"{SLENDERNESS.help}.")] = None
    peak_acceleration: Annotated[str | None, _with_units("a_g, such as '4 m/s^2', 0.4g or '400 gal'.", "m/s2")] = None


Component = Annotated[
    str | None,
    typer.Option(
        help="Column or trace of a file with several; rows for one series along the rows of several columns.",
        metavar="[NAME]",
    ),
]
Skip = Annotated[
    int | None,
    typer.Option(
        help="Rows of numbers above the samples of a file of columns, such as a count or a factor.", metavar="[NUMBER]"
    ),
]
BaselineOrder = Annotated[
    int | None,
    typer.Option(
        help="Remove a baseline of this degree, 0 to 6, from the acceleration; none by default, but for the offset of "
        "K-NET counts.",
        metavar="[NUMBER]",
    ),
]


@dataclass(frozen=True, kw_only=True)
class FileOptions:
    """What the file of a record does not state: arguments of `read_record`."""

    unit: Annotated[
        str | None,
        typer.Option(help="Unit of the samples if the file states none: g, m/s2, cm/s2, gal, mm/s2.", metavar="[UNIT]"),
    ] = None
    time_step: Annotated[
        str | None, typer.Option(help="Time step if the file states none, such as 0.01s.", metavar="[s]")
    ] = None
    component: Component = None
    vertical: Annotated[
        str | None,
        typer.Option(
            help="File of the vertical component, upwards, or its column or trace in the file.", metavar="[FILE|NAME]"
        ),
    ] = None
    skip: Skip = None


@dataclass(frozen=True, kw_only=True)
class RecordOptions(FileOptions, SizeOptions):
    """A block, and a record."""

    restitution: Annotated[
        str, typer.Option(help=f"{RESTITUTION.help}, {RESTITUTION.interval}, or momentum: (2.4).", metavar="[-]")
    ] = "momentum"
    scale: Annotated[
        float, typer.Option(help="Factor of the record, of its vertical component too.", metavar="[-]")
    ] = 1.0
    baseline_order: BaselineOrder = None


@dataclass(frozen=True)
class OutputOptions:
    """Format of the output."""

    format: Annotated[
        Literal["table", "csv", "json"],
        typer.Option(help="For people; for spreadsheets, in the same units; for programs, in SI units."),
    ] = "table"
    all: Annotated[
        bool, typer.Option("--all", help="All values in the table; CSV and JSON always have them.", metavar="")
    ] = False


@dataclass(frozen=True)
class PictureOptions:
    """Where a picture goes."""

    output: Annotated[
        str | None,
        typer.Option(
            "--output", "-o", help="File to write, .png or .svg; by default a window opens.", metavar="[FILE]"
        ),
    ] = None


GROUPS = (SizeOptions, FileOptions, MassOptions, OutputOptions, PictureOptions)
"""Types of arguments whose fields are options."""

FrequencyRatioMin = Annotated[float, typer.Option(help="Lower end of omega_g/p.", metavar="[-]")]
FrequencyRatioMax = Annotated[float, typer.Option(help="Upper end of omega_g/p.", metavar="[-]")]
Duration = Annotated[
    str | None,
    typer.Option(help="Length: a number tau = p t, or a time such as 3s for a block with units.", metavar="[-|s]"),
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
