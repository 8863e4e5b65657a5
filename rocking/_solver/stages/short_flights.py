"""Short flights of `LANES` blocks by the Taylor series at their start: `rocking._solver.arcs.events.short_flight`."""

from __future__ import annotations

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import absolute, any_lane, fill_mask, load, select, splat, store
from rocking._solver.stages.arcs import expand_start, series_states, start_arcs
from rocking._solver.stages.events import piece_ends
from rocking._solver.stages.excitation import restoring_acceleration, set_angles
from rocking._solver.stages.state import OMEGA, PEAK, PHASE, W0
from rocking._solver.state import IMPACT, IN_FLIGHT

MAX_STEPS = 12
"""Newton steps to the impact; four suffice where the series is accurate."""

PEAK_STEPS = 6
"""Newton steps to the peak, which is close to half the duration."""


@kernel
def follow_short_flights(pulse: Record, group: Record, sign: float) -> None:
    """Follow the flights; sets `ended` to `IMPACT`, with `length`, `end_w` and `top`, or to `IN_FLIGHT` if it is long.

    q is positive at both ends of the flight and monotone between, on one piece of the pulse, so that z has one zero.
    The peak is computed only if it can exceed the largest so far.
    """
    start_arcs(pulse, group, sign)
    expand_start(pulse, group)
    phase, w0, q0 = load(group.columns, PHASE), load(group.columns, W0), load(group.q0, 0)
    reach = load(group.reach, 0)
    h = 2.0 * w0 / q0
    todo, done = fill_mask(True), fill_mask(False)
    for _ in range(MAX_STEPS):
        z, w = series_states(pulse, group, h)
        over_h = z / h
        step = z / (w - over_h)
        h = select(todo, h - step, h)
        todo = todo & (h > 0.0) & (h <= reach)
        arrived = todo & (absolute(step) <= 1e-8 * h)
        done, todo = done | arrived, todo & ~arrived
        if not any_lane(todo):
            break
    z, w = series_states(pulse, group, h)
    end = phase + load(group.columns, OMEGA) * h
    set_angles(pulse, group, end)
    done = done & (end <= piece_ends(pulse, phase)) & (restoring_acceleration(pulse, group) > 0.0)
    top = splat(0.0)
    higher = done & (0.5 * w0 * h > load(group.columns, PEAK))
    if any_lane(higher):
        time, tenth = 0.5 * h, 1e-4 * h
        for _ in range(PEAK_STEPS):
            _, here = series_states(pulse, group, time)
            _, beside = series_states(pulse, group, time + tenth)
            time = time - here * tenth / (beside - here)
        peak, _ = series_states(pulse, group, time)
        top = select(higher, peak, top)
    store(group.length, 0, h)
    store(group.end_w, 0, w)
    store(group.top, 0, top)
    store(group.ended, 0, select(done, splat(float(IMPACT)), splat(float(IN_FLIGHT))))
