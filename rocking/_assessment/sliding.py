"""Displacement of a block that only slides (Newmark 1965, both directions), exact for linear pieces of acceleration.

The block slides with the velocity v relative to the ground: v' = -a - sgn(v) mu g; it starts where |a| exceeds mu g and
sticks where v returns to zero. It is the other bound where mu < tan(alpha): sliding together with rocking is not
modelled.

References
----------
Newmark N. M. (1965), Effects of earthquakes on dams and embankments, Geotechnique 15(2), 139-160.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rocking._assessment.site import Motion
from rocking._base.constants import STANDARD_GRAVITY
from rocking._excitation.records.record import Record

Array = NDArray[np.float64]

SHAPE_PIECES = 2000
"""Linear pieces for a pulse that is not given by samples."""


def sliding_displacement(motion: Motion, friction: float) -> float:
    """Largest displacement relative to the ground of a block that slides under a motion of a site [m].

    Parameters
    ----------
    motion : Motion
        The motion; a vertical component is not regarded.
    friction : float
        Coefficient of friction [-], > 0.
    """
    given = motion.motion
    if isinstance(given, Record):
        times, samples = given.times, given.acceleration * (motion.peak_acceleration / given.peak_acceleration)
    else:
        phases, values = given.samples or _sampled(given.start, given.end, given.shape)
        times, samples = phases * (motion.period / (2.0 * math.pi)), values * motion.peak_acceleration
    return largest_slip(times, samples, friction * STANDARD_GRAVITY)


def _sampled(start: float, end: float, shape: object) -> tuple[Array, Array]:
    phases = np.linspace(start, end, SHAPE_PIECES + 1)
    return phases, shape(phases)  # type: ignore[operator]


def largest_slip(times: Array, acceleration: Array, resistance: float) -> float:
    """Largest |displacement| [m] under accelerations that are linear between times; arrays (samples,), SI units."""
    slip = velocity = largest = 0.0
    for (start, end), (first, last) in zip(pairwise(times.tolist()), pairwise(acceleration.tolist()), strict=True):
        left = end - start
        rate = (last - first) / left
        here = first
        while left > 0.0:
            if velocity == 0.0:
                wait = _time_to_slip(here, rate, resistance)
                if wait >= left:
                    break
                left, here = left - wait, here + rate * wait
                direction = -math.copysign(1.0, here)
            else:
                direction = math.copysign(1.0, velocity)
            push = -here - direction * resistance  # v' at the start of the step, v'' = -rate
            step = _time_to_stop(velocity, push, -rate, left)
            stops = step < left
            slip += step * (velocity + step * (0.5 * push - rate * step / 6.0))
            velocity = 0.0 if stops else velocity + step * (push - 0.5 * rate * step)
            here, left = here + rate * step, left - step
            largest = max(largest, abs(slip))
    if velocity != 0.0:
        slip += math.copysign(velocity * velocity / (2.0 * resistance), velocity)  # after the motion
    return max(largest, abs(slip))


def _time_to_slip(acceleration: float, rate: float, resistance: float) -> float:
    """Time until |a| exceeds the resistance."""
    if abs(acceleration) > resistance or (abs(acceleration) == resistance and acceleration * rate > 0.0):
        return 0.0
    if rate == 0.0:
        return math.inf
    return (math.copysign(resistance, rate) - acceleration) / rate


def _time_to_stop(velocity: float, push: float, change: float, left: float) -> float:
    """First time > 0 at which velocity + push t + change t^2/2 is zero; `left` if there is none before."""
    roots = []
    if change == 0.0:
        roots = [-velocity / push] if push != 0.0 else []
    else:
        square = push * push - 2.0 * change * velocity
        if square >= 0.0:
            q = -(push + math.copysign(math.sqrt(square), push))
            roots = [q / change] + ([2.0 * velocity / q] if q != 0.0 else [])
    return min([left, *(root for root in roots if root > 1e-14 * left)])
