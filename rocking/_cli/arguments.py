"""Parameters of the command line: groups, or a block and a pulse with units."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import typer

from rocking._base.errors import InvalidArgumentError, SeveralArgumentsError, number, plain_number, positive, si_value
from rocking._base.quantities import FREQUENCY_RATIO
from rocking._base.units import split_quantity, unit_name
from rocking._cli.options import MassOptions, ProblemOptions, ShapeOptions, SizeOptions, SpectrumOptions, WindowOptions
from rocking._excitation.pulses import AbstractPulse, as_pulse, pulse_names
from rocking._model.checks import check_window

if TYPE_CHECKING:
    from rocking._dimensional.block import Block
    from rocking._dimensional.problem import Problem
    from rocking._dimensional.rigid_body import RigidBody
    from rocking._dimensional.table import BlockTable

SI_UNITS = {
    "width": "m",
    "height": "m",
    "peak_acceleration": "m/s2",
    "period": "s",
    "period_min": "s",
    "period_max": "s",
}
"""Options with units."""

MAX_ERRORS = 20
"""Lines of a file that an error names at most."""

_SIZES = ("width", "height")


@dataclass(frozen=True)
class Params:
    """One block under one pulse, as groups; `problem` if it was given with units."""

    pulse: AbstractPulse
    slenderness: float
    frequency_ratio: float
    restitution: float
    alpha: float | None
    problem: Problem | None = None

    @property
    def groups(self) -> dict[str, float | None]:
        """Arguments of the solver."""
        return {
            "slenderness": self.slenderness,
            "frequency_ratio": self.frequency_ratio,
            "restitution": self.restitution,
            "alpha": self.alpha,
        }


@contextmanager
def option_errors(hints: Mapping[str, str] | None = None) -> Iterator[None]:
    """Convert an invalid argument into an error of the command line that names the option.

    `hints` names the options of arguments that have other names.
    """
    try:
        yield
    except InvalidArgumentError as error:
        argument = error.parameter.split("[")[0].split(",")[0]
        option = (hints or {}).get(argument, "--" + argument.replace("_", "-"))
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
    return f"{place}: {text}" if place else text


def read_pulse(text: str) -> AbstractPulse:
    """The pulse of a name with its parameters, or else that in a file; a leading minus mirrors either.

    Raises
    ------
    InvalidArgumentError
        If the text is neither a name nor a file that holds a pulse.
    """
    name = text.removeprefix("-")
    if name.partition("(")[0].strip() in pulse_names():
        return as_pulse(text)
    from rocking._excitation.sampled import SampledPulse

    try:
        found = SampledPulse.from_file(name)
    except InvalidArgumentError as error:
        if error.parameter != "path":
            raise
        allowed = f"one of {', '.join(pulse_names())}, or {error.allowed}"
        raise InvalidArgumentError("pulse", text, allowed) from None
    return found.mirrored() if text.startswith("-") else found


def read_params(options: ProblemOptions) -> Params:
    """A block under a pulse.

    Raises
    ------
    InvalidArgumentError
        If groups and units are mixed, an option is missing, or a value is not allowed.
    """
    if not _has_units(options):
        for name in ("slenderness", "frequency_ratio"):
            if getattr(options, name) is None:
                raise InvalidArgumentError(name, None, "a number; or a block and a pulse with units instead")
        angle = None if options.alpha is None else si_value("alpha", options.alpha, "rad")
        slenderness, ratio = options.slenderness or 0.0, options.frequency_ratio or 0.0
        return Params(read_pulse(options.pulse), slenderness, ratio, read_eta(options.restitution), angle or None)
    _refuse_groups(options, ("slenderness", "frequency_ratio", "alpha"))
    block = read_block(options)
    return _of_problem(options, block, _given(options, "peak_acceleration"), _positive(options, "period"))


def read_spectrum(
    options: SpectrumOptions, low: float, high: float, context: typer.Context
) -> tuple[Params, tuple[float, float]]:
    """A block under pulses of one amplitude, at the lowest frequency ratio, and the window of frequency ratios.

    Raises
    ------
    InvalidArgumentError
        As `read_params`.
    """
    if not _has_units(options):
        if options.slenderness is None:
            raise InvalidArgumentError("slenderness", None, "a number; or a block and an amplitude with units instead")
        window = check_window(FREQUENCY_RATIO, low, high)
        angle = None if options.alpha is None else si_value("alpha", options.alpha, "rad")
        eta = read_eta(options.restitution)
        return Params(read_pulse(options.pulse), options.slenderness, window[0], eta, angle or None), window
    _refuse_groups(options, ("slenderness", "alpha"))
    block = read_block(options)
    window = _window(options, block, low, high, context)
    return _of_problem(options, block, _given(options, "peak_acceleration"), _period(block, window[0])), window


def read_boundary(
    options: WindowOptions, low: float, high: float, context: typer.Context
) -> tuple[Params, tuple[float, float]]:
    """A block without amplitude, and the window of frequency ratios.

    Raises
    ------
    InvalidArgumentError
        As `read_params`.
    """
    if not _has_units(options):
        window = check_window(FREQUENCY_RATIO, low, high)
        angle = None if options.alpha is None else si_value("alpha", options.alpha, "rad")
        return Params(read_pulse(options.pulse), 1.0, window[0], read_eta(options.restitution), angle or None), window
    _refuse_groups(options, ("alpha",))
    block = read_block(options)
    window = _window(options, block, low, high, context)
    return _of_problem(options, block, block.uplift_acceleration, _period(block, window[0])), window


def read_block(options: SizeOptions) -> Block:
    """The block of the sizes.

    Raises
    ------
    InvalidArgumentError
        If one is missing or not allowed.
    """
    from rocking._dimensional.block import Block

    return Block(_positive(options, "width"), _positive(options, "height"))


def read_body(options: ProblemOptions, mass: MassOptions) -> tuple[RigidBody, dict[str, Any]] | None:
    """A body whose centre of mass is not that of the block, and its motion, as arguments; None for a block.

    Raises
    ------
    InvalidArgumentError
        As `read_params`.
    """
    from rocking._dimensional.block import Block
    from rocking._dimensional.rigid_body import body_of_size

    if mass == MassOptions():
        return None
    _refuse_groups(options, ("slenderness", "frequency_ratio", "alpha"))
    body = body_of_size(_positive(options, "width"), _positive(options, "height"), mass.offset or 0.0, mass.mass_height)
    if isinstance(body, Block):
        return None
    return body, {
        "motion": read_pulse(options.pulse),
        "peak_acceleration": _positive(options, "peak_acceleration"),
        "period": _positive(options, "period"),
        "restitution": _restitution(options),
    }


def read_blocks(path: str, options: ProblemOptions, mass: MassOptions) -> BlockTable:
    """The blocks of a table in a file; `-` is standard input.

    Raises
    ------
    InvalidArgumentError
        If the file cannot be read, or blocks are also given by options.
    """
    from rocking._dimensional.table import read_blocks as read_table

    given = vars(options) | vars(mass)
    for name in (*_SIZES, *vars(mass), "slenderness", "frequency_ratio", "alpha"):
        if given[name] is not None:
            raise InvalidArgumentError(name, given[name], "no blocks but those of the table")
    strength = {
        name: _positive(options, name) for name in ("peak_acceleration", "period") if getattr(options, name) is not None
    }
    return read_table(path, read_pulse(options.pulse), _restitution(options), **strength)


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
    """Length of a history in tau = p t: a number, or a time with a unit for a block.

    Raises
    ------
    InvalidArgumentError
        If it is neither.
    """
    if text is None:
        return None
    if params.problem is not None:
        return float(si_value("duration", text, "s") * params.problem.block.frequency_parameter)
    try:
        return float(text)
    except ValueError:
        raise InvalidArgumentError("duration", text, "a number tau = p t; seconds for a block with units") from None


def _has_units(options: ShapeOptions) -> bool:
    return any(getattr(options, name, None) for name in SI_UNITS)


def _refuse_groups(options: ShapeOptions, names: tuple[str, ...]) -> None:
    for name in names:
        if getattr(options, name) is not None:
            raise InvalidArgumentError(name, getattr(options, name), "either groups or a block and a pulse with units")


def _of_problem(options: ShapeOptions, block: Block, peak_acceleration: float | str, period: float) -> Params:
    from rocking._dimensional.problem import Problem

    pulse = read_pulse(options.pulse)
    problem = Problem.of(block, pulse, peak_acceleration, period, _restitution(options))
    return Params(pulse, **problem.groups, problem=problem)


def _window(
    options: WindowOptions, block: Block, low: float, high: float, context: typer.Context
) -> tuple[float, float]:
    """Frequency ratios of the periods, by default as for groups."""
    for name, ratio, period in (("min", low, "period_max"), ("max", high, "period_min")):  # two options for one end
        source = context.get_parameter_source(f"frequency_ratio_{name}")
        if getattr(options, period) is not None and source is not None and source.name == "COMMANDLINE":
            option = f"--{period.replace('_', '-')}"
            raise InvalidArgumentError(f"frequency_ratio_{name}", ratio, f"either this or {option}")
    shortest = None if options.period_min is None else _positive(options, "period_min")
    longest = None if options.period_max is None else _positive(options, "period_max")
    if shortest is not None and longest is not None:
        number("period_max", longest, shortest, math.inf, closed="neither", unit="s")
    ends = low if longest is None else _ratio(block, longest), high if shortest is None else _ratio(block, shortest)
    return check_window(FREQUENCY_RATIO, *ends)


def _ratio(block: Block, period: float) -> float:
    return float(2.0 * math.pi / (period * block.frequency_parameter))


def _period(block: Block, ratio: float) -> float:
    return float(2.0 * math.pi / (ratio * block.frequency_parameter))


def _given(options: SizeOptions, name: str) -> str:
    text: str | None = getattr(options, name)
    if text is None:
        raise InvalidArgumentError(name, None, "required with the other options that have units")
    return text


def _positive(options: SizeOptions, name: str) -> float:
    return positive(name, _given(options, name), SI_UNITS[name])


def _restitution(options: ShapeOptions) -> float | str:
    from rocking._base.quantities import RESTITUTION

    given = options.restitution or "momentum"
    return given if given.partition("(")[0] in RESTITUTION.words else read_eta(given)


def read_eta(text: str | None, allowed: str = "a number, or momentum for a block with units") -> float:
    """The coefficient of restitution of a text.

    Raises
    ------
    InvalidArgumentError
        If it is not a number, with what is `allowed`.
    """
    if text is None:
        raise InvalidArgumentError("restitution", None, allowed)
    try:
        return plain_number("restitution", text)
    except InvalidArgumentError:
        raise InvalidArgumentError("restitution", text, allowed) from None
