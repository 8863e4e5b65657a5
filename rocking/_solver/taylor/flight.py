"""A flight by Taylor steps in one lane: any excitation, slender or rigid, with certain detection of impacts.

At z = 0 the acceleration is -(sin(alpha)/alpha)(1 + F). Where 1 + F > 0 the acceleration is restoring and z = 0 can be
crossed only downwards, once: z < 0 at the end of the step is both necessary and sufficient for an impact. Where
1 + F <= 0 the block is destabilised: z'' >= 0 holds for all z >= 0 up to |theta| = pi/2, and z has at most one minimum
and no maximum. Therefore steps end where a destabilising interval begins, and also where it ends unless z increases:
then no impact is possible until the acceleration is restoring again.
"""

import math

from rocking._base.errors import SearchError
from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import splat, store
from rocking._solver.rules import known_rotation
from rocking._solver.state import IMPACT, IN_FLIGHT, OVERTURNS, PULSE_END
from rocking._solver.taylor.events import evaluate_series, first_crossing, refine_root, second_derivative_bound
from rocking._solver.taylor.lane_events import UNDECIDED, locate_events
from rocking._solver.taylor.step import set_edge_lane, take_step

MAX_STEPS = 1_000_000
"""Largest number of Taylor steps of one flight, a hundred times what is needed. The step size is of the order of
1/max(1, rate); a pulse of 84 pieces lasts 264/rate, and where that is long the growing exponential ends the flight
within about 50 steps."""


@kernel
def is_destabilised(flight: Record, interval: int) -> bool:
    """Whether 1 + F <= 0 in the interval."""
    return flight.interval_level[interval] * flight.sign < 0.0


@kernel
def next_segment(flight: Record, steps: Record, lane: int) -> None:
    """Set the phase at which the steps of this lane must end next."""
    until, count = flight.interval, flight.interval_count
    restoring_phase = steps.phase[lane]
    if steps.w0[lane] >= 0.0:
        while until < count and is_destabilised(flight, until):
            until += 1
        if until > flight.interval:
            restoring_phase = flight.interval_phase[until]
    destabilised = until == count or is_destabilised(flight, until)
    while until < count and is_destabilised(flight, until) == destabilised:
        until += 1
    steps.restoring_phase[lane], steps.destabilised[lane] = restoring_phase, 1.0 if destabilised else 0.0
    flight.segment_end = until
    steps.limit[lane] = (flight.interval_phase[until] - steps.phase[lane]) / steps.omega[lane]


@kernel
def free_lanes(steps: Record) -> None:
    """Mark all lanes as unused."""
    store(steps.in_use, 0, splat(0.0))


@kernel
def start_steps(flight: Record, steps: Record, lane: int) -> None:
    """Set a lane to the start of a flight."""
    flight.elapsed, flight.largest_z = 0.0, 0.0
    set_edge_lane(steps, lane, flight, flight.side)
    steps.phase[lane], steps.z0[lane], steps.w0[lane] = flight.phase, 0.0, flight.w0
    steps.starts_at_uplift[lane] = flight.starts_at_uplift
    steps.strength[lane] = flight.strength
    steps.in_use[lane], steps.at_ground[lane], steps.known[lane] = 1.0, 1.0, known_rotation(flight)
    next_segment(flight, steps, lane)


@kernel
def impact_in_step(steps: Record, lane: int, destabilised: bool, starts_at_ground: bool) -> float:
    """Time of the impact within the step, or -1; `starts_at_ground` if the step starts at z = 0."""
    z, order = steps.z, steps.order
    h, z1, w0, w1 = steps.h[lane], steps.z1[lane], steps.w0[lane], steps.w1[lane]
    if not destabilised:
        if z1 > 0.0:
            return -1.0
        # initial guess: the zero of a parabola from z = 0, otherwise a Newton step from the end of the step
        guess = 2.0 * w0 * h / (w0 - w1) if starts_at_ground else h - z1 / w1
        return refine_root(z, lane, order, 0.0, h, True, starts_at_ground, guess)[0]
    if w0 >= 0.0:
        return -1.0
    if z1 <= 0.0:
        return refine_root(z, lane, order, 0.0, h, True, False, h - z1 / w1)[0]
    return impact_at_dip(steps, lane) if w1 > 0.0 else -1.0


@kernel
def impact_at_dip(steps: Record, lane: int) -> float:
    """Time of the impact before a minimum of z between w < 0 and w > 0 while the block is destabilised, or -1."""
    z, order = steps.z, steps.order
    bottom = first_crossing(steps.rate, lane, order - 1, 0.0, steps.h[lane], False, steps.second_derivative_bound[lane])
    if bottom > 0.0 and evaluate_series(z, lane, order, bottom) <= 0.0:
        return refine_root(z, lane, order, 0.0, bottom, True, False, 0.5 * bottom)[0]
    return -1.0


