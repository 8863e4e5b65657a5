"""Control groups of a block under a pulse and scaling of responses, from SI units and back: (3.6), (4.1), (5.3), (6.1).

Two blocks with equal groups have the same scaled response: exactly for slender blocks with (4.10) and (4.11), exactly
for geometrically similar blocks with (5.3), approximately with (6.1).

The parameters of a block and a pulse are described at `Problem`, those of groups at `Groups`; `group_set` is the set to
which they belong.
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.equality import EqualByValue
from rocking._base.errors import float_array, in_range, positive
from rocking.paper.arguments import Array


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


def _text(values: Array) -> str:
    """A number, or the range and count of several."""
    if values.size == 1:
        return f"{values.item():.4g}"
    return f"{values.min():.4g} to {values.max():.4g} ({values.size} values)" if values.size else "(no values)"


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Problem(EqualByValue):
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

    alpha: Array
    frequency_parameter: Array
    peak_acceleration: Array
    pulse_frequency: Array
    gravity: float

    def __init__(
        self,
        alpha: ArrayLike,
        frequency_parameter: ArrayLike,
        peak_acceleration: ArrayLike,
        pulse_frequency: ArrayLike,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        for name, value, high, unit in (
            ("alpha", alpha, 0.5 * np.pi, "rad"),
            ("frequency_parameter", frequency_parameter, np.inf, "rad/s"),
            ("peak_acceleration", peak_acceleration, np.inf, "m/s2"),
            ("pulse_frequency", pulse_frequency, np.inf, "rad/s"),
        ):
            vars(self)[name] = in_range(name, value, 0.0, high, closed="neither", unit=unit)
        vars(self)["gravity"] = positive("gravity", gravity, "m/s2")

    def __repr__(self) -> str:
        """The arguments, with units."""
        said = f"alpha {_text(self.alpha)} rad, p {_text(self.frequency_parameter)} rad/s"
        said += f", a_g {_text(self.peak_acceleration)} m/s2, omega_g {_text(self.pulse_frequency)} rad/s"
        return f"<rocking.paper.Problem: {said}, g {self.gravity:g} m/s2>"


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Groups(EqualByValue):
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

    frequency_ratio: Array
    slenderness: Array
    cos_alpha: Array | None

    def __init__(self, frequency_ratio: ArrayLike, slenderness: ArrayLike, cos_alpha: ArrayLike | None = None) -> None:
        for name, value in (("frequency_ratio", frequency_ratio), ("slenderness", slenderness)):
            vars(self)[name] = in_range(name, value, 0.0, np.inf, closed="neither")
        cosine = None if cos_alpha is None else in_range("cos_alpha", cos_alpha, 0.0, 1.0, closed="neither")
        vars(self)["cos_alpha"] = cosine

    def __repr__(self) -> str:
        """The groups."""
        said = f"omega {_text(self.frequency_ratio)}, slenderness {_text(self.slenderness)}"
        cosine = "" if self.cos_alpha is None else f", cos alpha {_text(self.cos_alpha)}"
        return f"<rocking.paper.Groups: {said}{cosine}>"

    @property
    def amplitude(self) -> Array:
        """a = 1/slenderness [-], (3.6)."""
        return np.asarray(1 / self.slenderness)  # (3.6)


def groups_of(problem: Problem, group_set: GroupSet) -> Groups:
    """Groups of a dimensional problem."""
    alpha = problem.alpha
    omega = problem.pulse_frequency / problem.frequency_parameter  # (3.6)
    slope = alpha if group_set.is_slender else np.tan(alpha)
    slenderness = problem.gravity * slope / problem.peak_acceleration  # (4.11); (5.3), (6.1) with tan
    return Groups(omega, slenderness, np.cos(alpha) if group_set is GroupSet.RIGID else None)


def problem_of_block(
    groups: Groups,
    group_set: GroupSet,
    *,
    alpha: ArrayLike,
    frequency_parameter: ArrayLike,
    gravity: float = STANDARD_GRAVITY,
) -> Problem:
    """Problem with given groups and a given block, `alpha` and `frequency_parameter`: it determines the pulse.

    With (5.3) `groups.cos_alpha` must be that of the block. Raises `InvalidArgumentError` otherwise, and for an
    argument out of range.
    """
    alpha = in_range("alpha", alpha, 0.0, np.pi / 2, closed="neither", unit="rad")
    p = in_range("frequency_parameter", frequency_parameter, 0.0, np.inf, closed="neither", unit="rad/s")
    if groups.cos_alpha is not None:
        _check_similar(groups.cos_alpha, alpha)
    g = positive("gravity", gravity, "m/s2")
    slope = alpha if group_set.is_slender else np.tan(alpha)
    return Problem(
        alpha=alpha,
        frequency_parameter=p,
        peak_acceleration=g * slope / groups.slenderness,
        pulse_frequency=groups.frequency_ratio * p,
        gravity=g,
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
    """Problem with given groups and a given pulse, `peak_acceleration` and `pulse_frequency`: it determines the block.

    alpha follows from the slenderness, in (5.3) it must agree with `groups.cos_alpha`. Raises `InvalidArgumentError` if
    no block has these groups: alpha is pi/2 or more, or contradicts `cos_alpha`.
    """
    a = in_range("peak_acceleration", peak_acceleration, 0.0, np.inf, closed="neither", unit="m/s2")
    frequency = in_range("pulse_frequency", pulse_frequency, 0.0, np.inf, closed="neither", unit="rad/s")
    g = positive("gravity", gravity, "m/s2")
    slope = groups.slenderness * a / g
    alpha = np.asarray(slope if group_set.is_slender else np.arctan(slope))
    if groups.cos_alpha is not None:
        _check_similar(groups.cos_alpha, alpha)
    return Problem(
        alpha=alpha,
        frequency_parameter=frequency / groups.frequency_ratio,
        peak_acceleration=a,
        pulse_frequency=frequency,
        gravity=g,
    )


def rotation_scale(problem: Problem, group_set: GroupSet) -> Array:
    """Angle by which rotations are divided [rad].

    alpha in (4.10), a_g/g in (4.11) and (5.3), (a_g/g) cos(alpha) in (6.1). Times are divided by 1/p, and angular
    velocities by p times this angle, (4.1).
    """
    alpha = problem.alpha
    by_pulse = np.asarray(problem.peak_acceleration / problem.gravity)
    match group_set:
        case GroupSet.SLENDER_BY_BLOCK:
            return alpha  # (4.10)
        case GroupSet.RIGID_SMALL_ROTATION:
            return np.asarray(by_pulse * np.cos(alpha))  # (6.1)
        case _:
            return by_pulse  # (4.11), (5.3)


def scaled_rotation(rotation: ArrayLike, problem: Problem, group_set: GroupSet) -> Array:
    """Scaled rotation [-] of a rotation theta [rad]; `rotation` broadcasts with the problem."""
    return np.asarray(float_array("rotation", rotation, unit="rad") / rotation_scale(problem, group_set))


def rotation_of_scaled(scaled: ArrayLike, problem: Problem, group_set: GroupSet) -> Array:
    """Rotation theta [rad] of a scaled rotation [-]; inverse of `scaled_rotation`."""
    return np.asarray(float_array("scaled", scaled) * rotation_scale(problem, group_set))


def scaled_time(time: ArrayLike, problem: Problem) -> Array:
    """tau = p t [-] of a time [s], (3.6)."""
    return np.asarray(float_array("time", time, unit="s") * problem.frequency_parameter)  # (3.6)


def time_of_scaled(scaled: ArrayLike, problem: Problem) -> Array:
    """Time t [s] of tau [-]; inverse of `scaled_time`."""
    return np.asarray(float_array("scaled", scaled) / problem.frequency_parameter)


def scaled_angular_velocity(velocity: ArrayLike, problem: Problem, group_set: GroupSet) -> Array:
    """Scaled angular velocity [-] of one in rad/s: theta'/(p alpha) in (3.4), g theta'/(p a_g) in (4.1)."""
    rate = rotation_scale(problem, group_set) * problem.frequency_parameter
    return np.asarray(float_array("velocity", velocity, unit="rad/s") / rate)


def angular_velocity_of_scaled(scaled: ArrayLike, problem: Problem, group_set: GroupSet) -> Array:
    """Angular velocity [rad/s] of a scaled one [-]; inverse of `scaled_angular_velocity`."""
    rate = rotation_scale(problem, group_set) * problem.frequency_parameter
    return np.asarray(float_array("scaled", scaled) * rate)
