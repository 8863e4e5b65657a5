"""Many blocks in SI units: a table with units in its header or its cells in, columns of responses out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError
from rocking._base.quantities import HEIGHT, NAME, NUMBER, PEAK_ACCELERATION, PERIOD, RESTITUTION, WIDTH
from rocking._base.quantity import Quantity
from rocking._dimensional.body_kinds import columns_beside, described
from rocking._dimensional.fields import FIELDS
from rocking._dimensional.problem import Problem
from rocking._dimensional.response import respond_each, shown
from rocking._dimensional.rigid_body import RigidBody
from rocking._dimensional.table_header import Schema
from rocking._dimensional.table_reader import Table, read_csv, read_file
from rocking._excitation.pulses import AbstractPulse
from rocking._model.block import RectangularBlock
from rocking._numba.cancellation import StopFlag, check_stop

COLUMNS = (NAME, WIDTH, HEIGHT, PEAK_ACCELERATION, PERIOD, RESTITUTION)
"""Columns of a table of blocks. Those of other bodies follow; further columns are passed through."""

RESPONSES = tuple(
    one
    for one in FIELDS
    if one.kinds >= {"pulse", "block"} and one.name not in ("half_diagonal", "frequency_parameter")
)
"""What the columns of responses hold."""

_SIZES = (("width", "diameter", "left", "vertices", "body"), ("height", "mass_height", "vertices", "body"))


@dataclass(frozen=True)
class BlockTable:
    """Blocks, or other bodies, under one pulse."""

    problems: list[Problem]  # one for each row that could be read
    names: list[str]  # labels, empty without a column `name`
    # the table that they were read from, with the rows that could not be read
    read: Table[Problem] = field(default_factory=lambda: Table([]))

    def check(self) -> None:
        """Refuse a table with a row that could not be read."""
        errors = [
            InvalidArgumentError(f"blocks, row {row}, {one.parameter}".removesuffix(", row"), one.value, one.allowed)
            for row, one in self.read.errors
        ]
        if errors:
            raise SeveralArgumentsError(errors) if len(errors) > 1 else errors[0]


def read_table(
    text: str,
    pulse: str | AbstractPulse,
    restitution: float | str = "momentum",
    *,
    most: int | None = None,
    stop: StopFlag | None = None,
    limited: Callable[[Quantity], Quantity] = lambda one: one,
) -> BlockTable:
    """Read a table of at most `most` blocks from text, as `read_blocks` from a file. `stop` cancels the work.

    `limited` gives each quantity the range that is allowed.
    """
    return _blocks(read_csv(text, _schema(pulse, {"restitution": restitution}, limited), most, stop))


def read_blocks(
    source: str | PathLike[str],
    pulse: str | AbstractPulse,
    restitution: float | str = "momentum",
    *,
    peak_acceleration: float | None = None,
    period: float | None = None,
) -> BlockTable:
    """Read a table of blocks from a file, CSV or a sheet; `-` is standard input.

    Restitution, a_g [m/s2] and T_p [s] are for rows that state none; the table needs these columns without them.
    """
    given = {"restitution": restitution, "peak_acceleration": peak_acceleration, "period": period}
    return _blocks(read_file(source, _schema(pulse, {name: one for name, one in given.items() if one is not None})))


def _schema(
    pulse: str | AbstractPulse, given: dict[str, float | str], limited: Callable[[Quantity], Quantity] = lambda one: one
) -> Schema[Problem]:
    """A table of bodies under a pulse; `given` fills empty cells."""
    shapes = columns_beside(COLUMNS)
    parameters = {one.name for one in shapes[1:]} | {"width", "height"}

    def problem(_: int, values: dict[str, Any], __: dict[str, str]) -> Problem:
        one = given | values
        for quantity in (PEAK_ACCELERATION, PERIOD):
            if one.get(quantity.name) is None:
                raise InvalidArgumentError(quantity.name, None, "a value in each row")
            limited(quantity).number(one[quantity.name])
        shape = {name: one[name] for name in one if name in parameters}
        depth = shape.pop("depth", None)  # of other kinds than a hollow box it says nothing in this plane
        kind, stated = described(one.get("body"), shape)
        if depth is not None and "depth" in kind.fields:
            stated["depth"] = depth
        for name, value in kind.read(stated).items():
            if kind.fields[name].unit:
                limited(kind.fields[name]).number(value)
        return Problem.of(kind(**stated), pulse, one["peak_acceleration"], one["period"], one["restitution"])

    needed = (*_SIZES, *((one.name,) for one in (PEAK_ACCELERATION, PERIOD) if one.name not in given))
    return Schema("blocks", (*COLUMNS, NUMBER, *shapes), needed, problem)


def _blocks(read: Table[Problem]) -> BlockTable:
    names = next((read.cells[label] for label, name in read.columns.items() if name == "name"), [])
    return BlockTable(read.items, names, read)


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
