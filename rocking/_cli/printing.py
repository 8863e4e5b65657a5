"""Output of the `rocking` command: responses of the solver, printed as text, JSON or CSV."""

from __future__ import annotations

import json as json_writer
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import typer

from rocking._base.errors import finite, in_range, reject_given
from rocking._base.quantities import RESTITUTION
from rocking._base.units import UNITS
from rocking._cli.arguments import Params, given_units, unit_period
from rocking._cli.options import HistoryOptions, OutputOptions
from rocking._cli.progress import progress
from rocking._datasets.csv_text import csv_text
from rocking._dimensional.fields import CONTACT_FORCES, FIELDS, JUDGED
from rocking._dimensional.thresholds import Threshold, threshold_text
from rocking._model.fields import COLUMN_FIELDS, OUTCOME, SOURCE
from rocking._model.outcome import Outcome
from rocking._solver.bounded_response import BoundedResponse, solve_with_bound

if TYPE_CHECKING:
    import xarray as xr

    from rocking._dimensional.response import BodyResponse
    from rocking._dimensional.table import BlockTable


@dataclass(frozen=True)
class Form:
    """Format of the output; `units`: those of tables and CSV, by the SI unit; `all`: a table has all values."""

    kind: Literal["table", "csv", "json"]
    all: bool
    units: Mapping[str, str]

    def labels(self) -> dict[str, str]:
        """The units of all values and columns."""
        return {name: self.units.get(unit, unit) for name, unit in _UNITS.items()}

    def shown(self, result: Mapping[str, Any]) -> dict[str, Any]:
        """Values or columns in SI units in those of the user."""
        return {
            name: value
            if _UNITS.get(name) not in self.units
            else _divided(value, UNITS[_UNITS[name]][self.units[_UNITS[name]]])
            for name, value in result.items()
        }


def _divided(value: Any, factor: float) -> Any:
    if isinstance(value, dict):
        return {name: _divided(one, factor) for name, one in value.items()}
    if isinstance(value, list):
        return [_divided(one, factor) for one in value]
    return value / factor if isinstance(value, float) else value


def output_format(options: OutputOptions, given: object = None, columns: Mapping[str, str] | None = None) -> Form:
    """The output format of the options.

    `given` are options with quantities and `columns` the units of a table, whose units tables and CSV have.
    """
    return Form(options.format, options.all, given_units(given, columns))


def response(params: Params, form: Form) -> None:
    """Print outcome and peak of one block; with alpha also friction demand and validity of the rocking model.

    For a block with units also its rotation in degrees, displacement, changes of the outcome and warnings.
    """
    with progress("solving the block"):
        result, sentence = _response(params)
    print_answer(result, [sentence], form)


def body_columns(found: BodyResponse) -> dict[str, Any]:
    """The printed values of one body, by name; also the size of a body with two edges."""
    strengths = (
        {} if "record" in found.motion else {"peak_acceleration": found.peak_acceleration, "period": found.period}
    )
    about = found.summary() | strengths | {"thresholds": found.changes}
    if found.problem.is_block:
        return about
    body: Any = found.body
    left, right = (float(body.parameters[name]) for name in ("left", "right"))
    heights = {"height": float(body.top_height), "mass_height": float(body.height)}
    return about | {"width": left + right, **heights, "left": left, "right": right}


def print_answer(result: dict[str, Any], sentences: Sequence[str], form: Form) -> None:
    """Print the response of one block; text begins with these sentences and the warnings."""
    if form.kind == "json":
        print_json(result)
    elif form.kind == "csv":
        print_csv({name: [value] for name, value in result.items()}, form)
    else:
        for line in (*sentences, *(f"warning: {text}" for text in result.get("warnings", ()))):
            typer.echo(line)
        first = [name for name in (_FIRST_LINES if "peak_rotation_deg" in result else _IN_GROUPS) if name in result]
        shown = form.shown(result)
        names = dict.fromkeys((*first, *result) if form.all else first)
        print_text({name: _words(name, shown) for name in names if name not in _NO_LINES}, form)