@kernel
def highest_peak(steps: Record, lane: int, start: float, h: float, z1: float, w1: float, known: float) -> float:
    """Largest peak of z on [start, h] if it can exceed `known`, else 0; z and w are `z1` and `w1` at h."""
    if start >= h:
        return 0.0
    w0, bound = steps.w0[lane], steps.second_derivative_bound[lane]
    sagitta = 0.125 * bound * h * h  # largest distance of w from its chord
    if w0 * w1 > 0.0 and min(abs(w0), abs(w1)) > sagitta:
        return 0.0
    max_speed = max(abs(w0), abs(w1)) + sagitta
    if 0.5 * (steps.z0[lane] + z1 + max_speed * h) <= known:
        return 0.0
    start = max(start, 0.0)
    if w0 >= 0.0 > w1:
        top, slope = refine_root(steps.rate, lane, steps.order - 1, start, h, True, False, h * w0 / (w0 - w1))
        reach = max(top - start, h - top)
        if 2.0 * abs(slope) <= bound * reach:  # the bound of the whole step is too large for an early impact
            bound = second_derivative_bound(steps.rate, lane, steps.order - 1, h)
        if 2.0 * abs(slope) > bound * reach:  # |w - slope (t - top)| <= bend (t - top)^2/2
            return evaluate_series(steps.z, lane, steps.order, top)
    largest = 0.0
    for _ in range(4 * steps.order):  # w has fewer zeros than its degree; rounding may repeat one
        if start >= h:
            return largest
        top = first_crossing(steps.rate, lane, steps.order - 1, start, h, True, bound)
        if top < 0.0:
            return largest
        largest = max(largest, evaluate_series(steps.z, lane, steps.order, top))
        start = top + 1e-9 * h
    raise SearchError("the search for peaks of a Taylor step does not end")


@kernel
def process_step(flight: Record, steps: Record, lane: int) -> tuple[int, float, float]:
    """Process the events of the last step of a lane, which `locate_events` has located, and prepare the next step if
    the flight continues.

    Returns what ended the flight, or `IN_FLIGHT`; w and z there. `flight` holds the time since its start and the
    largest z.
    """
    h, z, w = steps.h[lane], steps.z1[lane], steps.w1[lane]
    destabilised, impact, peak = steps.destabilised[lane] > 0.0, steps.impact[lane], steps.peak[lane]
    # an impact is where z changes its sign over the step, or at the minimum of a destabilised step: z is convex there,
    # so that it is back above zero at the end only if w has changed its sign as well
    if impact >= 0.0:
        h, z, w = impact, 0.0, steps.impact_w[lane]
    elif destabilised and steps.w0[lane] < 0.0 and w > 0.0:
        impact = impact_at_dip(steps, lane)
        if impact >= 0.0:
            h, z, w = impact, 0.0, evaluate_series(steps.rate, lane, steps.order - 1, impact)
    if peak == UNDECIDED:  # a peak up to the impact, on the restored part: z'' >= 0 before it
        restoring_time = (steps.restoring_phase[lane] - steps.phase[lane]) / steps.omega[lane]
        peak = highest_peak(steps, lane, restoring_time, h, z, w, steps.known[lane])
    flight.largest_z = max(flight.largest_z, peak)
    flight.elapsed += h
    if impact >= 0.0:
        return IMPACT, w, z
    # no return from the horizontal, nor from z + w >= 1 + a under an acceleration that |a f| <= a bounds
    if flight.alpha > 0.0:
        if max(z, flight.largest_z) >= 0.5 * math.pi / flight.alpha:
            return OVERTURNS, w, z
    elif z + w >= 1.0 + flight.a[0]:
        return OVERTURNS, w, z
    steps.z0[lane], steps.w0[lane], steps.starts_at_uplift[lane] = z, w, 0.0
    steps.at_ground[lane], steps.known[lane] = 0.0, max(known_rotation(flight), flight.largest_z)
    if h < steps.limit[lane]:
        steps.phase[lane] += steps.omega[lane] * h
        steps.limit[lane] = (flight.interval_phase[flight.segment_end] - steps.phase[lane]) / steps.omega[lane]
        return IN_FLIGHT, w, z
    flight.interval = flight.segment_end
    if flight.interval == flight.interval_count:
        return PULSE_END, w, z
    steps.phase[lane] = flight.interval_phase[flight.interval]
    next_segment(flight, steps, lane)
    return IN_FLIGHT, w, z


@kernel
def flight_by_steps(flight: Record, steps: Record) -> tuple[int, float, float]:
    """Follow one flight in the first lane to its end, as `process_step`."""
    free_lanes(steps)
    steps.omega[0] = flight.omega
    start_steps(flight, steps, 0)
    for _ in range(MAX_STEPS):
        take_step(steps)
        locate_events(steps)
        ended, w, z = process_step(flight, steps, 0)
        if ended != IN_FLIGHT:
            return ended, w, z
    raise SearchError("a flight does not end")
