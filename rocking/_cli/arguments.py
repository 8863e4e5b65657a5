"""Parameters of the command line: groups, or a block and a pulse with units."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import typer

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, UnreadableFileError, number, si_value
from rocking._base.quantities import FREQUENCY_RATIO, PEAK_ACCELERATION, PERIOD, RESTITUTION
from rocking._base.units import split_quantity, unit_name
from rocking._cli.options import BODY, BodyOptions, ProblemOptions, ShapeOptions, SpectrumOptions, WindowOptions
from rocking._dimensional.body_kinds import body
from rocking._excitation.pulses import AbstractPulse, as_pulse, pulse_names
from rocking._model.checks import check_window

if TYPE_CHECKING:
    from rocking._dimensional.body import RespondingBody
    from rocking._dimensional.problem import Problem
    from rocking._dimensional.table import BlockTable
    from rocking._model.body import AbstractBody

SI_UNITS = {one.name: one.unit for one in (*BODY, PEAK_ACCELERATION, PERIOD) if one.unit not in ("", "-")} | {
    "period_min": "s",
    "period_max": "s",
}

MAX_ERRORS = 20  # lines of a file that an error names at most


@dataclass(frozen=True)
class Params:
    """One body under one pulse: a block by the groups, which are arguments of the solver; `problem` if with units."""

    pulse: AbstractPulse
    groups: dict[str, Any]
    problem: Problem | None = None


@contextmanager
def option_errors(hints: Mapping[str, str] | None = None) -> Iterator[None]:
    """Convert an invalid argument into an error of the command line that names the option.

    `hints` names the options of arguments that have other names.
    """
    try:
        yield
    except InvalidArgumentError as error:
        argument = error.parameter.split("[")[0].split(",")[0]
        named = {"order": "--baseline-order"} | dict(hints or {})
        option = named.get(argument, "--" + argument.replace("_", "-"))
        errors = error.errors if isinstance(error, SeveralArgumentsError) else [error]
        texts = [f"{len(errors)} values are not allowed"] if len(errors) > 1 else []
        texts += [_error_text(one) for one in errors[:MAX_ERRORS]]
        if len(errors) > MAX_ERRORS:
            texts.append(f"and {len(errors) - MAX_ERRORS} more")
        raise typer.BadParameter("\n".join(texts), param_hint=option) from None


def _error_text(error: InvalidArgumentError) -> str:
    """One line about an argument; of a file, where in it."""
    place = error.parameter.partition(",")[2].strip()
    text = f"{error.value!r} is not allowed; allowed: {error.allowed}"
    if error.value is None:
        text = f"missing; {error.allowed}"
    if error.allowed.startswith("missing unit"):
        text = f"{error.value!r}: {error.allowed}"
    if isinstance(error, UnreadableFileError):
        text = f"{error.value!r}: {error.reason}"
    return f"{place}: {text}" if place else text


def read_pulse(text: str) -> AbstractPulse:
    """The pulse of a name with its parameters, or else that in a file; a leading minus mirrors either."""
    name = text.removeprefix("-")
    if name.partition("(")[0].strip() in pulse_names():
        return as_pulse(text)
    from rocking._excitation.sampled import SampledPulse

    try:
        found = SampledPulse.from_file(name)
    except InvalidArgumentError as error:
        if error.parameter != "path":
            raise
        if isinstance(error, UnreadableFileError) and re.search(r"[./\\]", name):
            raise UnreadableFileError("pulse", text, error.reason) from None
        allowed = f"one of {', '.join(pulse_names())}, or {error.allowed}"
        raise InvalidArgumentError("pulse", text, allowed) from None
    return found.mirrored() if text.startswith("-") else found


def read_params(options: ProblemOptions) -> Params:
    """A body under a pulse."""
    if not _has_units(options):
        for name in ("slenderness", "frequency_ratio"):
            if getattr(options, name) is None:
                raise InvalidArgumentError(name, None, "a number; or a block and a pulse with units instead")
        return _in_groups(options, options.slenderness or 0.0, options.frequency_ratio or 0.0)
    _refuse_groups(options, "slenderness", "frequency_ratio", "alpha")
    body = read_body(options)
    return _of_problem(options, body, _given(options, "peak_acceleration"), _given(options, "period"))


Window = tuple[float, float]  # frequency ratios [-]


def read_spectrum(options: SpectrumOptions, usual: Window) -> tuple[Params, Window]:
    """A body under pulses of one amplitude, at the lowest frequency ratio, and the window of frequency ratios."""
    if not _has_units(options):
        if options.slenderness is None:
            raise InvalidArgumentError("slenderness", None, "a number; or a block and an amplitude with units instead")
        window = _window(options, usual)
        return _in_groups(options, options.slenderness, window[0]), window
    _refuse_groups(options, "slenderness", "alpha")
    body = read_body(options)
    window = _window(options, usual, body)
    return _of_problem(options, body, _given(options, "peak_acceleration"), unit_period(body) / window[0]), window


def read_boundary(options: WindowOptions, usual: Window) -> tuple[Params, Window]:
    """A body without amplitude, and the window of frequency ratios."""
    if not _has_units(options):
        window = _window(options, usual)
        return _in_groups(options, 1.0, window[0]), window
    _refuse_groups(options, "alpha")
    body = read_body(options)
    window = _window(options, usual, body)
    return _of_problem(options, body, float(body.uplift_acceleration), unit_period(body) / window[0]), window


def read_body(options: BodyOptions) -> RespondingBody:
    """The body of the options."""
    given = {one.name: getattr(options, one.name) for one in BODY if getattr(options, one.name) is not None}
    if options.body is not None:
        for name, value in given.items():
            raise InvalidArgumentError(name, value, "a parameter of --body, in its brackets")
        return body(options.body)
    if given.keys() < {"width", "height"}:
        for name in ("width", "height"):
            _given(options, name)
    return body(given)


def read_blocks(path: str, options: ProblemOptions, **layout: Any) -> BlockTable:
    """The blocks of a table in a file, whose `layout` are fields of `TableLayout`; `-` is standard input."""
    from rocking._dimensional.table import read_blocks as read_table
    from rocking._dimensional.table_reader import TableLayout, stated_columns

    for name in (*(one.name for one in BODY), "body", "slenderness", "frequency_ratio", "alpha"):
        if getattr(options, name) is not None:
            raise InvalidArgumentError(name, getattr(options, name), "no blocks but those of the table")
    strength = {
        one.name: one.number(_given(options, one.name))
        for one in (PEAK_ACCELERATION, PERIOD)
        if getattr(options, one.name) is not None
    }
    stated = TableLayout(**layout | {"columns": stated_columns(layout.get("columns") or ())})
    return read_table(path, read_pulse(options.pulse), _restitution(options), **strength, layout=stated)


def given_units(options: object, columns: Mapping[str, str] | None = None) -> dict[str, str]:
    """The unit in which the user gave lengths, accelerations and times, by the SI unit; of a table its columns'."""
    found: dict[str, str] = {}
    for name, unit in SI_UNITS.items():
        text = getattr(options, name, None)
        parts = split_quantity(text) if text else None
        known = (columns or {}).get(name) or (parts and unit_name(parts[1], unit))
        if known:
            found.setdefault(unit, known)
    return found


