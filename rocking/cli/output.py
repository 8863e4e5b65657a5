"""Output of the `rocking` command: responses of the solver, printed as text, JSON or CSV."""

from __future__ import annotations

import json as json_writer
import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import typer

from rocking.cli.arguments import Params
from rocking.datasets.csv_text import csv_text
from rocking.errors import InvalidArgumentError, in_range
from rocking.model.fields import COLUMN_FIELDS, OUTCOME, SOURCE
from rocking.model.outcome import Outcome
from rocking.solver.bounded_response import BoundedResponse, solve_with_bound

Form = Literal["text", "json", "csv"]


def output_format(*, json: bool, csv: bool) -> Form:
    """The output format of the options.

    Raises
    ------
    InvalidArgumentError
        If both options are given.
    """
    if json and csv:
        raise InvalidArgumentError("csv", True, "one of --json and --csv")
    return "json" if json else "csv" if csv else "text"


def response(params: Params, form: Form) -> None:
    """Print outcome and peak of one block; with alpha also friction demand and validity of the rocking model."""
    found = _solve(params, params.frequency_ratio)
    groups = _groups(params)
    result = groups | {name: column[0] for name, column in _columns(found).items()}
    sentence = Outcome[result["outcome"]].sentence
    if params.alpha is not None:
        from rocking.history.contact import contact_extremes
        from rocking.history.motion import build_motion

        contact = contact_extremes(build_motion(**groups))
        sentence = contact.sentence
        result["friction_demand"] = _number(contact.largest_friction_demand)
        result["lifts_off"] = contact.lifts_off
        result["rocking_model_applies"] = contact.rocking_applies
    peak = result["peak_rotation"]
    if params.block is not None and peak is not None:
        result["peak_rotation_deg"] = math.degrees(peak * params.block.alpha)
    if form == "json":
        _print_json(result)
    elif form == "csv":
        _print_csv({name: [value] for name, value in result.items()})
    else:
        typer.echo(sentence)
        _print_text(result)


def history(params: Params, duration: float | None, samples: int, contact: bool, form: Form) -> None:
    """Print the motion of one block, with `contact` also the reactions of the ground and the friction demand."""
    from rocking.history.contact import ATTRIBUTES, COLUMNS
    from rocking.history.time_history import time_history

    motion = time_history(
        params.pulse,
        slenderness=params.slenderness,
        frequency_ratio=params.frequency_ratio,
        restitution=params.restitution,
        alpha=params.alpha,
        duration=duration,
        samples=samples,
        contact=contact,
    )
    names = ["tau", "rotation", "angular_velocity", "ground_acceleration", *(COLUMNS if contact else ())]
    columns = {name: [_number(value) for value in motion[name].values.tolist()] for name in names}
    if form == "csv":
        _print_csv(columns)
        return
    about = _groups(params) | {
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


def spectrum(params: Params, window: tuple[float, float], points: int, form: Form) -> None:
    """Print the peak against the frequency ratio."""
    in_range("points", points, 2, 1_000_000)
    frequency_ratio = np.geomspace(*window, points)
    columns = {"frequency_ratio": frequency_ratio.tolist()} | _columns(_solve(params, frequency_ratio))
    about = {name: value for name, value in _groups(params).items() if name != "frequency_ratio"}
    if form == "json":
        _print_json(about | columns)
    elif form == "csv":
        _print_csv(columns)
    else:
        _print_text(about)
        _print_table({name: columns[name] for name in ("frequency_ratio", "peak_rotation", "outcome", "impacts")})


def boundary(params: Params, window: tuple[float, float], form: Form) -> None:
    """Print the overturning boundary curves."""
    from rocking.boundary.tracing import overturning_boundary

    curves = overturning_boundary(
        params.pulse, restitution=params.restitution, alpha=params.alpha, frequency_ratio=window
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
        about = {"pulse": params.pulse, "restitution": params.restitution, "alpha": params.alpha}
        _print_json(about | columns)
    elif form == "csv":
        _print_csv(columns)
    else:
        _print_table(columns)


def _solve(params: Params, frequency_ratio: Any) -> BoundedResponse:
    return solve_with_bound(
        params.pulse,
        slenderness=params.slenderness,
        frequency_ratio=frequency_ratio,
        restitution=params.restitution,
        alpha=params.alpha,
    )


def _groups(params: Params) -> dict[str, Any]:
    return {
        "pulse": params.pulse,
        "slenderness": params.slenderness,
        "frequency_ratio": params.frequency_ratio,
        "restitution": params.restitution,
        "alpha": params.alpha,
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


def _print_json(result: Mapping[str, Any]) -> None:
    typer.echo(json_writer.dumps(result, allow_nan=False))


def _print_csv(columns: Mapping[str, Sequence[Any]]) -> None:
    typer.echo(csv_text(columns), nl=False)


def _print_text(result: Mapping[str, Any]) -> None:
    width = max(map(len, result))
    for name, value in result.items():
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
