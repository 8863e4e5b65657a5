"""Parameters of the command line: groups, or a block and a pulse with units."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import typer

from rocking.errors import InvalidArgumentError, in_range
from rocking.groups import GroupSet, Problem, groups_of
from rocking.model.block import Block
from rocking.model.checks import check_window
from rocking.model.parameters import FREQUENCY_RATIO


@dataclass(frozen=True)
class Params:
    """One block under one pulse, as groups; `block` if it was given with units."""

    pulse: str
    slenderness: float
    frequency_ratio: float
    restitution: float
    alpha: float | None
    block: Block | None = None


@contextmanager
def option_errors() -> Iterator[None]:
    """Convert an invalid argument into an error of the command line that names the option."""
    try:
        yield
    except InvalidArgumentError as error:
        option = "--" + error.parameter.split("[")[0].replace("_", "-")
        raise typer.BadParameter(
            f"{error.value!r} is not allowed; allowed: {error.allowed}", param_hint=option
        ) from None


def _si_value(parameter: str, text: str, unit: str) -> float:
    from rocking.dimensional.units import si_value  # the unit library is not needed for groups

    return si_value(parameter, text, unit)


def read_params(
    pulse: str,
    restitution: str,
    slenderness: float | None,
    frequency_ratio: float | None,
    alpha: str | None,
    half_width: str | None = None,
    half_height: str | None = None,
    peak_acceleration: str | None = None,
    pulse_period: str | None = None,
) -> Params:
    """The parameters as groups.

    Raises
    ------
    InvalidArgumentError
        If groups and units are mixed, a parameter is missing, or a value is not allowed.
    """
    groups = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "alpha": alpha}
    units = {
        "half_width": half_width,
        "half_height": half_height,
        "peak_acceleration": peak_acceleration,
        "pulse_period": pulse_period,
    }
    if not any(units.values()):
        for name in ("slenderness", "frequency_ratio"):
            if groups[name] is None:
                raise InvalidArgumentError(name, None, "a number; or a block and a pulse with units instead")
        angle = None if alpha is None else _si_value("alpha", alpha, "rad")
        return Params(pulse, slenderness or 0.0, frequency_ratio or 0.0, _eta(restitution), angle or None)
    for name, value in groups.items():
        if value is not None:
            raise InvalidArgumentError(name, value, "either groups or a block and a pulse with units")
    b, h, a_g, period = (
        _positive(name, units[name], unit) for name, unit in zip(units, ("m", "m", "m/s**2", "s"), strict=True)
    )
    block = Block(b, h)
    problem = Problem(block.alpha, block.frequency_parameter, a_g, 2.0 * math.pi / period)
    found = groups_of(problem, GroupSet.RIGID)  # (5.3)
    eta = block.inelastic_restitution if restitution == "housner" else _eta(restitution)
    s, omega = float(np.asarray(found.slenderness)), float(np.asarray(found.frequency_ratio))
    return Params(pulse, s, omega, eta, block.alpha, block)


def frequency_window(low: float, high: float) -> tuple[float, float]:
    """A window of the frequency ratio [-], low < high."""
    return check_window(FREQUENCY_RATIO, low, high)


def _positive(name: str, text: str | None, unit: str) -> float:
    if text is None:
        raise InvalidArgumentError(name, None, "required with the other dimensional options")
    return float(in_range(name, _si_value(name, text, unit), 0.0, math.inf, closed="neither", unit=unit))


def _eta(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InvalidArgumentError("restitution", text, "a number, or housner for a block with units") from None
