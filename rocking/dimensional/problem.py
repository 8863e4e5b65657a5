"""A block under a pulse in SI units, and its similarity groups."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypedDict

from rocking.errors import InvalidArgumentError, in_range
from rocking.excitation.pulses import AbstractPulse, as_pulse
from rocking.model.block import Block
from rocking.model.checks import check
from rocking.model.parameters import RESTITUTION


class BlockGroups(TypedDict):
    """The groups of (5.3), restitution and alpha of the equation of motion, as keyword arguments of `peak_response`."""

    slenderness: float
    frequency_ratio: float
    restitution: float
    alpha: float


@dataclass(frozen=True)
class BlockProblem:
    """A block under a pulse.

    Parameters
    ----------
    block : Block
        The block.
    pulse : str or AbstractPulse
        The pulse.
    peak_acceleration : float
        a_g [m/s2], > 0.
    period : float
        T_p = 2 pi/omega_g [s], > 0; `duration` is how long the pulse lasts.
    restitution : float or "housner"
        eta [-], [0, 1]; or that of (2.4), 0 where it is negative.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range.
    """

    block: Block
    pulse: str | AbstractPulse
    peak_acceleration: float
    period: float
    restitution: float | Literal["housner"] = "housner"

    def __post_init__(self) -> None:
        as_pulse(self.pulse)
        for name, unit in (("peak_acceleration", "m/s2"), ("period", "s")):
            if in_range(name, getattr(self, name), 0.0, math.inf, closed="neither", unit=unit).ndim:
                several = "; `Block.spectrum` takes several periods" if name == "period" else ""
                raise InvalidArgumentError(name, getattr(self, name), f"one number [{unit}]{several}")
        restitution_of(self.block, self.restitution)

    @property
    def duration(self) -> float:
        """Duration of the pulse [s]: half a period for the half sine and the rectangular pulse, one for the sine."""
        pulse = as_pulse(self.pulse)
        return (pulse.end - pulse.start) / (2.0 * math.pi) * self.period

    @property
    def groups(self) -> BlockGroups:
        """The groups of (5.3)."""
        block = self.block
        return {
            "slenderness": block.uplift_acceleration / self.peak_acceleration,  # (5.3)
            "frequency_ratio": frequency_ratio_of(block, self.period),
            "restitution": restitution_of(block, self.restitution),
            "alpha": block.equation_alpha,
        }


def restitution_of(block: Block, restitution: float | str) -> float:
    """The coefficient of restitution [-]: the number, or that of the geometry for "housner".

    Raises
    ------
    InvalidArgumentError
        For any other text, several numbers, and numbers outside [0, 1].
    """
    if restitution == "housner":
        return block.inelastic_restitution
    if isinstance(restitution, str):
        raise InvalidArgumentError("restitution", restitution, f"housner, or a number in {RESTITUTION.interval}")
    if check(RESTITUTION, restitution).ndim:
        raise InvalidArgumentError("restitution", restitution, f"housner, or one number in {RESTITUTION.interval}")
    return float(restitution)


def frequency_ratio_of(block: Block, period: float) -> float:
    """omega = omega_g/p [-] of a period T_p [s]."""
    return 2.0 * math.pi / period / block.frequency_parameter


def period_of(block: Block, frequency_ratio: float) -> float:
    """T_p [s] of a frequency ratio omega [-]."""
    return 2.0 * math.pi / frequency_ratio / block.frequency_parameter