def _response(params: Params) -> tuple[dict[str, Any], str]:
    """The printed values of one block, by name, and the outcome in words."""
    if params.problem is not None:
        from rocking._dimensional.response import respond

        result = _groups(params) | body_columns(respond(params.problem))
        return result, result["meaning"]
    found = solve_with_bound(params.pulse, **params.groups)
    result = _groups(params) | {name: column[0] for name, column in _columns(found).items()}
    if params.groups["alpha"] is None:
        return result, Outcome[result["outcome"]].sentence
    from rocking._history.contact import contact_extremes
    from rocking._history.motion import build_motion

    contact = contact_extremes(build_motion(params.pulse, **params.groups))
    about = {
        "friction_demand": finite(contact.largest_friction_demand),
        "lifts_off": contact.lifts_off,
        "rocking_model_applies": contact.rocking_applies,
    }
    return result | about, contact.sentence


def responses(table: BlockTable, form: Form) -> None:
    """Print the responses of many blocks: the columns of the table as they stand, and those of the responses."""
    from rocking._dimensional.table import respond_table

    with progress(f"solving {len(table.problems)} blocks"):
        found = respond_table(table)
    if form.kind == "json":
        bad_rows = [{"row": bad.row, "reasons": bad.reasons, "cells": bad.cells} for bad in table.read.bad_rows]
        print_json(found | {"table": table.read.cells, "bad_rows": bad_rows})
        return
    read = {header.partition(" [")[0] for header in table.read.columns.values()}
    found = {name: column for name, column in found.items() if name not in read}
    results = {name: found[name] for name in dict.fromkeys((*_OF_ROWS, *found))}
    taken = {_label(name, form.labels()) for name in results}
    given = {f"{label} (given)" if label in taken else label: column for label, column in table.read.cells.items()}
    if form.kind == "table" and not form.all:
        given = {label: table.read.cells[label] for label, name in table.read.columns.items() if name == "name"}
        results = {name: results[name] for name in _OF_ROWS}
    print_columns(given | results, form)


_OF_ROWS = ("outcome", "peak_rotation_deg", "top_displacement")
"""Responses of many blocks that a table holds, or begins with."""


_FIRST_LINES = (
    *("direction_deg", "edge", "rotation_left_deg", "rotation_right_deg"),
    *("peak_rotation_deg", "top_displacement", "uplift_acceleration", "largest_surviving_acceleration", "thresholds"),
    *("nearest_acceleration", "nearest_period", "period", "pulse_duration", "overturning_scale"),
    *("peak_rotation", "impacts", "restitution", "friction_demand"),
    *("pulse", "pulse_peak_acceleration", "pulse_cycles", "pulse_phase", "pulse_explained", "pulse_scale_ratio"),
)
"""What the table of a block with units holds, or begins with."""

_IN_GROUPS = ("peak_rotation", "impacts", "exceeded_alpha", "error_bound", "friction_demand")
"""The same of a block in groups."""

_NO_LINES = ("meaning", "margin", "warnings", "notes", "overturns_above")
"""Values that the text output states before the others, or in one line with another."""

_UNITS = {
    **{one.label: one.label_unit for one in (*FIELDS, *JUDGED) if one.unit != "1"},
    **dict.fromkeys(("alpha", "alpha_lower", "alpha_upper", "noise", "offset"), "rad"),
    **dict.fromkeys(("frequency_parameter_lower", "frequency_parameter_upper"), "rad/s"),
    "angular_velocity_deg": "deg/s",
    **dict.fromkeys(CONTACT_FORCES, "N"),
    "annual_rate": "1/year",
    **dict.fromkeys(("rotation_deg", "direction_deg"), "deg"),
    **dict.fromkeys(("time", "impact_time_s", "time_step", "significant_duration", "mean_period"), "s"),
    **dict.fromkeys(("mass_height", "left", "right", "peak_displacement"), "m"),
    **dict.fromkeys(("peak_velocity", "final_velocity", "arias_intensity"), "m/s"),
    **dict.fromkeys(("gravity", "acceleration", "thresholds"), "m/s2"),
    **dict.fromkeys(("pulse_peak_acceleration", "peak_vertical_acceleration", "vertical_acceleration"), "m/s2"),
}
"""Units that the text output names beside a value or a column; others are dimensionless."""


