"""docs/notation.md, written from the declarations and from the names that the interfaces have.

`python -m tests.notation` writes it anew. A name that an interface has and no line of `TERMS` explains is an error.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import rocking_assessment
import typer
from rocking_api.app import create_app
from rocking_api.models.answer import Answer
from rocking_api.settings import Settings
from rocking_assessment._objects.columns import INPUTS, OUTPUTS, SHAPES

import rocking
import rocking._base.quantities as quantities
from rocking._base.quantity import Quantity
from rocking._cli.app import app
from rocking._dimensional.body_kinds import BODIES
from rocking._dimensional.table import COLUMNS
from rocking._excitation.pulses import PULSE_NAMES, pulse_parameters
from rocking._model.fields import COLUMN_FIELDS, RESPONSE_FIELDS
from tests.public_names import schema_fields

PAGE = Path(__file__).parents[1] / "docs" / "notation.md"

TERMS = Path(__file__).parent / "data" / "notation.txt"
"""Names, term, symbol, unit and where defined; of a declared quantity the names and where. Names that differ between
interfaces: those of Python, of the command line, of HTTP and of columns."""

RETURNED = {
    "BodyResponse",
    "InvalidArgumentError",
    "Outcome",
    "PulseFit",
    "Response",
    "RockingError",
    "SavingRestraint",
    "StoppedError",
}
"""Classes that functions return or raise."""

PICTURES = {"plot_free_rocking"}
"""Functions whose arguments are those of matplotlib."""


def python_arguments() -> Iterator[str]:
    """Arguments of the public functions, and of the other classes and their methods."""
    for module in (rocking, rocking.suites, rocking_assessment):
        for name in set(module.__all__) - RETURNED - PICTURES:
            value = getattr(module, name)
            called = [value] if callable(value) else []
            if inspect.isclass(value):
                members = inspect.getmembers(value, callable)
                called += [member for name, member in members if not name.startswith("_")]
            for one in called:
                yield from inspect.signature(one).parameters.keys() - {"self"}


def options() -> Iterator[str]:
    commands = [typer.main.get_command(app)]
    for command in commands:  # grows by those of each group
        names = command.list_commands(None) if hasattr(command, "list_commands") else []
        commands += [command.get_command(None, name) for name in names]
        yield from (max(parameter.opts, key=len) for parameter in command.params)


def http_parameters() -> Iterator[str]:
    """Parameters of the routes, fields of their JSON bodies, and the fields that every answer has."""
    yield from (*Answer.model_fields, *Answer.model_computed_fields)
    document = create_app(Settings()).openapi()
    for operations in document["paths"].values():
        for operation in operations.values():
            yield from (one["name"] for one in operation.get("parameters", ()))
            body = operation.get("requestBody", {}).get("content", {})
            schema = body.get("application/json", {}).get("schema", {})
            yield from (name.rpartition(".")[2] for name in schema_fields(document, schema))


def columns() -> Iterator[str]:
    yield from (one.name for one in (*COLUMNS, *INPUTS, *SHAPES))


def declared() -> dict[str, Quantity]:
    """Every declared quantity by its name: shared ones first."""
    found = {one.name: one for one in vars(quantities).values() if isinstance(one, Quantity)}
    kinds = [kind.fields for kind in BODIES.values()] + [pulse_parameters(name) for name in PULSE_NAMES]
    for fields in kinds:
        for name, one in fields.items():
            found.setdefault(name, one)
    return found


def names_table() -> Iterator[list[str]]:
    """The rows of the table of names.

    Raises
    ------
    ValueError
        If a name of an interface has no term, or a term has a name that no interface has.
    """
    interfaces = [{*python_arguments()}, {*options()}, {*http_parameters()}, {*columns()}]
    known, left = declared(), [{*names} for names in interfaces]
    lines = [[cell.strip() for cell in line.split(" | ")] for line in TERMS.read_text(encoding="utf-8").splitlines()]
    explained = {name for names, *_ in lines for name in re.findall(r"\w+", names)}
    other = {name for one in interfaces for name in one}
    lines += [[name, "parameter of `body`"] for name in known if name not in explained and name in other]
    for names, *about in lines:
        one = known.get(names)
        stated = [one.meaning, one.symbol or "-", one.unit or "-"] if one and len(about) == 1 else []
        term, symbol, unit, where = (*stated, *about)
        parts = [part.split() for part in names.split(";")]
        if len(parts) == 1:
            parts = [_present(parts[0], found) for found in interfaces]
        cells = [[name for name in part if name != "-"] for part in parts]
        for cell, found, rest in zip(cells, interfaces, left, strict=True):
            if not found.issuperset(cell):
                raise ValueError(f"{names}: no interface has {set(cell) - found}")
            rest.difference_update(cell)
        if not any(cells):
            raise ValueError(f"{names}: no interface has this name")
        yield [term, symbol, *(", ".join(f"`{name}`" for name in cell) or "-" for cell in cells), unit, where]
    if any(left):
        raise ValueError(f"names without a line in TERMS: {left}")


def _present(names: list[str], found: set[str]) -> list[str]:
    """The names that an interface has, of options with their dashes."""
    written = [next((one for one in (name, f"--{name.replace('_', '-')}") if one in found), "") for name in names]
    return [name for name in written if name]


def fields_table() -> Iterator[list[str]]:
    for one in dict.fromkeys((*RESPONSE_FIELDS, *COLUMN_FIELDS)):
        dtype = {"?": "bool", "U": "text", "i1": "int8", "i4": "int32", "f8": "float64"}[one.dtype]
        text = re.sub(r"\|(.+?)\|", r"abs(\1)", one.description("nan").replace(" [-]", ""))
        yield [f"`{one.name}`", dtype, one.unit.replace("1", "-"), f"({one.equation})", text]


def assessment_table() -> Iterator[list[str]]:
    for one in OUTPUTS:
        yield [f"`{one.name}`", one.unit or "text", one.meaning]


TABLES = {
    "Names": names_table,
    "Fields of a response": fields_table,
    "Columns of an assessment": assessment_table,
}


def page() -> str:
    """The page with its tables as they follow from the declarations; what else it says stays."""
    text = PAGE.read_text(encoding="utf-8")
    for heading, rows in TABLES.items():
        before, title, rest = text.partition(f"\n## {heading}\n")
        head, line, body = re.split(r"(\n\|[-|]+\|\n)", rest, maxsplit=1)
        after = re.sub(r"^(?:\|.*\n)*", "", body, count=1)
        text = before + title + head + line + "".join(f"| {' | '.join(row)} |\n" for row in rows()) + after
    return text


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
