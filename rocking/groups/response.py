"""Scaling of responses, from SI units and back, (3.6), (4.1), (4.10), (4.11), (5.3) and (6.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

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
    alpha = np.asarray(problem.alpha, dtype=np.float64)
    by_pulse = np.asarray(np.asarray(problem.peak_acceleration, dtype=np.float64) / problem.gravity)
    match group_set:
        case GroupSet.SLENDER_BY_BLOCK:
            return alpha  # (4.10)
        case GroupSet.RIGID_SMALL_ROTATION:
            return np.asarray(by_pulse * np.cos(alpha))  # (6.1)
        case _:
            return by_pulse  # (4.11), (5.3)


def scaled_rotation(rotation: ArrayLike, problem: Problem, group_set: GroupSet) -> Array:
    """Scaled rotation [-] of a rotation theta [rad]; `rotation` broadcasts with the problem."""
    return np.asarray(np.asarray(rotation) / rotation_scale(problem, group_set))


def rotation_of_scaled(scaled: ArrayLike, problem: Problem, group_set: GroupSet) -> Array:
    """Rotation theta [rad] of a scaled rotation [-]; inverse of `scaled_rotation`."""
    return np.asarray(np.asarray(scaled) * rotation_scale(problem, group_set))


def scaled_time(time: ArrayLike, problem: Problem) -> Array:
    """tau = p t [-] of a time [s], (3.6)."""
    return np.asarray(np.asarray(time) * np.asarray(problem.frequency_parameter))  # (3.6)


def time_of_scaled(scaled: ArrayLike, problem: Problem) -> Array:
    """Time t [s] of tau [-]; inverse of `scaled_time`."""
    return np.asarray(np.asarray(scaled) / np.asarray(problem.frequency_parameter))


def scaled_angular_velocity(velocity: ArrayLike, problem: Problem, group_set: GroupSet) -> Array:
    """Scaled angular velocity [-] of one in rad/s: theta'/(p alpha) in (3.4), g theta'/(p a_g) in (4.1)."""
    return np.asarray(
        np.asarray(velocity) / (rotation_scale(problem, group_set) * np.asarray(problem.frequency_parameter))
    )


def angular_velocity_of_scaled(scaled: ArrayLike, problem: Problem, group_set: GroupSet) -> Array:
    """Angular velocity [rad/s] of a scaled one [-]; inverse of `scaled_angular_velocity`."""
    return np.asarray(
        np.asarray(scaled) * (rotation_scale(problem, group_set) * np.asarray(problem.frequency_parameter))
    )
