"""Many blocks in SI units: a CSV table with units in its header in, columns of responses out."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, plain_number, positive
from rocking._base.units import UNITS as FACTORS
from rocking._base.units import unit_name
from rocking._dimensional.block import Block
from rocking._dimensional.problem import BlockProblem
from rocking._excitation.pulses import AbstractPulse
from rocking._model.fields import ERROR_BOUND, EXCEEDED_ALPHA, IMPACTS, OUTCOME, OVERTURNED, PEAK_ROTATION
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import solve_with_bound

UNITS = {
    "width": "m",
    "height": "m",
    "peak_acceleration": "m/s2",
    "period": "s",
}
"""Columns with units, and the SI units of their values."""

OTHER_COLUMNS = ("name", "restitution")
"""Columns without units: a label, and a number or momentum."""

_EXAMPLES = {"m": ("m", "cm"), "m/s2": ("g", "m/s2", "gal"), "s": ("s", "ms")}

_HEADER = re.compile(r"(\w+)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\))?")

MAX_NAME = 100
"""Longest name of a column with its unit [characters]."""

_ALLOWED = "columns " + ", ".join(f"{name} [unit]" for name in UNITS) + f", {', '.join(OTHER_COLUMNS)}"


@dataclass(frozen=True)
class BlockTable:
    """Blocks under one pulse.

    Attributes
    ----------
    problems : list of BlockProblem
        One for each row.
    names : list of str
        Labels, empty without a column `name`.
    """

    problems: list[BlockProblem]
    names: list[str]


def read_table(text: str, pulse: str | AbstractPulse, restitution: float | str = "momentum") -> BlockTable:
    """Parse a table of blocks.

    Parameters
    ----------
    text : str
        CSV with a header such as `name,width [m],height [cm],peak_acceleration [g],period [s],restitution`. Columns
        may be separated by semicolons; numbers have decimal points. Names are kept with their blanks.
    pulse : str or AbstractPulse
        The pulse.
    restitution : float or "momentum"
        For rows that state none.

    Raises
    ------
    InvalidArgumentError
        If a column is missing, unknown or without a unit, a value is not allowed, or it is no CSV; the line is named.
    SeveralArgumentsError
        If the values of several lines are not allowed, with the first of each line.
    """
    rows = _rows(text.removeprefix("\ufeff"))
    names, units = _read_header(next(rows, (1, []))[1])
    labels: list[str] = []
    problems: list[BlockProblem] = []
    errors: list[InvalidArgumentError] = []
    for line, row in rows:
        if not row:
            continue
        if len(row) != len(names):
            wrong = f"{len(row)} values"
            errors.append(InvalidArgumentError(f"blocks, line {line}", wrong, f"{len(names)}, as in the header"))
            continue
        given = dict(zip(names, (entry.strip() for entry in row), strict=True))
        try:
            problems.append(_problem(given, units, pulse, restitution))
        except InvalidArgumentError as error:
            errors.append(InvalidArgumentError(f"blocks, line {line}, {error.parameter}", error.value, error.allowed))
        if "name" in given:
            labels.append(row[names.index("name")])
    if errors:
        raise SeveralArgumentsError(errors) if len(errors) > 1 else errors[0]
    return BlockTable(problems, labels)


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """The rows of CSV with commas, or semicolons if its header has no comma, and the line where each begins."""
    header = next(iter(io.StringIO(text, newline="")), "")
    delimiter = ";" if ";" in header and "," not in header else ","
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    while True:
        line = rows.line_num + 1
        try:
            row = next(rows)
        except StopIteration:
            return
        except csv.Error as error:
            allowed = f"values of at most {csv.field_size_limit()} characters; in quotes, with each inner quote doubled"
            raise InvalidArgumentError(f"blocks, line {line}", str(error), allowed) from None
        yield line, row


def _read_header(header: Sequence[str]) -> tuple[list[str], dict[str, str]]:
    """Names of the columns, and their units."""
    names: list[str] = []
    units: dict[str, str] = {}
    for text in header:
        if len(text) > MAX_NAME:
            raise InvalidArgumentError(
                "blocks, header", f"{text[:MAX_NAME]}...", f"{_ALLOWED}, of at most {MAX_NAME} characters"
            )
        found = _HEADER.fullmatch(text.strip())
        name, unit = (found[1], found[2] or found[3]) if found else (text, None)
        if name in names or (name not in UNITS and name not in OTHER_COLUMNS):
            raise InvalidArgumentError("blocks, header", text, f"{_ALLOWED}, each at most once")
        if name in UNITS:
            examples = _EXAMPLES[UNITS[name]]
            if unit is None:
                raise InvalidArgumentError(
                    "blocks, header", text, f"a column with its unit (missing unit: write {name} [{examples[0]}])"
                )
            known = unit_name(unit, UNITS[name])
            if known is None:
                raise InvalidArgumentError("blocks, header", text, f"a unit such as {', '.join(examples)}")
            units[name] = known
        names.append(name)
    for name in UNITS:
        if names.count(name) != 1:
            raise InvalidArgumentError("blocks, header", ",".join(header), f"one column {name}")
    return names, units


def _problem(
    given: Mapping[str, str], units: Mapping[str, str], pulse: str | AbstractPulse, restitution: float | str
) -> BlockProblem:
    values = {name: _positive(name, given[name], unit) for name, unit in units.items()}
    eta = given.get("restitution") or restitution
    if isinstance(eta, str) and eta != "momentum":
        eta = plain_number("restitution", eta)
    return BlockProblem(
        Block(values["width"], values["height"]), pulse, values["peak_acceleration"], values["period"], eta
    )


def _positive(name: str, text: str, unit: str) -> float:
    """A value in SI units; an error repeats it in the unit of its column."""
    try:
        value = float(text)
    except ValueError:
        raise InvalidArgumentError(name, text, "a number with a decimal point, such as 0.4") from None
    return positive(name, value, unit) * FACTORS[UNITS[name]][unit]


def respond_table(table: BlockTable, stop: StopFlag | None = None) -> dict[str, list[Any]]:
    """The responses as columns in SI units, degrees and groups, in the order of the rows; missing numbers are None.

    Raises
    ------
    StoppedError
        If `stop` was set.
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
    )
    peaks = [_finite(peak) for peak in found.peak_rotation.tolist()]
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
        ERROR_BOUND.name: [_finite(bound) for bound in found.error_bound.tolist()],
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
