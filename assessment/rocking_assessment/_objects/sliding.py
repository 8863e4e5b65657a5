"""Displacement of a block that only slides (Newmark 1965, both directions), exact for linear pieces of acceleration.

The block slides with the velocity v relative to the ground: v' = -a - sgn(v) mu (g + w), w the vertical acceleration of
the ground, upwards; it starts where |a| exceeds mu (g + w) and sticks where v returns to zero. On a piece a and w are
linear, so that v is quadratic and its zeros are exact. Sliding together with rocking is not modelled.

References
----------
Newmark N. M. (1965), Effects of earthquakes on dams and embankments, Geotechnique 15(2), 139-160.
"""

from __future__ import annotations

import math
from bisect import bisect_left

import numpy as np

from rocking.extension import STANDARD_GRAVITY, Array, Record
from rocking_assessment._objects.site import Motion, sampled


def sliding_displacement(motion: Motion, friction: float) -> float:
    """Largest displacement [m] over the ground of a block that slides under a motion of a site; `friction` > 0 [-]."""
    times, samples, vertical = _pieces(motion)
    resistance = friction * (STANDARD_GRAVITY + vertical)
    return largest_slip(times, samples, resistance, friction * STANDARD_GRAVITY)


def first_exceedance(motion: Motion, friction: float) -> float:
    """Time at which a body at rest needs more than a coefficient of friction, nan if it never does [s].

    It needs |a|/(g + w) of the horizontal and vertical acceleration.
    """
    times, samples, vertical = _pieces(motion)
    excess = np.abs(samples) - friction * (STANDARD_GRAVITY + vertical)  # linear on a piece between zeros of a
    over = np.flatnonzero(excess > 0.0)
    if not over.size:
        return math.nan
    k = int(over[0])
    if k == 0:
        return 0.0
    sign = math.copysign(1.0, samples[k])
    before = sign * samples[k - 1] - friction * (STANDARD_GRAVITY + vertical[k - 1])
    return float(times[k - 1] + (times[k] - times[k - 1]) * -before / (excess[k] - before))


def _pieces(motion: Motion) -> tuple[Array, Array, Array]:
    """Times [s], and horizontal and vertical accelerations [m/s2] that are linear between them."""
    pulse = motion.motion
    if isinstance(pulse, Record) or pulse.samples is None:
        record = sampled(motion)  # of a pulse at the strength of the site
        scale = motion.peak_acceleration / pulse.peak_acceleration if isinstance(pulse, Record) else 1.0
        vertical = np.zeros(record.samples)
        if record.vertical is not None:
            vertical = record.vertical * scale
        return record.times, record.acceleration * scale, vertical
    phases, values = pulse.samples
    return phases * (motion.period / (2.0 * math.pi)), values * motion.peak_acceleration, np.zeros(values.size)


def largest_slip(times: Array, acceleration: Array, resistance: Array, at_end: float) -> float:
    """Largest |displacement| [m] under accelerations of the ground [m/s2] at times [s] (samples,), linear between them.

    `resistance` is that of the friction, > 0, linear likewise; `at_end` the one after the motion [m/s2].
    """
    slip = velocity = largest = 0.0
    exceeds = np.abs(acceleration) > resistance
    starts = np.flatnonzero(exceeds[:-1] | exceeds[1:]).tolist()  # pieces on which a block at rest may start to slide
    at, values, resisting = times.tolist(), acceleration.tolist(), resistance.tolist()
    k = 0
    while k < len(at) - 1:
        if velocity == 0.0:
            following = bisect_left(starts, k)
            if following == len(starts):
                break
            k = starts[following]
        left, a, limit = at[k + 1] - at[k], values[k], resisting[k]
        rate, change = (values[k + 1] - a) / left, (resisting[k + 1] - limit) / left
        k += 1
        while left > 0.0:
            if velocity == 0.0:
                # |a| - resistance is the larger of two linear functions, for sliding towards - and towards +
                waits = {-side: _time_to_excess(side * a - limit, side * rate - change) for side in (1.0, -1.0)}
                direction = min(waits, key=waits.__getitem__)
                wait = waits[direction]
                if wait >= left:
                    break
                left, a, limit = left - wait, a + rate * wait, limit + change * wait
            else:
                direction = math.copysign(1.0, velocity)
            push, growth = -a - direction * limit, -rate - direction * change  # v' at the start of the step, and v''
            step = _time_to_stop(velocity, push, growth, left)
            stops = step < left
            slip += step * (velocity + step * (0.5 * push + growth * step / 6.0))
            velocity = 0.0 if stops else velocity + step * (push + 0.5 * growth * step)
            a, limit, left = a + rate * step, limit + change * step, left - step
            largest = max(largest, abs(slip))
    slip += math.copysign(velocity * velocity / (2.0 * at_end), velocity)  # after the motion
    return max(largest, abs(slip))


def _time_to_excess(excess: float, rate: float) -> float:
    """Time until a linear function is positive, infinite if it never is."""
    if excess > 0.0 or (excess == 0.0 and rate > 0.0):
        return 0.0
    return -excess / rate if rate > 0.0 else math.inf


def _time_to_stop(velocity: float, push: float, change: float, left: float) -> float:
    """First time > 0 at which velocity + push t + change t^2/2 is zero; `left` if there is none before."""
    roots = []
    if change == 0.0:
        if push != 0.0:
            roots.append(-velocity / push)
    else:
        square = push * push - 2.0 * change * velocity
        if square >= 0.0:
            q = -(push + math.copysign(math.sqrt(square), push))
            roots.append(q / change)
            if q != 0.0:
                roots.append(2.0 * velocity / q)
    return min([left, *(root for root in roots if root > 1e-14 * left)])
