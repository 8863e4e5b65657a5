"""Control groups of a block under a pulse, from SI units and back, (3.6), (4.10), (4.11), (5.3), (6.1).

Two blocks with equal groups have the same scaled response: exactly for slender blocks with (4.10) and (4.11), exactly
for geometrically similar blocks with (5.3), approximately with (6.1).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.constants import STANDARD_GRAVITY
from rocking.errors import in_range

Array = NDArray[np.float64]


class GroupSet(Enum):
    """Sets of groups; the value is the equation number in the paper."""

    SLENDER_BY_BLOCK = "4.10"
    """theta/alpha against omega_g/p, a_g/(g alpha): (3.6) and (4.10)."""
    SLENDER_BY_PULSE = "4.11"
    """theta g/a_g against omega_g/p, g alpha/a_g."""
    RIGID = "5.3"
    """theta g/a_g against omega_g/p, g tan(alpha)/a_g, cos(alpha)."""
    RIGID_SMALL_ROTATION = "6.1"
    """theta g/(a_g cos(alpha)) against omega_g/p, g tan(alpha)/a_g."""

    @property
    def is_slender(self) -> bool:
        """True if the set uses alpha in place of tan(alpha)."""
        return self in (GroupSet.SLENDER_BY_BLOCK, GroupSet.SLENDER_BY_PULSE)


@dataclass(frozen=True)
class Problem:
    """A block under a pulse in SI units; arrays broadcast.

    Parameters
    ----------
    alpha : array_like
        Slenderness angle [rad], (0, pi/2).
    frequency_parameter : array_like
        p [rad/s], (0, inf).
    peak_acceleration : array_like
        a_g [m/s2], (0, inf).
    pulse_frequency : array_like
        omega_g = 2 pi/T_p [rad/s], (0, inf).
    gravity : float
        g [m/s2], (0, inf).
    """

    alpha: ArrayLike
    frequency_parameter: ArrayLike
    peak_acceleration: ArrayLike
    pulse_frequency: ArrayLike
    gravity: float = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        in_range("alpha", self.alpha, 0.0, np.pi / 2, closed="neither", unit="rad")
        in_range("frequency_parameter", self.frequency_parameter, 0.0, np.inf, closed="neither", unit="rad/s")
        in_range("peak_acceleration", self.peak_acceleration, 0.0, np.inf, closed="neither", unit="m/s2")
        in_range("pulse_frequency", self.pulse_frequency, 0.0, np.inf, closed="neither", unit="rad/s")
        in_range("gravity", self.gravity, 0.0, np.inf, closed="neither", unit="m/s2")


@dataclass(frozen=True)
class Groups:
    """Control groups of a problem, except restitution eta, which is dimensionless already.

    Parameters
    ----------
    frequency_ratio : array_like
        omega = omega_g/p [-], (0, inf).
    slenderness : array_like
        1/a = g tan(alpha)/a_g, or g alpha/a_g in the slender sets [-], (0, inf).
    cos_alpha : array_like or None
        cos(alpha) [-], (0, 1), a group of its own in (5.3) only.
    """

    frequency_ratio: ArrayLike
    slenderness: ArrayLike
    cos_alpha: ArrayLike | None = None

    def __post_init__(self) -> None:
        in_range("frequency_ratio", self.frequency_ratio, 0.0, np.inf, closed="neither")
        in_range("slenderness", self.slenderness, 0.0, np.inf, closed="neither")
        if self.cos_alpha is not None:
            in_range("cos_alpha", self.cos_alpha, 0.0, 1.0, closed="neither")

    @property
    def amplitude(self) -> Array:
        """a = 1/slenderness [-], (3.6)."""
        return np.asarray(1 / np.asarray(self.slenderness, dtype=np.float64))  # (3.6)


def groups_of(problem: Problem, group_set: GroupSet) -> Groups:
    """Groups of a dimensional problem.

    Parameters
    ----------
    problem : Problem
        Block and pulse in SI units.
    group_set : GroupSet
        Set of groups.
    """
    alpha = np.asarray(problem.alpha, dtype=np.float64)
    omega = np.asarray(problem.pulse_frequency) / np.asarray(problem.frequency_parameter)  # (3.6)
    slope = alpha if group_set.is_slender else np.tan(alpha)
    slenderness = problem.gravity * slope / np.asarray(problem.peak_acceleration)  # (4.11); (5.3), (6.1) with tan
    return Groups(omega, slenderness, np.cos(alpha) if group_set is GroupSet.RIGID else None)


def problem_of_block(
    groups: Groups,
    group_set: GroupSet,
    *,
    alpha: ArrayLike,
    frequency_parameter: ArrayLike,
    gravity: float = STANDARD_GRAVITY,
) -> Problem:
    """Problem with given groups and a given block; determines the pulse.

    Parameters
    ----------
    groups : Groups
        Control groups; with (5.3) `cos_alpha` must be that of the block.
    group_set : GroupSet
        Set to which they belong.
    alpha : array_like
        Slenderness angle [rad], (0, pi/2).
    frequency_parameter : array_like
        p [rad/s], (0, inf).
    gravity : float
        g [m/s2], (0, inf).

    Raises
    ------
    InvalidArgumentError
        If an argument is out of range or `alpha` contradicts `groups.cos_alpha`.
    """
    alpha = in_range("alpha", alpha, 0.0, np.pi / 2, closed="neither", unit="rad")
    p = in_range("frequency_parameter", frequency_parameter, 0.0, np.inf, closed="neither", unit="rad/s")
    if groups.cos_alpha is not None:
        _check_similar(groups.cos_alpha, alpha)
    slope = alpha if group_set.is_slender else np.tan(alpha)
    return Problem(
        alpha=alpha,
        frequency_parameter=p,
        peak_acceleration=gravity * slope / np.asarray(groups.slenderness),
        pulse_frequency=np.asarray(groups.frequency_ratio) * p,
        gravity=gravity,
    )


def _check_similar(cos_alpha: ArrayLike, alpha: Array) -> None:
    """Raise `InvalidArgumentError` unless cos(alpha) equals the group `cos_alpha`."""
    required, actual = np.broadcast_arrays(cos_alpha, np.cos(alpha))
    wrong = ~np.isclose(actual, required, rtol=1e-9, atol=0.0)
    if wrong.any():
        in_range("cos_alpha", actual[wrong][0], float(required[wrong][0]), float(required[wrong][0]))


def problem_of_pulse(
    groups: Groups,
    group_set: GroupSet,
    *,
    peak_acceleration: ArrayLike,
    pulse_frequency: ArrayLike,
    gravity: float = STANDARD_GRAVITY,
) -> Problem:
    """Problem with given groups and a given pulse; determines the block.

    Parameters
    ----------
    groups : Groups
        Control groups; in (5.3) alpha follows from the slenderness and must agree with `cos_alpha`.
    group_set : GroupSet
        Set to which they belong.
    peak_acceleration : array_like
        a_g [m/s2], (0, inf).
    pulse_frequency : array_like
        omega_g [rad/s], (0, inf).
    gravity : float
        g [m/s2], (0, inf).

    Raises
    ------
    InvalidArgumentError
        If no block has these groups: alpha is pi/2 or more, or contradicts `groups.cos_alpha`.
    """
    in_range("gravity", gravity, 0.0, np.inf, closed="neither", unit="m/s2")
    slope = np.asarray(groups.slenderness) * np.asarray(peak_acceleration) / gravity
    alpha = np.asarray(slope if group_set.is_slender else np.arctan(slope))
    if groups.cos_alpha is not None:
        _check_similar(groups.cos_alpha, alpha)
    return Problem(
        alpha=alpha,
        frequency_parameter=np.asarray(pulse_frequency) / np.asarray(groups.frequency_ratio),
        peak_acceleration=peak_acceleration,
        pulse_frequency=pulse_frequency,
        gravity=gravity,
    )