_NEAREST = {"nearest_acceleration": "peak_acceleration", "nearest_period": "period"}
"""Values at which the outcome changes, and those that were asked for."""


def _words(name: str, result: Mapping[str, Any]) -> Any:
    """A value of the text output; values at which the outcome changes are rounded to the safe side."""
    value = result[name]
    if value is None:
        return None
    if name == "thresholds":
        return _changes([one["peak_acceleration"] for one in value], [one["overturns_above"] for one in value])
    if name == "threshold_scale":
        return _changes(value, result["overturns_above"])
    if name in _NEAREST:
        overturns_above = (value > result[_NEAREST[name]]) != result["overturned"]
        return threshold_text(value, overturns_above=overturns_above)
    if name in ("largest_surviving_acceleration", "overturning_scale"):
        return threshold_text(value)
    return value


def _changes(values: Sequence[float], overturns_above: Sequence[bool]) -> str:
    return ", ".join(map(str, map(Threshold, values, overturns_above))) or "none"


def _csv_cell(value: Any) -> Any:
    """A value of one cell: texts of a list separated by semicolons, numbers and truth values by spaces."""
    if not isinstance(value, list):
        return value
    if all(isinstance(one, str) for one in value):
        return "; ".join(value)
    return " ".join(json_writer.dumps(one["peak_acceleration"] if isinstance(one, dict) else one) for one in value)


def history(params: Params, duration: float | None, samples: int, contact: bool, form: Form) -> None:
    """Print the motion of one block, with `contact` also the reactions of the ground and the friction demand.

    Of a body with other edges also the edge in contact: 1 right, -1 left, 0 both.
    """
    from rocking._dimensional.curves import history as history_of
    from rocking._dimensional.curves import in_si_units
    from rocking._history.contact import ATTRIBUTES, COLUMNS
    from rocking._history.time_history import time_history

    options: dict[str, Any] = {"duration": duration, "samples": samples, "contact": contact}
    if params.problem is not None and not params.problem.is_block:
        with progress("solving the body"):
            motion = history_of(params.problem, **options)
        print_motion(motion, form)
        return
    with progress("solving the block"):
        motion = time_history(params.pulse, **params.groups, **options)
    names = ["tau", "rotation", "angular_velocity", "ground_acceleration", *(COLUMNS if contact else ())]
    columns = {name: [finite(value) for value in motion[name].values.tolist()] for name in names}
    about = _groups(params) | {
        "outcome": str(motion.attrs["outcome"]),
        "overturned": bool(motion.attrs["overturned"]),
        "peak_rotation": finite(float(motion.attrs["peak_rotation"])),
        "impact_time": motion["impact_time"].values.tolist(),
    }
    if contact:
        about |= {name: finite(float(motion.attrs[name])) for name in ATTRIBUTES}
        about |= {"lifts_off": bool(motion.attrs["lifts_off"]), "warnings": motion.attrs["warnings"] or None}
    shown = columns
    if params.problem is not None:
        moved = in_si_units(motion, params.problem)
        si = _si_columns(moved)
        shown = si | {name: columns[name] for name in columns if name in COLUMNS}
        columns = columns | si
        about |= {"impact_time_s": moved["impact_time"].values.tolist()}
    _print_curve(about, columns, shown, form)


def released(options: HistoryOptions, duration: str | None, samples: int, contact: bool, form: Form) -> None:
    """Print the motion of a body that is released, as `history` of a body."""
    from rocking._cli.arguments import read_body

    stated = {name: getattr(options, name) for name in ("slenderness", "frequency_ratio", "alpha")}
    reject_given("a release", **stated)
    motion = read_body(options).history(
        options.pulse or None,
        start=options.start,
        peak_acceleration=options.peak_acceleration,
        period=options.period,
        restitution="momentum" if options.restitution is None else RESTITUTION.read(options.restitution),
        duration=duration,
        samples=samples,
        contact=contact,
    )
    print_motion(motion, form)


