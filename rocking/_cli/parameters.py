"""Types of the parameters that several commands share."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

import rocking._base.quantities as q
from rocking._dimensional.body_kinds import BODIES, signatures

BODY = "Body"
MOTION = "Motion"
LAYOUT = "Layout of files of columns"
TABLE = "Layout of a table"


def _pulse_names(incomplete: str) -> list[str]:
    """Return the names of pulses, for the completion of the shell."""
    from rocking._excitation.pulses import pulse_names

    return [name for name in pulse_names() if name.startswith(incomplete)]


def _body_names(incomplete: str) -> list[str]:
    """Return the names of the kinds of bodies, for the completion of the shell."""
    return [name for name in BODIES if name.startswith(incomplete)]


OutputFormat = Annotated[
    Literal["table", "csv", "json"],
    typer.Option("--format", help="table: for people; csv: for spreadsheets; json: for programs. All in SI units."),
]

# Bodies

Width = Annotated[str | None, typer.Option(help=q.WIDTH.sentence, metavar="[m]", rich_help_panel=BODY)]

Height = Annotated[str | None, typer.Option(help=q.HEIGHT.sentence, metavar="[m]", rich_help_panel=BODY)]

Body = Annotated[
    str | None,
    typer.Option(
        help="A body of any kind in place of width and height, such as 'hollow(width=40cm, height=1.6m, wall=2cm)': "
        f"{signatures().replace('[', '(').replace(']', ')')}; rigid ones also with sides and rebound.",
        metavar="[KIND]",
        rich_help_panel=BODY,
        autocompletion=_body_names,
    ),
]

Restitution = Annotated[str, typer.Option(help=q.RESTITUTION.sentence, metavar="[-]", rich_help_panel=BODY)]

# Pulses

Pulse = Annotated[
    str,
    typer.Option(
        help="Pulse, such as sine or 'mavroeidis_papageorgiou (cycles=3, phase=90deg)', or a file of samples: "
        "columns of numbers (accelerations, or times and accelerations) or JSON; a leading minus mirrors it.",
        metavar="[NAME|FILE]",
        rich_help_panel=MOTION,
        autocompletion=_pulse_names,
    ),
]

PeakAcceleration = Annotated[
    str | None, typer.Option(help=q.PEAK_ACCELERATION.sentence, metavar="[m/s2]", rich_help_panel=MOTION)
]

Period = Annotated[str | None, typer.Option(help=q.PERIOD.sentence, metavar="[s]", rich_help_panel=MOTION)]

PeriodMin = Annotated[str | None, typer.Option(help="Shortest period T_p.", metavar="[s]", rich_help_panel=MOTION)]

PeriodMax = Annotated[str | None, typer.Option(help="Longest period T_p.", metavar="[s]", rich_help_panel=MOTION)]

# Records

RecordFile = Annotated[
    str,
    typer.Argument(
        help="Accelerogram: AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet, SAC, miniSEED, TSPAIR, SLIST, or columns whose "
        "layout is stated.",
        metavar="FILE",
    ),
]

Scale = Annotated[float, typer.Option(help=q.SCALE.sentence, metavar="[-]", rich_help_panel=MOTION)]

BaselineOrder = Annotated[
    int | None,
    typer.Option(
        help="Remove a baseline of this degree, 0 to 6; by default only the offset of K-NET counts.",
        metavar="[NUMBER]",
        rich_help_panel=MOTION,
    ),
]

# Layout of files of columns: arguments of `read_record` of the same names

FileFormat = Annotated[
    str | None,
    typer.Option(
        help="AT2, ESM, K-NET, COSMOS, CSMIP, GeoNet, SAC, miniSEED, TSPAIR, SLIST, columns; by default the one whose "
        "signature the file has, else columns.",
        metavar="[NAME]",
        rich_help_panel=LAYOUT,
    ),
]

Acceleration = Annotated[
    str | None,
    typer.Option(
        help="Column or channel of the samples: its name, or its number from 1.",
        metavar="[NAME|NUMBER]",
        rich_help_panel=LAYOUT,
    ),
]

Rotation = Annotated[
    str | None,
    typer.Option(
        help="Column of the rotations: its name, or its number from 1.",
        metavar="[NAME|NUMBER]",
        rich_help_panel=LAYOUT,
    ),
]

Time = Annotated[
    str | None,
    typer.Option(
        help="Column of the times: its name, or its number from 1.", metavar="[NAME|NUMBER]", rich_help_panel=LAYOUT
    ),
]

TimeStep = Annotated[
    str | None,
    typer.Option(
        help="Time step, in place of a column of times, such as 0.01s.", metavar="[s]", rich_help_panel=LAYOUT
    ),
]

TimeUnit = Annotated[
    str | None, typer.Option(help="Unit of these times: s, ms, us, min.", metavar="[UNIT]", rich_help_panel=LAYOUT)
]

Unit = Annotated[str | None, typer.Option(help="Unit of the samples.", metavar="[UNIT]", rich_help_panel=LAYOUT)]

Skip = Annotated[
    int,
    typer.Option(
        help="Lines above the names of the columns, or above the rows.", metavar="[NUMBER]", rich_help_panel=LAYOUT
    ),
]

Delimiter = Annotated[
    str | None,
    typer.Option(
        help="comma, semicolon, tab or blank; or the Fortran format of numbers of fixed width: 8f10.6.",
        metavar="[NAME]",
        rich_help_panel=LAYOUT,
    ),
]

Decimal = Annotated[str, typer.Option(help="Decimal sign, a dot or a comma.", metavar="[SIGN]", rich_help_panel=LAYOUT)]

Wrapped = Annotated[
    bool, typer.Option("--wrapped", help="All values are one series, row by row.", rich_help_panel=LAYOUT)
]

# Layout of tables: arguments of `TableLayout` of the same names

TableColumns = Annotated[
    list[str] | None,
    typer.Option(
        "--columns",
        help='Header of a column: "Breite (cm)=width [cm]", "Alter=unused"; may be repeated.',
        metavar="[HEADER=NAME]",
        rich_help_panel=TABLE,
    ),
]

TableDecimal = Annotated[
    str,
    typer.Option("--decimal", help="Decimal sign of the table, . or a comma.", metavar="[SIGN]", rich_help_panel=TABLE),
]

TableDelimiter = Annotated[
    str | None,
    typer.Option(
        "--delimiter",
        help="Sign between the cells of the table: comma, semicolon, tab.",
        metavar="[NAME]",
        rich_help_panel=TABLE,
    ),
]

TableSkip = Annotated[
    int,
    typer.Option("--skip", help="Lines above the header of the table.", metavar="[NUMBER]", rich_help_panel=TABLE),
]

Sheet = Annotated[
    str | None,
    typer.Option(help="Sheet of a workbook, where several hold cells.", metavar="[NAME]", rich_help_panel=TABLE),
]

# Suites of records

Configuration = Annotated[
    str,
    typer.Argument(
        help="Configuration of a suite (YAML, TOML or JSON), such as workflow/config/suite.yaml.",
        metavar="CONFIGURATION",
    ),
]
