"""Output of the commands: tables by rich for people, CSV and JSON for programs.

Names, units and values are those of the declared fields of responses and of the variables of data sets.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import typer

from rocking._base.errors import finite
from rocking._datasets.csv_text import csv_text

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr
    from rich.console import Console
    from rich.table import Table

    from rocking._dimensional.response import BodyResponse

WIDE = 10_000  # width of a table that is not printed on a terminal [characters]

LINE = 80  # most characters of a value in a line

LABELS = {"1": "", "-": "", "m s-1": "m/s", "m s-2": "m/s2", "rad s-1": "rad/s"}
"""Units as people write them, by the unit in CF; others are the same."""

ESSENTIAL = (
    *("pulse", "record", "body", "peak_rotation", "peak_rotation_deg", "displacement", "impacts", "restitution"),
    *("peak_acceleration", "period", "scale", "uplift_acceleration", "friction_demand", "nearest_period"),
    *("largest_surviving_acceleration", "nearest_acceleration", "overturning_scale", "thresholds"),
)
"""Values of a response that a person reads; JSON and CSV have all of them."""


@contextmanager
def progress(text: str) -> Iterator[Callable[[float], None]]:
    """Show a spinner with a text on a terminal until the block ends, on stderr; it yields a function of the share."""
    from rich.console import Console

    with Console(stderr=True).status(text) as status:
        yield lambda share: status.update(f"{text}, {share:.0%}")


def print_json(values: Mapping[str, Any]) -> None:
    """Print an object in one line."""
    typer.echo(json.dumps(values, allow_nan=False))


def print_csv(columns: Mapping[str, Sequence[Any]], units: Mapping[str, str] | None = None) -> None:
    """Print a header with units, and rows."""
    cells = {_label(name, units): [_csv_cell(value) for value in values] for name, values in columns.items()}
    typer.echo(csv_text(cells), nl=False)


def print_table(columns: Mapping[str, Sequence[Any]], units: Mapping[str, str] | None = None) -> None:
    """Print columns for people, with their units in the header."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False)
    for name, values in columns.items():
        is_text = all(isinstance(value, str | list) for value in values)
        table.add_column(Text(_label(name, units)), justify="left" if is_text else "right")
    for row in zip(*columns.values(), strict=True):
        table.add_row(*(Text(_text(value)) for value in row))
    _print_lines(table)


def print_values(values: Mapping[str, Any], units: Mapping[str, str] | None = None) -> None:
    """Print a name with its unit and a value in each line for people; what is None is left out."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(max_width=LINE)
    for name, value in values.items():
        if value is not None:
            table.add_row(Text(_label(name, units)), Text(_text(value)))
    _print_lines(table)


def print_columns(
    columns: Mapping[str, Sequence[Any]], output_format: str, units: Mapping[str, str] | None = None
) -> None:
    """Print columns in any format."""
    if output_format == "json":
        print_json(columns)
    elif output_format == "csv":
        print_csv(columns, units)
    else:
        print_table(columns, units)


def print_dataset(data: xr.Dataset, dimension: str, output_format: str) -> None:
    """Print the variables along a dimension of a data set; JSON and tables also have its attributes."""
    names = [*data.coords, *data.data_vars]
    columns = {name: _values(data[name]) for name in names if data[name].dims == (dimension,)}
    units = {name: unit_label(data[name].attrs.get("units", "")) for name in columns}
    attributes = {name: _finite(value) for name, value in data.attrs.items()}
    other_values = {name: _values(data[name]) for name in names if name not in columns}
    if output_format == "json":
        print_json({**attributes, **other_values, **columns})
    elif output_format == "csv":
        print_csv(columns, units)
    else:
        print_values(attributes)
        print_table(columns, units)


def response_values(response: BodyResponse) -> dict[str, Any]:
    """Return the values of the response of one body by name: its declared fields, and the thresholds."""
    body = {} if response.body.moves_as_block else {"body": response.body.description}
    if "pulse" in response.motion:
        strength = {"peak_acceleration": response.peak_acceleration, "period": response.period}
    else:
        strength = {"scale": response.scale}
    return {**response.motion, **body, **response.summary(), **strength, "thresholds": response.changes}


def print_response(response: BodyResponse, values: Mapping[str, Any], output_format: str) -> None:
    """Print the response of one body; for people its sentences and warnings, then the values."""
    from rocking._dimensional.fields import SHOWN
    from rocking._excitation.records.record import SUMMARY

    units = {field.label: unit_label(field.label_unit) for field in SHOWN}
    units |= {name: unit_label(unit) for name, unit in SUMMARY.items()}
    units |= {"peak_acceleration": "m/s2", "period": "s", "direction_deg": "deg"}
    units |= {"pulse_peak_acceleration": "m/s2", "pulse_period": "s"}
    if "pulse" in response.motion:
        units["thresholds"] = "m/s2"
    if output_format == "json":
        print_json(values)
        return
    if output_format == "csv":
        print_csv({name: [value] for name, value in values.items()}, units)
        return
    for text in (values["meaning"], values["margin"]):
        if text:
            typer.echo(text)
    for kind in ("warnings", "notes"):
        for text in values[kind]:
            typer.echo(f"{kind[:-1]}: {text}")
    changes = None
    if values["thresholds"] is not None:
        changes = ", ".join(map(str, response.thresholds or ())) or "none"
    print_values({name: values.get(name) for name in ESSENTIAL} | {"thresholds": changes}, units)
    typer.echo("every value: --format json")


def unit_label(unit: str) -> str:
    """Return a unit as people write it; "" for a number."""
    return LABELS.get(unit, unit)


def printable(text: str) -> str:
    """Replace the control characters of a text, which a terminal would obey."""
    return "".join(letter if letter.isprintable() else "\ufffd" for letter in text)


def _console() -> Console:
    """Return the standard output; where it is no terminal, lines are as long as they have to be."""
    from rich.console import Console

    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDE
    return console


def _print_lines(table: Table) -> None:
    """Print a table without the blanks that fill its last column."""
    console = _console()
    with console.capture() as captured:
        console.print(table)
    for line in captured.get().splitlines():
        typer.echo(line.rstrip())


def _label(name: str, units: Mapping[str, str] | None) -> str:
    unit = (units or {}).get(name, "")
    return f"{name} [{unit}]" if unit else name


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value + 0.0:.9g}"  # no -0
    if isinstance(value, list):
        return " ".join(map(_text, value))
    return "-" if value is None else printable(str(value))


def _csv_cell(value: Any) -> Any:
    """Return the value of a cell: texts of a list separated by semicolons, numbers and truth values by spaces."""
    if not isinstance(value, list):
        return value
    if all(isinstance(item, str) for item in value):
        return "; ".join(value)
    numbers = [next(iter(item.values())) if isinstance(item, dict) else item for item in value]
    return " ".join(map(json.dumps, numbers))


def _values(variable: xr.DataArray) -> Any:
    """Return the values of a variable as JSON holds them: names of outcomes, None for what is not finite."""
    if variable.name == "outcome":
        from rocking._model.outcome import Outcome

        return [Outcome(code).name for code in variable.values.ravel().tolist()]
    values = variable.values.tolist()
    return [_finite(value) for value in values] if isinstance(values, list) else _finite(values)


def _finite(value: Any) -> Any:
    """Return a value of a data set as JSON holds it."""
    plain = value.item() if hasattr(value, "item") else value
    return finite(plain) if isinstance(plain, float) else plain
