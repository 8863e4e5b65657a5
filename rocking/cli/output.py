"""Answers of the `rocking` command: computed by the solver, printed as text, JSON or CSV."""

from __future__ import annotations

import csv as csv_writer
import json as json_writer
import math
import sys
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import typer

from rocking.cli.arguments import Params
from rocking.errors import InvalidArgumentError, in_range
from rocking.model.fields import COLUMN_FIELDS, OUTCOME, SOURCE
from rocking.model.outcome import Outcome
from rocking.solver.bounded_response import BoundedResponse, solve_with_bound

Form = Literal["text", "json", "csv"]


def output_format(*, json: bool, csv: bool) -> Form:
    """The form that was asked for.

    Raises
    ------
    InvalidArgumentError
        If both were.
    """
    if json and csv:
        raise InvalidArgumentError("csv", True, "one of --json and --csv")
    return "json" if json else "csv" if csv else "text"


def response(question: Params, form: Form) -> None:
    """Print outcome and peak of one block; of one that is not slender, whether the rocking model applies to it."""
    found = _solve(question, question.frequency_ratio)
    groups = _groups(question)
    answer = groups | {name: column[0] for name, column in _columns(found).items()}
    sentence = Outcome[answer["outcome"]].sentence
    if question.alpha is not None:
        from rocking.history.contact import contact_extremes
        from rocking.history.motion import build_motion

        contact = contact_extremes(build_motion(**groups))
        sentence = contact.sentence
        answer["friction_demand"] = _number(contact.largest_friction_demand)
        answer["lifts_off"] = contact.lifts_off
        answer["rocking_model_applies"] = contact.rocking_applies
    peak = answer["peak_rotation"]
    if question.block is not None and peak is not None:
        answer["peak_rotation_deg"] = math.degrees(peak * question.block.alpha)
    if form == "json":
        _print_json(answer)
    elif form == "csv":
        _print_csv({name: [value] for name, value in answer.items()})
    else:
        typer.echo(sentence)
        _print_text(answer)


def history(question: Params, duration: float | None, samples: int, contact: bool, form: Form) -> None:
    """Print the motion of one block, with `contact` also what the ground has to supply."""
    from rocking.history.contact import ATTRIBUTES, COLUMNS
    from rocking.history.time_history import time_history

    motion = time_history(
        question.pulse,
        slenderness=question.slenderness,
        frequency_ratio=question.frequency_ratio,
        restitution=question.restitution,
        alpha=question.alpha,
        duration=duration,
        samples=samples,
        contact=contact,
    )
    names = ["tau", "rotation", "angular_velocity", "ground_acceleration", *(COLUMNS if contact else ())]
    columns = {name: [_number(value) for value in motion[name].values.tolist()] for name in names}
    if form == "csv":
        _print_csv(columns)
        return
    about = _groups(question) | {
        "outcome": str(motion.attrs["outcome"]),
        "overturned": bool(motion.attrs["overturned"]),
        "peak_rotation": _number(float(motion.attrs["peak_rotation"])),
        "impact_time": motion["impact_time"].values.tolist(),
    }
    if contact:
        about |= {name: _number(float(motion.attrs[name])) for name in ATTRIBUTES}
        about |= {"lifts_off": bool(motion.attrs["lifts_off"]), "warnings": motion.attrs["warnings"] or None}
    if form == "json":
        _print_json(about | columns)
    else:
        _print_text(about)
        _print_table(columns)


def spectrum(question: Params, window: tuple[float, float], points: int, form: Form) -> None:
    """Print the peak against the frequency ratio."""
    in_range("points", points, 2, 1_000_000)
    frequency_ratio = np.geomspace(*window, points)
    columns = {"frequency_ratio": frequency_ratio.tolist()} | _columns(_solve(question, frequency_ratio))
    about = {name: value for name, value in _groups(question).items() if name != "frequency_ratio"}
    if form == "json":
        _print_json(about | columns)
    elif form == "csv":
        _print_csv(columns)
    else:
        _print_text(about)
        _print_table({name: columns[name] for name in ("frequency_ratio", "peak_rotation", "outcome", "impacts")})


def boundary(question: Params, window: tuple[float, float], form: Form) -> None:
    """Print the curves that separate standing from falling."""
    from rocking.boundary.tracing import overturning_boundary

    curves = overturning_boundary(
        question.pulse, restitution=question.restitution, alpha=question.alpha, frequency_ratio=window
    )
    sizes = curves["row_size"].values
    outcomes = [Outcome(int(code)).name for code in curves["outcome"].values]
    columns = {
        "curve": np.repeat(np.arange(sizes.size), sizes).tolist(),
        "slenderness": curves["slenderness"].values.tolist(),
        "frequency_ratio": curves["frequency_ratio"].values.tolist(),
        "outcome": np.repeat(outcomes, sizes).tolist(),
        "impacts": np.repeat(curves["impacts"].values, sizes).tolist(),
    }
    if form == "json":
        about = {"pulse": question.pulse, "restitution": question.restitution, "alpha": question.alpha}
        _print_json(about | columns)
    elif form == "csv":
        _print_csv(columns)
    else:
        _print_table(columns)


def _solve(question: Params, frequency_ratio: Any) -> BoundedResponse:
    return solve_with_bound(
        question.pulse,
        slenderness=question.slenderness,
        frequency_ratio=frequency_ratio,
        restitution=question.restitution,
        alpha=question.alpha,
    )


def _groups(question: Params) -> dict[str, Any]:
    return {
        "pulse": question.pulse,
        "slenderness": question.slenderness,
        "frequency_ratio": question.frequency_ratio,
        "restitution": question.restitution,
        "alpha": question.alpha,
    }


def _columns(found: BoundedResponse) -> dict[str, list[Any]]:
    columns: dict[str, list[Any]] = {}
    for field in COLUMN_FIELDS:
        values = getattr(found, field.name).ravel().tolist()
        if field is OUTCOME:
            values = [Outcome(code).name for code in values]
        elif field.dtype == "f8":
            values = [_number(value) for value in values]
        if field is not SOURCE:  # it is the solver
            columns[field.name] = values
    return columns


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _print_json(answer: Mapping[str, Any]) -> None:
    typer.echo(json_writer.dumps(answer, allow_nan=False))


def _print_csv(columns: Mapping[str, Sequence[Any]]) -> None:
    writer = csv_writer.writer(sys.stdout, lineterminator="\n")
    writer.writerow(columns)
    cells = ([str(v).lower() if isinstance(v, bool) else v for v in column] for column in columns.values())
    writer.writerows(zip(*cells, strict=True))


def _print_text(answer: Mapping[str, Any]) -> None:
    width = max(map(len, answer))
    for name, value in answer.items():
        if value is not None:
            typer.echo(f"{name:<{width}}  {_text(value)}")


def _print_table(columns: Mapping[str, Sequence[Any]]) -> None:
    rows = [list(columns), *([_text(value) for value in row] for row in zip(*columns.values(), strict=True))]
    widths = [max(len(row[k]) for row in rows) for k in range(len(columns))]
    for row in rows:
        typer.echo("  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)))


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.9g}"
    if isinstance(value, list):
        return " ".join(_text(one) for one in value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "-" if value is None else str(value)
