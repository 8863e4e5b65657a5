"""A flight by Taylor steps in one lane: any excitation, slender or rigid, with certain detection of impacts.

Given: the start of the flight, and the intervals of the pulse. Decided for each step: whether it holds an impact and
where, whether it holds a peak that can count, and whether the block certainly overturns.

No impact is missed, because a step does not pass the places where q = 1 + F changes its sign. At z = 0 the acceleration
is -(sin(alpha)/alpha) q:

- q > 0, restoring: z = 0 is crossed downwards only, and once. There is an impact if and only if z <= 0 at the end of
  the step.
- q <= 0, destabilised: z'' >= 0 for all z >= 0 up to |theta| = pi/2. z has at most one minimum and no maximum. An
  impact needs w < 0 at the start; then z <= 0 at the end or at the minimum shows it.
- q <= 0 and w >= 0: z increases, nothing happens until the acceleration is restoring again. Such a step may pass the
  end of the destabilising interval.

A damper changes none of this: z'' + 2 zeta z' takes the place of z''. Under a tendon, and a prestress of a rigid body,
z may have a maximum while q <= 0 (`may_turn`). Then each segment holds one sign of q, peaks are searched for on all
steps, and these are so short that z has the zeros above (`rocking._solver.taylor.step.set_restraint_lane`).
"""

import math

from rocking._base.errors import SearchError
from rocking._numba.compilation import Record, kernel
from rocking._solver.restrained_rocking import growing_part
from rocking._solver.rules import known_rotation
from rocking._solver.state import IMPACT, IN_FLIGHT, OVERTURNS, PULSE_END
from rocking._solver.taylor.events import evaluate_series, first_crossing, refine_root, second_derivative_bound
from rocking._solver.taylor.lane_events import UNDECIDED
from rocking._solver.taylor.step import set_edge_lane

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
    """Set the phase at which the steps of this lane must end next: the segment holds one case of the three above."""
    until, count = flight.interval, flight.interval_count
    restoring_phase = steps.phase[lane]
    if steps.w0[lane] >= 0.0 and flight.may_turn == 0:
        # the block rises while it is destabilised: no event before `restoring_phase`, and the segment goes on beyond it
        while until < count and is_destabilised(flight, until):
            until += 1
        if until > flight.interval:
            restoring_phase = flight.interval_phase[until]
    # if that leads to the end of the pulse, the whole segment is destabilised
    destabilised = until == count or is_destabilised(flight, until)
    while until < count and is_destabilised(flight, until) == destabilised:
        until += 1
    steps.restoring_phase[lane], steps.destabilised[lane] = restoring_phase, 1.0 if destabilised else 0.0
    flight.segment_end = until
    steps.limit[lane] = (flight.interval_phase[until] - steps.phase[lane]) / steps.omega[lane]


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
        if z1 > 0.0:  # what goes below zero stays below: no impact
            return -1.0
        # initial guess: the zero of a parabola from z = 0, otherwise a Newton step from the end of the step
        guess = 2.0 * w0 * h / (w0 - w1) if starts_at_ground else h - z1 / w1
        return refine_root(z, lane, order, 0.0, h, True, starts_at_ground, guess)[0]
    if w0 >= 0.0:  # it rises, and goes on rising
        return -1.0
    if z1 <= 0.0:
        return refine_root(z, lane, order, 0.0, h, True, False, h - z1 / w1)[0]
    # above zero at the end: only a minimum inside can lie below zero, which needs a change of the sign of w
    return impact_at_dip(steps, lane) if w1 > 0.0 else -1.0


@kernel
def impact_at_dip(steps: Record, lane: int) -> float:
    """Time of the impact before a minimum of z between w < 0 and w > 0 while the block is destabilised, or -1."""
    z, order = steps.z, steps.order
    if steps.may_turn[lane] > 0.0:  # several minima cannot be excluded
        bound = second_derivative_bound(z, lane, order, steps.h[lane])
        return float(first_crossing(z, lane, order, 0.0, steps.h[lane], True, bound))
    # z is convex there: w has one zero, the minimum, and z falls up to it
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
    if w0 * w1 > 0.0 and min(abs(w0), abs(w1)) > sagitta:  # w keeps its sign
        return 0.0
    max_speed = max(abs(w0), abs(w1)) + sagitta
    # z rises from z0 for a time t, and falls to z1: z <= z0 + v t, z <= z1 + v (h - t), and half the sum bounds it
    if 0.5 * (steps.z0[lane] + z1 + max_speed * h) <= known:
        return 0.0
    start = max(start, 0.0)
    if w0 >= 0.0 > w1:  # a peak for certain: refine it, then show that it is the only one
        top, slope = refine_root(steps.rate, lane, steps.order - 1, start, h, True, False, h * w0 / (w0 - w1))
        reach = max(top - start, h - top)
        if 2.0 * abs(slope) <= bound * reach:  # the bound of the whole step is too large for an early impact
            bound = second_derivative_bound(steps.rate, lane, steps.order - 1, h)
        if 2.0 * abs(slope) > bound * reach:  # |w - slope (t - top)| <= bound (t - top)^2/2: no other zero of w
            return evaluate_series(steps.z, lane, steps.order, top)
    # several zeros of w cannot be excluded: find them one after the other
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
    """Process the events that `locate_events` has found in the step of a lane, and prepare the next step.

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
    if flight.restrained == 1 and flight.alpha == 0.0:
        # (growing_part)' = lambda (growing_part - F): it grows for ever
        if flight.growth > 0.0 and growing_part(flight, z, w) >= flight.a[0]:
            return OVERTURNS, w, z
    elif flight.alpha > 0.0:
        if max(z, flight.largest_z) >= 0.5 * math.pi / flight.alpha:
            return OVERTURNS, w, z
    elif z + w >= 1.0 + flight.a[0]:
        return OVERTURNS, w, z
    steps.z0[lane], steps.w0[lane], steps.starts_at_uplift[lane] = z, w, 0.0
    steps.at_ground[lane], steps.known[lane] = 0.0, max(known_rotation(flight), flight.largest_z)
    if h < steps.limit[lane]:  # the series was exact on a part of the segment only: the next step goes on in it
        steps.phase[lane] += steps.omega[lane] * h
        steps.limit[lane] = (flight.interval_phase[flight.segment_end] - steps.phase[lane]) / steps.omega[lane]
        return IN_FLIGHT, w, z
    # the end of the segment, at the phase of the interval itself and not at a sum of steps
    flight.interval = flight.segment_end
    if flight.interval == flight.interval_count:
        return PULSE_END, w, z
    steps.phase[lane] = flight.interval_phase[flight.interval]
    next_segment(flight, steps, lane)
    return IN_FLIGHT, w, z
