"""A block under a pulse in SI units, and its similarity groups."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from numbers import Real
from typing import Literal, TypedDict

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, positive
from rocking._base.units import Scalar
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._model.block import AbstractBlock
from rocking._model.checks import check_number
from rocking._model.parameters import RESTITUTION


class BlockGroups(TypedDict):
    """The groups of (5.3), restitution and alpha of the equation of motion, as keyword arguments of `peak_response`."""

    slenderness: float
    frequency_ratio: float
    restitution: float
    alpha: float


@dataclass(frozen=True, init=False)
class BlockProblem:
    """A block under a pulse.

    Parameters
    ----------
    block : Block
        The block.
    pulse : str or AbstractPulse
        The pulse.
    peak_acceleration : float
        a_g [m/s2], > 0. A number without unit that is small enough to be one in g gives a warning.
    period : float
        T_p = 2 pi/omega_g [s], > 0; `duration` is how long the pulse lasts.
    restitution : float or "momentum"
        eta [-], [0, 1]; or that of (2.4), 0 where it is negative.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range.
    """

    block: AbstractBlock
    pulse: str | AbstractPulse
    peak_acceleration: float
    period: float
    restitution: float | Literal["momentum"]
    unit_is_stated: bool = field(compare=False, repr=False)

    def __init__(
        self,
        block: AbstractBlock,
        pulse: str | AbstractPulse,
        peak_acceleration: Scalar,
        period: Scalar,
        restitution: Scalar = "momentum",
    ) -> None:
        as_pulse(pulse)
        checked = {
            "block": block,
            "pulse": pulse,
            "peak_acceleration": positive("peak_acceleration", peak_acceleration, "m/s2"),
            "period": positive("period", period, "s"),
            "restitution": "momentum" if is_momentum(restitution) else restitution_of(block, restitution),
            "unit_is_stated": not isinstance(peak_acceleration, Real),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)  # a frozen dataclass

    @property
    def duration(self) -> float:
        """Duration of the pulse [s]: half a period for the half sine and the rectangular pulse, one for the sine."""
        pulse = as_pulse(self.pulse)
        return (pulse.end - pulse.start) / (2.0 * math.pi) * self.period

    @property
    def warnings(self) -> list[str]:
        """Whether the peak acceleration, a number without unit, was probably meant in g."""
        a, uplift = self.peak_acceleration, self.block.uplift_acceleration
        if self.unit_is_stated or not a < uplift < a * STANDARD_GRAVITY:
            return []
        text = f"peak_acceleration = {a:.4g} m/s2 is below the uplift acceleration {uplift:.4g} m/s2"
        return [f"{text}; if it was meant in g, write '{a:.4g} g'"]

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


def restitution_of(block: AbstractBlock, restitution: Scalar) -> float:
    """The coefficient of restitution [-]: the number, or that of the geometry for "momentum".

    Raises
    ------
    InvalidArgumentError
        For any other text, several numbers, and numbers outside [0, 1].
    """
    if is_momentum(restitution):
        return block.inelastic_restitution
    try:
        return check_number(RESTITUTION, restitution)
    except InvalidArgumentError as error:
        raise InvalidArgumentError("restitution", error.value, f"momentum, or {error.allowed}") from None


def is_momentum(restitution: Scalar) -> bool:
    """Whether the coefficient of restitution is that of the geometry, (2.4)."""
    return isinstance(restitution, str) and restitution == "momentum"


def frequency_ratio_of(block: AbstractBlock, period: float) -> float:
    """omega = omega_g/p [-] of a period T_p [s]."""
    return 2.0 * math.pi / period / block.frequency_parameter


def period_of(block: AbstractBlock, frequency_ratio: float) -> float:
    """T_p [s] of a frequency ratio omega [-]."""
    return 2.0 * math.pi / frequency_ratio / block.frequency_parameter
