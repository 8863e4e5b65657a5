"""The names in docs/notation.md are the arguments, options, parameters and columns that exist, and no others.

A name that is added to one interface needs a row that says what the others call it, or that they lack it.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer
from rocking_api.app import create_app
from rocking_api.models.answer import Answer
from rocking_api.settings import Settings

import rocking
from rocking._assessment.columns import INPUTS, OUTPUTS
from rocking._cli.app import app
from rocking._dimensional.table import COLUMNS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "notation.md").read_text(encoding="utf-8")
HEADER = ["term", "symbol", "Python", "command line", "HTTP", "column", "unit", "where defined"]

RETURNED = {"BodyResponse", "InvalidArgumentError", "Outcome", "PulseFit", "Response", "RockingError", "StoppedError"}
"""Classes that functions return or raise."""


def rows_under(heading: str) -> list[list[str]]:
    """Rows of the first table under a heading, its header first."""
    section = PAGE.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    rows = [re.split(r"(?<!\\)\|", line)[1:-1] for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows if not row[0].startswith("--")]


NAMES = rows_under("Names")


def names(column: str) -> list[str]:
    """Names in a column of the table."""
    index = HEADER.index(column)
    return [name for row in NAMES[1:] for name in re.findall(r"`([^`]+)`", row[index])]


def python_arguments() -> Iterator[str]:
    """Arguments of the public functions, and of the other classes and their methods."""
    for module in (rocking, rocking.suites):
        for name in set(module.__all__) - RETURNED:
            value = getattr(module, name)
            called = [value] if callable(value) else []
            if inspect.isclass(value):
                members = inspect.getmembers(value, callable)
                called += [member for name, member in members if not name.startswith("_")]
            for one in called:
                yield from inspect.signature(one).parameters.keys() - {"self"}


def options() -> Iterator[str]:
    """Options of the commands, and what they take without a name."""
    commands = [typer.main.get_command(app)]
    for command in commands:  # grows by those of each group
        commands += getattr(command, "commands", {}).values()
        yield from (max(parameter.opts, key=len) for parameter in command.params)


def http_parameters() -> Iterator[str]:
    """Parameters of the routes, fields of their JSON bodies, and the fields that every answer has."""
    yield from (*Answer.model_fields, *Answer.model_computed_fields)
    document = create_app(Settings()).openapi()
    models = document["components"]["schemas"]

    def fields(schema: dict[str, Any]) -> Iterator[str]:
        schema = models[schema["$ref"].rpartition("/")[2]] if "$ref" in schema else schema
        yield from schema.get("properties", {})
        for part in (*schema.get("properties", {}).values(), *schema.get("anyOf", ())):
            yield from fields(part)
        if "items" in schema:
            yield from fields(schema["items"])

    for operations in document["paths"].values():
        for operation in operations.values():
            yield from (one["name"] for one in operation.get("parameters", ()))
            body = operation.get("requestBody", {}).get("content", {})
            yield from fields(body.get("application/json", {}).get("schema", {}))


def columns() -> Iterator[str]:
    """Columns of the tables of blocks and of objects."""
    yield from (one.name for one in (*COLUMNS, *INPUTS))


INTERFACES = {"Python": python_arguments, "command line": options, "HTTP": http_parameters, "column": columns}

DIFFERENT = {
    *("alpha", "motion", "scale", "period", "frequency_ratio", "slenderness"),  # degrees; a name only; windows
    *("path", "order", "offset_width", "--results"),
}
"""First names of the rows whose names differ between interfaces."""


@pytest.mark.parametrize("column", INTERFACES)
def test_the_table_holds_the_names_of_an_interface(column: str) -> None:
    assert NAMES[0] == HEADER
    assert set(names(column)) == {*INTERFACES[column]()}


def test_names_of_a_row_are_the_same_in_all_interfaces() -> None:
    for row in NAMES[1:]:
        cells = [re.findall(r"`([^`]+)`", cell) for cell in row[2:6]]
        given = [[name.lstrip("-").replace("-", "_") for name in cell] for cell in cells if cell]
        first = next(name for cell in cells for name in cell)
        assert given.count(given[0]) == len(given) or first in DIFFERENT, row


def test_the_page_holds_the_columns_of_an_assessment() -> None:
    stated = [(name.strip("`"), unit, meaning) for name, unit, meaning in rows_under("Columns of an assessment")[1:]]
    assert stated == [(one.name, one.unit or "text", one.meaning) for one in OUTPUTS]