def print_motion(motion: xr.Dataset, form: Form) -> None:
    """Print a motion in SI units against time, with its reactions and contact forces if it has them."""
    from rocking._history.contact import ATTRIBUTES, COLUMNS

    columns = _si_columns(motion)
    others = ("edge", "vertical_acceleration", *COLUMNS, *CONTACT_FORCES)
    columns |= {name: [finite(value) for value in motion[name].values.tolist()] for name in others if name in motion}
    names = ("outcome", "impacts", *ATTRIBUTES, "warnings")
    about = {name: motion.attrs[name] for name in names if name in motion.attrs}
    about = {name: finite(value) if isinstance(value, float) else value or None for name, value in about.items()}
    about |= {"impact_time_s": motion["impact_time"].values.tolist()}
    _print_curve(about, columns, columns, form)


def _si_columns(motion: xr.Dataset) -> dict[str, list[Any]]:
    """The samples of a motion in SI units and degrees."""
    return {
        "time": motion["time"].values.tolist(),
        "rotation_deg": np.degrees(motion["rotation"].values).tolist(),
        "angular_velocity_deg": np.degrees(motion["angular_velocity"].values).tolist(),
        "top_displacement": motion["top_displacement"].values.tolist(),
        "acceleration": motion["ground_acceleration"].values.tolist(),
    }


def _print_curve(about: Mapping[str, Any], columns: Mapping[str, Any], shown: Mapping[str, Any], form: Form) -> None:
    """Print values and columns; `shown` are the columns of a table without `all`."""
    if form.kind == "json":
        print_json({**about, **columns})
    elif form.kind == "csv":
        print_csv(columns, form)
    else:
        print_text(form.shown(about), form)
        print_table(form.shown(columns if form.all else shown), form.labels())


def spectrum(params: Params, window: tuple[float, float], points: int, form: Form) -> None:
    """Print the peak against the frequency ratio, for a body with units against the period."""
    from rocking._dimensional.curves import spectrum as spectrum_of

    in_range("points", points, 2, 1_000_000)
    frequency_ratio, problem = np.geomspace(*window, points), params.problem
    columns: dict[str, Any] = {"frequency_ratio": frequency_ratio.tolist()}
    about = {name: value for name, value in _groups(params).items() if name != "frequency_ratio"}
    shown: tuple[str, ...] = ("frequency_ratio", "peak_rotation", "outcome", "impacts")
    with progress(f"solving {points} blocks"):
        if problem is None or problem.is_block:
            columns |= _columns(solve_with_bound(params.pulse, **params.groups | {"frequency_ratio": frequency_ratio}))
        if problem is not None:
            period = unit_period(problem.body) / frequency_ratio
            curve = spectrum_of(problem, period)
            columns["period"], moved = period.tolist(), "top_displacement" if problem.is_block else "displacement"
            if not problem.is_block:
                columns |= _columns(curve)
            columns |= {
                "peak_rotation_deg": [finite(x) for x in np.degrees(curve["rotation"].values).tolist()],
                "top_displacement": [finite(x) for x in curve[moved].values.tolist()],
            }
            about |= {"peak_acceleration": float(problem.peak_acceleration)}
            shown = ("period", "peak_rotation_deg", "top_displacement", "outcome", "impacts")
    step = 1 if problem is None else -1  # from the shortest period
    _print_curve(about, columns, {name: columns[name][::step] for name in shown}, form)


def boundary(params: Params, window: tuple[float, float], form: Form) -> None:
    """Print the overturning boundary curves; for a body with units also peak accelerations and periods."""
    from rocking._boundary.curves import points_of

    with progress("tracing the boundaries"):
        curves = boundary_curves(params, window)
    columns = points_of(curves)
    if params.problem is not None:
        columns |= {name: curves[name].values.tolist() for name in ("period", "peak_acceleration")}
        if form.kind == "table" and not form.all:
            columns = {name: columns[name] for name in ("curve", "period", "peak_acceleration", "outcome", "impacts")}
    about = {name: value for name, value in _groups(params).items() if name in ("pulse", "restitution", "alpha")}
    print_columns((about if form.kind == "json" else {}) | columns, form)