def read_duration(text: str | None, params: Params) -> float | None:
    """Length of a history in tau = p t: a number, or a time with a unit for a block; of other bodies in seconds."""
    if text is None:
        return None
    if params.problem is not None:
        length = si_value("duration", text, "s")
        return length * params.problem.block.frequency_parameter if params.problem.is_block else length
    try:
        return float(text)
    except ValueError:
        raise InvalidArgumentError("duration", text, "a number tau = p t; seconds for a block with units") from None


def unit_period(body: AbstractBody) -> float:
    """Period at the frequency ratio 1 to the right edge [s]."""
    return float(2.0 * math.pi / body.right.frequency_parameter)


def _has_units(options: ShapeOptions) -> bool:
    return any(getattr(options, name, None) for name in ("body", *SI_UNITS))


def _refuse_groups(options: ShapeOptions, *names: str) -> None:
    for name in names:
        if getattr(options, name) is not None:
            raise InvalidArgumentError(name, getattr(options, name), "either groups or a block and a pulse with units")


def _in_groups(options: ShapeOptions, slenderness: float, ratio: float) -> Params:
    angle = None if options.alpha is None else si_value("alpha", options.alpha, "rad")
    eta = _restitution(options)
    if isinstance(eta, str):
        raise InvalidArgumentError("restitution", options.restitution, "a number, or momentum for a block with units")
    groups = {"slenderness": slenderness, "frequency_ratio": ratio, "restitution": eta, "alpha": angle or None}
    return Params(read_pulse(options.pulse), groups)


def _of_problem(options: ShapeOptions, body: AbstractBody, peak_acceleration: Any, period: Any) -> Params:
    from rocking._dimensional.problem import Problem

    pulse = read_pulse(options.pulse)
    problem = Problem.of(body, pulse, peak_acceleration, period, _restitution(options))
    return Params(pulse, problem.groups if problem.is_block else {}, problem)


def _window(options: WindowOptions, usual: Window, body: AbstractBody | None = None) -> Window:
    """Frequency ratios, or those of the periods of a body; by default the usual ones."""
    given = options.frequency_ratio_min, options.frequency_ratio_max
    ends = [own if ratio is None else ratio for ratio, own in zip(given, usual, strict=True)]
    periods: dict[str, float] = {}
    for k, (end, name) in enumerate((("min", "period_max"), ("max", "period_min"))):  # two options for one end
        text = getattr(options, name)
        if body is None or text is None:
            continue
        if given[k] is not None:
            option = f"--{name.replace('_', '-')}"
            raise InvalidArgumentError(f"frequency_ratio_{end}", given[k], f"either this or {option}")
        periods[name] = PERIOD.number(text, name)
        ends[k] = unit_period(body) / periods[name]
    if len(periods) == 2:
        number("period_max", periods["period_max"], periods["period_min"], math.inf, closed="neither", unit="s")
    return check_window(FREQUENCY_RATIO, ends[0], ends[1])


def _given(options: BodyOptions, name: str) -> str:
    text: str | None = getattr(options, name)
    if text is None:
        raise InvalidArgumentError(name, None, "required with the other options that have units")
    return text


def _restitution(options: ShapeOptions) -> Any:
    return "momentum" if options.restitution is None else RESTITUTION.read(options.restitution)
