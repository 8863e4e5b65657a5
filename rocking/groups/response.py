"""Scaling of responses, from SI units and back, (3.6), (4.1), (4.10), (4.11), (5.3) and (6.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rocking._base.errors import float_array
from rocking.groups.control import Array, GroupSet, Problem


def rotation_scale(problem: Problem, group_set: GroupSet) -> Array:
    """Angle by which rotations are divided [rad].

    Parameters
    ----------
    problem : Problem
        Block and pulse in SI units.
    group_set : GroupSet
        Set of groups.

    Returns
    -------
    ndarray
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
