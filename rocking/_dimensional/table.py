"""Many blocks in SI units: a table with units in its header or its cells in, columns of responses out."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

import numpy as np

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, finite
from rocking._base.quantities import HEIGHT, NAME, NUMBER, PEAK_ACCELERATION, PERIOD, RESTITUTION, WIDTH
from rocking._dimensional.block import Block
from rocking._dimensional.problem import Problem
from rocking._dimensional.table_header import Schema
from rocking._dimensional.table_reader import Table, read_csv, read_file
from rocking._excitation.pulses import AbstractPulse
from rocking._model.fields import ERROR_BOUND, EXCEEDED_ALPHA, IMPACTS, OUTCOME, OVERTURNED, PEAK_ROTATION
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import solve_with_bound

COLUMNS = (NAME, WIDTH, HEIGHT, PEAK_ACCELERATION, PERIOD, RESTITUTION)
"""Columns of a table of blocks; others are passed through."""

_NEEDED = ("width", "height", "peak_acceleration", "period")


@dataclass(frozen=True)
class BlockTable:
    """Blocks under one pulse."""

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
) -> BlockTable:
    """Read a table of at most `most` blocks from text, as `read_blocks` from a file. `stop` cancels the work."""
    return _blocks(read_csv(text, _schema(pulse, {"restitution": restitution}), most, stop))


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


def _schema(pulse: str | AbstractPulse, given: dict[str, float | str]) -> Schema[Problem]:
    """A table of blocks under a pulse; `given` stands for cells that are empty."""

    def block(_: int, values: dict[str, Any], __: dict[str, str]) -> Problem:
        one = given | values
        for name in _NEEDED:
            if name not in one:
                raise InvalidArgumentError(name, None, "a value in each row")
        return Problem.of(
            Block(one["width"], one["height"]), pulse, one["peak_acceleration"], one["period"], one["restitution"]
        )

    return Schema("blocks", (*COLUMNS, NUMBER), tuple((name,) for name in _NEEDED if name not in given), block)


def _blocks(read: Table[Problem]) -> BlockTable:
    names = next((read.cells[label] for label, name in read.columns.items() if name == "name"), [])
    return BlockTable(read.items, names, read)


def respond_table(table: BlockTable, stop: StopFlag | None = None) -> dict[str, list[Any]]:
    """The responses as columns in SI units, degrees and groups, in the order of the rows; missing numbers are None.

    `stop` cancels the work, which then raises `StoppedError`.
    """
    problems = table.problems
    groups = [problem.groups for problem in problems]
    columns: dict[str, list[Any]] = {"name": table.names} if table.names else {}
    columns |= {
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