def boundary_curves(params: Params, window: tuple[float, float]) -> xr.Dataset:
    """The boundary curves over a window of frequency ratios; of a body with units with its axes."""
    if params.problem is None:
        from rocking._boundary.tracing import overturning_boundary

        shape = {name: params.groups[name] for name in ("restitution", "alpha")}
        return overturning_boundary(params.pulse, **shape, frequency_ratio=window)
    from rocking._dimensional.curves import boundary as boundary_of

    return boundary_of(params.problem, window=window)


def _groups(params: Params) -> dict[str, Any]:
    return {"pulse": params.pulse.name, **params.groups}


def _columns(found: BoundedResponse | xr.Dataset) -> dict[str, list[Any]]:
    columns: dict[str, list[Any]] = {}
    for field in COLUMN_FIELDS:
        if not hasattr(found, field.name):  # of bodies whose edges differ
            continue
        values = np.asarray(getattr(found, field.name)).ravel().tolist()
        if field is OUTCOME:
            values = [Outcome(code).name for code in values]
        elif field.dtype == "f8":
            values = [finite(value) for value in values]
        if field is not SOURCE:  # it is the solver
            columns[field.name] = values
    return columns


def print_json(result: Mapping[str, Any]) -> None:
    """Print an object in one line."""
    typer.echo(json_writer.dumps(result, allow_nan=False))


def print_columns(columns: Mapping[str, Any], form: Form) -> None:
    """Print columns in SI units, or texts, in any format."""
    if form.kind == "json":
        print_json(columns)
    elif form.kind == "csv":
        print_csv(columns, form)
    else:
        print_table(form.shown(columns), form.labels())


def print_csv(columns: Mapping[str, Sequence[Any]], form: Form, units: Mapping[str, str] | None = None) -> None:
    """Print a header and rows in the units of the user; `units` as for `print_table`."""
    known = form.labels() | dict(units or {})
    cells = {name: [_csv_cell(value) for value in values] for name, values in form.shown(columns).items()}
    typer.echo(csv_text({_label(name, known): values for name, values in cells.items()}), nl=False)


def print_text(result: Mapping[str, Any], form: Form) -> None:
    """Print a name with its unit and a value a line."""
    known = form.labels()
    labels = {name: _label(name, known) for name in result}
    width = max(map(len, labels.values()))
    for name, value in result.items():
        if value is not None:
            typer.echo(f"{labels[name]:<{width}}  {_text(value)}")


def print_table(columns: Mapping[str, Sequence[Any]], units: Mapping[str, str] | None = None) -> None:
    """Print aligned columns with their names and units; `units` are those of columns that depend on the question."""
    labels = [_label(name, _UNITS | dict(units or {})) for name in columns]
    cells = [[label, *map(_text, values)] for label, values in zip(labels, columns.values(), strict=True)]
    texts = [all(isinstance(value, str | list) for value in values) for values in columns.values()]
    widths = [max(map(len, column)) for column in cells]
    for row in zip(*cells, strict=True):
        aligned = zip(row, widths, texts, strict=True)
        line = "  ".join(cell.ljust(width) if text else cell.rjust(width) for cell, width, text in aligned)
        typer.echo(line.rstrip())


def _label(name: str, units: Mapping[str, str]) -> str:
    return f"{name} [{units[name]}]" if name in units else name


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value + 0.0:.9g}"  # no -0
    if isinstance(value, list):
        return " ".join(_text(one) for one in value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "-" if value is None else printable(str(value))


def printable(text: str) -> str:
    """A text without control characters, which a terminal would obey."""
    return text if text.isprintable() else "".join(one if one.isprintable() else "\ufffd" for one in text)
