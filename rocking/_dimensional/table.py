"""Many blocks in SI units: a table with units in its header or its cells in, columns of responses out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

from rocking._base.cells import text_of_cell
from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError
from rocking._base.quantities import HEIGHT, NAME, PEAK_ACCELERATION, PERIOD, RESTITUTION, WIDTH
from rocking._base.quantity import Quantity
from rocking._dimensional.body_kinds import columns_beside, described
from rocking._dimensional.fields import FIELDS
from rocking._dimensional.problem import Problem
from rocking._dimensional.response import respond_each, shown
from rocking._dimensional.rigid_body import RigidBody
from rocking._dimensional.table_reader import Row, Schema, Table, TableLayout, open_text, read_rows, read_table_file
from rocking._excitation.pulses import AbstractPulse
from rocking._model.block import RectangularBlock
from rocking._numba.cancellation import StopFlag, check_stop

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

    `stop` cancels the work, which then raises `StoppedError`. Of other bodies than blocks `body` says what each is, and
    what only a block has is None.
    """
    columns: dict[str, list[Any]] = {"name": table.names} if table.names else {}
    if not all(isinstance(problem.body, RectangularBlock) for problem in table.problems):
        columns["body"] = [problem.body.description for problem in table.problems]
    rows = []
    for response in respond_each(table.problems, stop):
        check_stop(stop)
        body = response.body
        size = {"width": float(body.width), "height": float(body.top_height)} if isinstance(body, RigidBody) else {}
        rows.append(size | shown(response.fields, [getattr(response, one.name) for one in response.fields]))
    return columns | {one.label: [row.get(one.label) for row in rows] for one in RESPONSES}
