"""Many blocks in SI units: a table with units in its header or its cells in, columns of responses out."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

import numpy as np

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, finite
from rocking._base.quantities import HEIGHT, NAME, NUMBER, PEAK_ACCELERATION, PERIOD, RESTITUTION, WIDTH
from rocking._base.quantity import Quantity
from rocking._dimensional.block import Block
from rocking._dimensional.body_kinds import WITHOUT_FILES, columns_beside, described
from rocking._dimensional.problem import Problem
from rocking._dimensional.response import respond, shown
from rocking._dimensional.rigid_body import RigidBody
from rocking._dimensional.table_header import Schema
from rocking._dimensional.table_reader import Table, read_csv, read_file
from rocking._excitation.pulses import AbstractPulse
from rocking._model.fields import ERROR_BOUND, EXCEEDED_ALPHA, IMPACTS, OUTCOME, OVERTURNED, PEAK_ROTATION
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import solve_with_bound

COLUMNS = (NAME, WIDTH, HEIGHT, PEAK_ACCELERATION, PERIOD, RESTITUTION)
"""Columns of a table of blocks. Those of other bodies follow; further columns are passed through."""

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
        kind, stated = described(one.get("body"), shape, WITHOUT_FILES)
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

    `stop` cancels the work, which then raises `StoppedError`. Blocks are solved together, other bodies one by one:
    `body` then says what each is, and what only a block has is None.
    """
    rows: list[dict[str, Any]] = [{} for _ in table.problems]
    blocks = [k for k, one in enumerate(table.problems) if type(one.body) is Block and one.is_block]
    others = sorted({*range(len(rows))} - {*blocks})
    solved = _respond_blocks([table.problems[k] for k in blocks], stop)
    for k, values in zip(blocks, zip(*solved.values(), strict=True), strict=True):
        rows[k] = dict(zip(solved, values, strict=True))
    for k in others:
        if stop is not None:
            stop.check()
        rows[k] = _respond_other(table.problems[k], stop)
    columns: dict[str, list[Any]] = {"name": table.names} if table.names else {}
    if others:
        columns["body"] = [one.body.description for one in table.problems]
    return columns | {name: [row.get(name) for row in rows] for name in solved}


def _respond_other(problem: Problem, stop: StopFlag | None) -> dict[str, Any]:
    found, body = respond(problem, stop=stop), problem.body
    size = {"width": float(body.width), "height": float(body.top_height)} if isinstance(body, RigidBody) else {}
    return size | shown(found.fields, [getattr(found, one.name) for one in found.fields])


def _respond_blocks(problems: list[Problem], stop: StopFlag | None) -> dict[str, list[Any]]:
    """The columns of blocks."""
    groups = [problem.groups for problem in problems]
    columns: dict[str, list[Any]] = {
        "width": [problem.block.width for problem in problems],
        "height": [problem.block.height for problem in problems],
        "peak_acceleration": [problem.peak_acceleration for problem in problems],
        "period": [problem.period for problem in problems],
        "uplift_acceleration": [problem.block.uplift_acceleration for problem in problems],
        "alpha_deg": [math.degrees(problem.block.alpha) for problem in problems],
        "slenderness": [one["slenderness"] for one in groups],
        "frequency_ratio": [one["frequency_ratio"] for one in groups],
        "restitution": [one["restitution"] for one in groups],
    }
    pulse = problems[0].pulse if problems else "sine"
    found = solve_with_bound(
        pulse,
        slenderness=np.array(columns["slenderness"]),
        frequency_ratio=np.array(columns["frequency_ratio"]),
        restitution=np.array(columns["restitution"]),
        alpha=np.array([one["alpha"] for one in groups]),
        stop=stop,
        body=Block(np.array(columns["width"]), np.array(columns["height"])),
    )
    peaks = [finite(peak) for peak in found.peak_rotation.tolist()]
    rotations = [
        None if peak is None else peak * problem.block.alpha for peak, problem in zip(peaks, problems, strict=True)
    ]
    return columns | {
        "peak_rotation_deg": [None if rotation is None else math.degrees(rotation) for rotation in rotations],
        "top_displacement": [
            None if rotation is None else problem.block.top_displacement(rotation)
            for rotation, problem in zip(rotations, problems, strict=True)
        ],
        PEAK_ROTATION.name: peaks,
        OVERTURNED.name: found.overturned.tolist(),
        OUTCOME.name: [Outcome(code).name for code in found.outcome.tolist()],
        IMPACTS.name: found.impacts.tolist(),
        EXCEEDED_ALPHA.name: found.exceeded_alpha.tolist(),
        **{name: [*map(finite, found.derived[name].tolist())] for name in found.derived},
        ERROR_BOUND.name: [finite(bound) for bound in found.error_bound.tolist()],
    }
