"""A block under a pulse or a record in SI units, and its groups. Both components of a record have the same factor."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, needed, number, positive, reject_given
from rocking._base.units import Scalar, Values
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale, reject_flight
from rocking._history.motion import BodyMotion, build_motion, build_record_motion
from rocking._model.block import AbstractBlock
from rocking._model.checks import check, check_number
from rocking._model.parameters import RESTITUTION
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import BoundedResponse, solve_with_bound
from rocking._solver.records.record_response import record_response

HIGHEST_SCALE = 1e6
"""Largest factor of a record [-]."""


@dataclass(frozen=True, init=False)
class BlockProblem:
    """A block under a ground motion.

    Parameters
    ----------
    block : AbstractBlock
        The block.
    motion : str, AbstractPulse or Record
        The pulse, or the record without its factor.
    peak_acceleration : float
        a_g [m/s2], > 0, of a pulse. A number without unit that is small enough to be one in g gives a warning.
    period : float
        T_p = 2 pi/omega_g [s], > 0, of a pulse; 1 for a record. `duration` is how long the motion lasts.
    restitution : float or "momentum"
        eta [-], [0, 1]; or that of (2.4), 0 where it is negative: None as an attribute.
    scale : float
        Factor of a record, of both its components [-], (0, 1e6]; 1 by default, and for a pulse.

    Raises
    ------
    InvalidArgumentError
        If a value is out of range, missing, or has no meaning for the kind of motion; if the vertical acceleration
        times the factor reaches -g.
    """

    block: AbstractBlock
    motion: AbstractPulse | Record
    peak_acceleration: float
    period: float
    restitution: float | None
    scale: float
    unit_is_stated: bool = field(compare=False, repr=False)

    def __init__(
        self,
        block: AbstractBlock,
        motion: str | AbstractPulse | Record,
        peak_acceleration: Scalar | None = None,
        period: Scalar | None = None,
        restitution: Scalar = "momentum",
        *,
        scale: Scalar | None = None,
    ) -> None:
        made = motion if isinstance(motion, Record) else as_pulse(motion)
        if isinstance(made, Record):
            reject_given("a record: state `scale`", peak_acceleration=peak_acceleration, period=period)
            factor = checked_scale(1.0 if scale is None else scale, made, block)
            strength, length = factor * made.peak_acceleration, 1.0
        else:
            reject_given("a pulse: state `peak_acceleration`", scale=scale)
            given = needed("a pulse", peak_acceleration=peak_acceleration)
            strength, factor = positive("peak_acceleration", given, "m/s2"), 1.0
            length = positive("period", needed("a pulse", period=period), "s")
        checked = {
            "block": block,
            "motion": made,
            "peak_acceleration": strength,
            "period": length,
            "restitution": checked_restitution(restitution, check_number),
            "scale": factor,
            "unit_is_stated": not isinstance(peak_acceleration, Real),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)  # a frozen dataclass

    @property
    def pulse(self) -> AbstractPulse:
        """The motion, where it is a pulse."""
        if isinstance(self.motion, Record):
            raise InvalidArgumentError("motion", self.motion, "a pulse")
        return self.motion

    @property
    def record(self) -> Record:
        """The motion, where it is a record."""
        if not isinstance(self.motion, Record):
            raise InvalidArgumentError("motion", self.motion, "a record")
        return self.motion

    @property
    def duration(self) -> float:
        """Duration of the motion [s]; of the half sine and the rectangular pulse half a period, of the sine one."""
        motion = self.motion
        if isinstance(motion, Record):
            return motion.duration
        return (motion.end - motion.start) / (2.0 * math.pi) * self.period

    @property
    def warnings(self) -> list[str]:
        """Whether the peak acceleration, a number without unit, was probably meant in g; and remarks on a record."""
        if isinstance(self.motion, Record):
            return [*self.motion.remarks]
        a, uplift = self.peak_acceleration, self.block.uplift_acceleration
        if self.unit_is_stated or not a < uplift < a * STANDARD_GRAVITY:
            return []
        text = f"peak_acceleration = {a:.4g} m/s2 is below the uplift acceleration {uplift:.4g} m/s2"
        return [f"{text}; if it was meant in g, write '{a:.4g} g'"]

    @property
    def groups(self) -> dict[str, Any]:
        """The groups, restitution and alpha of the equation of motion, as keyword arguments of `peak_response`."""
        block, eta = self.block, self.block.inelastic_restitution if self.restitution is None else self.restitution
        if isinstance(self.motion, Record):
            return record_groups(self.motion, block, self.scale, eta)
        return {
            "slenderness": block.uplift_acceleration / self.peak_acceleration,  # (5.3)
            "frequency_ratio": frequency_ratio_of(block, self.period),
            "restitution": eta,
            "alpha": block.equation_alpha,
        }

    def solve(self, stop: StopFlag | None = None) -> Response | BoundedResponse:
        """The response in groups, arrays of shape (); under a pulse with a bound of its error."""
        if isinstance(self.motion, Record):
            return record_response(self.motion, **self.groups, stop=stop)
        return solve_with_bound(self.motion, **self.groups, stop=stop)

    def block_motion(self, stop: StopFlag | None = None, **changed: float) -> BodyMotion:
        """The motion of the block as a function of time; with other groups where some are given."""
        groups = self.groups | changed
        if isinstance(self.motion, Record):
            return build_record_motion(self.motion, **groups, stop=stop)
        return build_motion(self.motion, **groups, stop=stop)


def checked_restitution(restitution: Values, checked: Callable[..., Any] = check) -> Any:
    """The coefficient of restitution: None for "momentum", else an array; or one number by `check_number`.

    Raises
    ------
    InvalidArgumentError
        For any other text, several numbers where one is checked, and numbers outside [0, 1].
    """
    if isinstance(restitution, str) and restitution == "momentum":
        return None
    try:
        return checked(RESTITUTION, restitution)
    except InvalidArgumentError as error:
        raise InvalidArgumentError("restitution", error.value, f"momentum, or {error.allowed}") from None


def restitution_of(block: AbstractBlock, restitution: Scalar) -> float:
    """The coefficient of restitution [-]: the number, or that of the geometry for "momentum"; `checked_restitution`."""
    eta = checked_restitution(restitution, check_number)
    return block.inelastic_restitution if eta is None else float(eta)


def frequency_ratio_of(block: AbstractBlock, period: float) -> float:
    """omega = omega_g/p [-] of a period T_p [s]."""
    return 2.0 * math.pi / period / block.frequency_parameter


def period_of(block: AbstractBlock, frequency_ratio: float) -> float:
    """T_p [s] of a frequency ratio omega [-]."""
    return 2.0 * math.pi / frequency_ratio / block.frequency_parameter


def record_groups(
    record: Record, block: AbstractBlock, scale: float | NDArray[np.float64], restitution: float
) -> dict[str, Any]:
    """Keyword arguments of `record_response` for a block with the restitution eta under a record times `scale`, > 0."""
    return {
        "frequency_parameter": block.frequency_parameter,
        "slenderness": block.uplift_acceleration / (scale * record.peak_acceleration),
        "restitution": restitution,
        "alpha": block.equation_alpha,
        # w is over the standard gravity there
        "vertical_scale": None if record.vertical is None else STANDARD_GRAVITY / block.gravity * scale,
    }


def checked_scale(scale: Scalar, record: Record, block: AbstractBlock) -> float:
    """The factor of a record [-].

    Raises
    ------
    InvalidArgumentError
        If it is not one number in (0, 1e6], or so large that the vertical acceleration reaches -g.
    """
    factor = number("scale", scale, 0.0, HIGHEST_SCALE, closed="right")
    reject_flight("scale", record, factor, block.gravity)
    return factor


def uplift_scale(record: Record, block: AbstractBlock) -> float:
    """Smallest factor of a record at which a block uplifts [-]; 1e6 where the vertical component prevents it longer.

    Uplift is where |a|/(g tan alpha) reaches 1 + w/g: at a sample, since both are linear between samples.
    """
    if record.vertical is None:
        return block.uplift_acceleration / record.peak_acceleration
    excess = np.abs(record.acceleration) / block.uplift_acceleration - record.vertical / block.gravity
    largest = float(excess.max())
    return 1.0 / max(largest, 1.0 / HIGHEST_SCALE)


def search_range(record: Record, block: AbstractBlock, highest: float | None) -> tuple[float, float, bool]:
    """Factors of a record among which its outcomes are searched.

    Returns
    -------
    (float, float, bool)
        That of uplift; the highest, by default ten times that of uplift; and whether the latter is that at which the
        vertical acceleration reaches -g.
    """
    lowest = uplift_scale(record, block)
    top = min(10.0 * lowest, HIGHEST_SCALE) if highest is None else highest
    limit = highest_vertical_scale(record, block.gravity)
    return lowest, min(top, limit), limit < top
