"""One flight by Taylor steps: any pulse, slender or rigid, no impact missed.

Steps end at the cuts of the pulse, so that on each of them |a f| stays on one side of 1. At z = 0 the acceleration is
-(sin(alpha)/alpha)(1 + F). Where 1 + F > 0 the block is pulled back and z = 0 can only be crossed downwards, once:
z < 0 at the end of the step is both necessary and sufficient for an impact. Where 1 + F <= 0 z'' >= 0 holds for all
z >= 0 up to |theta| = pi/2, so z has at most one minimum and no maximum there.
"""

from __future__ import annotations

import math

from rocking.compilation import Record, kernel
from rocking.scratch import FALLEN, IMPACT, ORDER, PULSE_END
from rocking.taylor_step import evaluate, expand_motion, expand_pulse, first_crossing, polish, step_size


@kernel
def highest(flight: Record, h: float) -> float:
    """Largest peak of z on [0, h], or 0."""
    largest, start = 0.0, 0.0
    while start < h:
        top = first_crossing(flight.rate_of_z, ORDER - 1, start, h, True)
        if top < 0.0:
            break
        largest = max(largest, evaluate(flight.z, ORDER, top))
        start = top + 1e-9 * h
    return largest


@kernel
def impact_in_step(flight: Record, h: float, pushed: bool, grounded: bool) -> float:
    """Time of the impact within the step, or -1."""
    z, rate = flight.z, flight.rate_of_z
    landed = evaluate(z, ORDER, h) <= 0.0
    if not pushed:
        return polish(z, ORDER, 0.0, h, True, grounded) if landed else -1.0
    if rate[0] >= 0.0:
        return -1.0
    if landed:
        return polish(z, ORDER, 0.0, h, True, False)
    if evaluate(rate, ORDER - 1, h) > 0.0:
        bottom = first_crossing(rate, ORDER - 1, 0.0, h, False)
        if bottom > 0.0 and evaluate(z, ORDER, bottom) <= 0.0:
            return polish(z, ORDER, 0.0, bottom, True, False)
    return -1.0


@kernel
def fly_steps(flight: Record) -> tuple[int, float, float, float, float]:
    """Follow one flight from its start to its impact, to the end of the pulse, or to its fall.

    Returns
    -------
    what ended it, time since its start, velocity w and rotation z then, largest z on the way
    """
    phase, z, w, elapsed, largest = flight.phase, 0.0, flight.w0, 0.0, 0.0
    fallen = 0.5 * math.pi / flight.alpha if flight.alpha > 0.0 else math.inf
    beyond = math.inf if flight.alpha > 0.0 else 1.0 + flight.a  # see `slender_events.fly`
    interval, first = flight.interval, True
    while interval < flight.count:
        expand_pulse(flight, phase)
        if first and flight.lifted == 1:
            flight.f[0] = -1.0  # exactly: |a f| = 1
        expand_motion(flight, z, w)
        to_cut = (flight.cut_phase[interval + 1] - phase) / flight.omega
        h = min(step_size(flight), to_cut)
        pushed = flight.cut_level[interval] * flight.sign < 0.0
        impact = impact_in_step(flight, h, pushed, first)
        if impact >= 0.0:
            h = impact
        if not pushed:
            largest = max(largest, highest(flight, h))
        elapsed += h
        z, w = evaluate(flight.z, ORDER, h), evaluate(flight.rate_of_z, ORDER - 1, h)
        if impact >= 0.0:
            return IMPACT, elapsed, w, 0.0, largest
        if z >= fallen or largest >= fallen or z + w >= beyond:
            return FALLEN, elapsed, w, z, largest
        if h == to_cut:
            interval += 1
            phase = flight.cut_phase[interval]
        else:
            phase += flight.omega * h
        first = False
    return PULSE_END, elapsed, w, z, largest
