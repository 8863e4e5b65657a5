"""Many blocks in SI units: a table with units in its header or its cells in, columns of responses out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import compress
from os import PathLike
from typing import Any

import numpy as np

from rocking._base.cells import text_of_cell
from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError
from rocking._base.quantities import HEIGHT, NAME, PEAK_ACCELERATION, PERIOD, RESTITUTION, WIDTH
from rocking._base.quantity import Quantity
from rocking._dimensional.block import Block
from rocking._dimensional.body_kinds import columns_beside, described
from rocking._dimensional.fields import FIELDS
from rocking._dimensional.problem import Problem
from rocking._dimensional.response import respond, shown
from rocking._dimensional.rigid_body import RigidBody
from rocking._dimensional.table_reader import Row, Schema, Table, TableLayout, open_text, read_rows, read_table_file
from rocking._excitation.pulses import AbstractPulse
from rocking._model.fields import OUTCOME
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag, check_stop
from rocking._solver.bounded_response import solve_with_bound

COLUMNS = (NAME, WIDTH, HEIGHT, PEAK_ACCELERATION, PERIOD, RESTITUTION)
"""Columns of a table of blocks. Those of other bodies follow; further columns are passed through."""

RESPONSES = tuple(
    field
    for field in FIELDS
    if field.kinds >= {"pulse", "block"} and field.name not in ("half_diagonal", "frequency_parameter")
)
"""What the columns of responses hold."""

SHAPES = columns_beside(COLUMNS)
"""The kind of a body, and parameters of other bodies than blocks."""

SIZES = (("width", "diameter", "left", "vertices", "body"), ("height", "mass_height", "vertices", "body"))
"""Quantities of which a table of bodies needs one from each group."""


@dataclass(frozen=True)
class BlockTable:
    """Blocks, or other bodies, under one pulse."""

    problems: list[Problem]  # one for each row that could be read
    names: list[str]  # labels, empty without a column `name`
    # the table that they were read from, with the rows that could not be read
    read: Table[Problem] = field(default_factory=Table)

    def check(self) -> None:
        """Refuse a table with a row that could not be read."""
        errors = []
        for row in self.read.bad_rows:
            for error in row.errors:
                place = f"blocks, row {row.row}, {error.parameter}".removesuffix(", row")
                errors.append(InvalidArgumentError(place, error.value, error.allowed))
        if len(errors) == 1:
            raise errors[0]
        if errors:
            raise SeveralArgumentsError(errors)


def read_table(
    text: str,
    pulse: str | AbstractPulse,
    restitution: float | str = "momentum",
    *,
    most: int | None = None,
    stop: StopFlag | None = None,
    limited: Callable[[Quantity], Quantity] = lambda quantity: quantity,
    layout: TableLayout | None = None,
) -> BlockTable:
    """Read a table of at most `most` blocks from CSV text, as `read_blocks` from a file. `stop` cancels the work.

    `limited` gives each quantity the range that is allowed.
    """
    schema = _schema(pulse, {"restitution": restitution}, limited)
    file = open_text(text, "blocks", schema, layout or TableLayout(), stop)
    return _blocks(read_rows(file, schema, most))


def read_blocks(
    source: str | PathLike[str],
    pulse: str | AbstractPulse,
    restitution: float | str = "momentum",
    *,
    peak_acceleration: float | None = None,
    period: float | None = None,
    layout: TableLayout | None = None,
) -> BlockTable:
    """Read a table of blocks from a file, CSV or a sheet, in a stated layout; `-` is standard input.

    Restitution, a_g [m/s2] and T_p [s] are for rows that state none; the table needs these columns without them.
    """
    shared = {"restitution": restitution, "peak_acceleration": peak_acceleration, "period": period}
    stated = {name: value for name, value in shared.items() if value is not None}
    return _blocks(read_table_file(source, _schema(pulse, stated), layout or TableLayout()))


def _schema(
    pulse: str | AbstractPulse,
    shared: dict[str, float | str],
    limited: Callable[[Quantity], Quantity] = lambda quantity: quantity,
) -> Schema[Problem]:
    """A table of bodies under a pulse; `shared` are values of rows that state none."""
    parameters = {quantity.name for quantity in SHAPES[1:]} | {"width", "height"}
    motion = [quantity for quantity in (PEAK_ACCELERATION, PERIOD) if quantity.name not in shared]

    def problem(row: Row) -> Problem:
        values = shared | row.values
        for quantity in (PEAK_ACCELERATION, PERIOD):
            limited(quantity).number(values[quantity.name])
        shape = {name: value for name, value in values.items() if name in parameters}
        depth = shape.pop("depth", None)  # of other kinds than a hollow box it says nothing in this plane
        kind, stated = described(values.get("body"), shape)
        if depth is not None and "depth" in kind.fields:
            stated["depth"] = depth
        for name, value in kind.read(stated).items():
            if kind.fields[name].unit:
                limited(kind.fields[name]).number(value)
        return Problem.of(kind(**stated), pulse, values["peak_acceleration"], values["period"], values["restitution"])

    required = (*SIZES, *((quantity.name,) for quantity in motion))
    return Schema("blocks", (*COLUMNS, *SHAPES), required, problem)


def _blocks(table: Table[Problem]) -> BlockTable:
    labels = [label for label, header in table.columns.items() if header == "name"]
    names = [text_of_cell(cell) for label in labels for cell in table.cells[label]]
    return BlockTable(table.items, names, table)


def respond_table(table: BlockTable, stop: StopFlag | None = None) -> dict[str, list[Any]]:
    """The responses as columns in SI units, degrees and groups, in the order of the rows; missing numbers are None.

    `stop` cancels the work, which then raises `StoppedError`. Blocks are solved together, other bodies one by one:
    `body` then says what each is, and what only a block has is None.
    """
    is_block = [type(problem.body) is Block and problem.is_block for problem in table.problems]
    of_blocks = iter(_respond_blocks([*compress(table.problems, is_block)], stop))
    rows = []
    for problem, together in zip(table.problems, is_block, strict=True):
        rows.append(next(of_blocks) if together else _respond_other(problem, stop))
    columns: dict[str, list[Any]] = {"name": table.names} if table.names else {}
    if not all(is_block):
        columns["body"] = [problem.body.description for problem in table.problems]
    for quantity in RESPONSES:
        columns[quantity.label] = [row.get(quantity.label) for row in rows]
    return columns


def _respond_other(problem: Problem, stop: StopFlag | None) -> dict[str, Any]:
    check_stop(stop)
    response, body = respond(problem, stop=stop), problem.body
    size = {"width": float(body.width), "height": float(body.top_height)} if isinstance(body, RigidBody) else {}
    return size | shown(response.fields, [getattr(response, quantity.name) for quantity in response.fields])


def _respond_blocks(problems: list[Problem], stop: StopFlag | None) -> list[dict[str, Any]]:
    """The rows of blocks."""
    if not problems:
        return []
    columns: dict[str, Any] = {}
    for name in problems[0].groups:
        columns[name] = np.array([problem.groups[name] for problem in problems])
    sizes = (np.array([getattr(problem.block, name) for problem in problems]) for name in ("width", "height"))
    response = solve_with_bound(problems[0].pulse, **columns, stop=stop, body=Block(*sizes))
    solved = {f.name: getattr(response, f.name).tolist() for f in RESPONSES if hasattr(response, f.name)}
    rows = []
    for problem, *values in zip(problems, *solved.values(), strict=True):
        results = dict(zip(solved, values, strict=True))
        results[OUTCOME.name] = Outcome(results[OUTCOME.name])
        arguments = problem.groups | {name: getattr(problem, name) for name in ("peak_acceleration", "period")}
        in_order = []
        for quantity in RESPONSES:
            is_solved = quantity.name in results
            in_order.append(
                results[quantity.name]
                if is_solved
                else quantity.derive(results, arguments, problem.motion, problem.body)  # type: ignore[misc]
            )
        rows.append(shown(RESPONSES, in_order))
    return rows
