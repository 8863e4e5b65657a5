"""Short flights of `LANES` blocks by the Taylor series at their start: the impact is the first zero of z/h.

A flight that starts with little velocity lies within the reach of the series at its start, and needs neither arcs nor
parts of the pulse. Impacts that accumulate end such flights.
"""

from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import absolute, any_lane, fill_mask, load, select, splat, store
from rocking._solver.stages import columns as column
from rocking._solver.stages.arcs import expand_start, series_states, start_arcs
from rocking._solver.stages.events import piece_ends
from rocking._solver.stages.excitation import restoring_acceleration, set_angles
from rocking._solver.state import IMPACT, IN_FLIGHT

MAX_STEPS = 12  # steps to the impact or the peak; two suffice where the flight is short


@kernel
def first_guesses(w0: SimdVector, c2: SimdVector, c3: SimdVector, c4: SimdVector) -> Any:
    """Guesses of the times of impact and peak: three Newton steps on z/h and w of the quartic z.

    Its coefficients are `w0`, `c2`, `c3`, `c4`; the parabola gives the first guess.
    """
    h = w0 / (c2 * -1.0)
    time = 0.5 * h
    for _ in range(3):
        h = h - (w0 + h * (c2 + h * (c3 + h * c4))) / (c2 + h * (2.0 * c3 + h * (3.0 * c4)))
        w = w0 + time * (2.0 * c2 + time * (3.0 * c3 + time * (4.0 * c4)))
        time = time - w / (2.0 * c2 + time * (6.0 * c3 + time * (12.0 * c4)))
    return h, time


@kernel
def follow_short_flights(pulse: Record, group: Record, sign: float) -> None:
    """Follow the flights; sets `ended` to `IMPACT`, with `length`, `end_w` and `top`, or to `IN_FLIGHT` if it is long.

    Given: flights that should be short. Decided: the impact, or that the flight is a long one after all. No event is
    missed: a flight counts as short only if q > 0 at both its ends and both lie on one piece of the pulse. q is then
    positive in between, and z has one zero and one peak, which is computed only if it can exceed the largest so far.
    """
    start_arcs(pulse, group, sign)
    expand_start(pulse, group)
    phase, w0 = load(group.columns, column.PHASE), load(group.columns, column.W0)
    reach = load(group.reach, 0)
    series = group.series
    h, time = first_guesses(w0, load(series, 2), load(series, 3), load(series, 4))
    todo, done = fill_mask(True), fill_mask(False)
    # Newton on z/h, which has no zero at the start; a step out of the reach of the series ends the attempt
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
    end = phase + load(group.columns, column.OMEGA) * h
    set_angles(pulse, group, end)
    done = done & (end <= piece_ends(pulse, phase)) & (restoring_acceleration(pulse, group) > 0.0)
    top = splat(0.0)
    higher = done & (0.5 * w0 * h > load(group.columns, column.PEAK))  # a parabola rises to w0 h/4
    if any_lane(higher):
        todo = higher
        time = select((time > 0.0) & (time < h), time, 0.5 * h)
        for _ in range(MAX_STEPS):
            _, here = series_states(pulse, group, time)
            _, beside = series_states(pulse, group, time + 1e-4 * h)
            step = here * (1e-4 * h) / (beside - here)
            time = select(todo, time - step, time)
            # the error of z is proportional to the square of the error of the time
            todo = todo & (absolute(step) > 1e-6 * h)
            if not any_lane(todo):
                break
        peak, _ = series_states(pulse, group, time)
        top = select(higher, peak, top)
    store(group.length, 0, h)
    store(group.end_w, 0, w)
    store(group.top, 0, top)
    store(group.ended, 0, select(done, splat(float(IMPACT)), splat(float(IN_FLIGHT))))
