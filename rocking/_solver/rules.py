"""The rules of events, stated once for pulses and samples, slender and rigid, equal and different edges.

A body rests until the ground acceleration exceeds what one of its edges resists (uplift). It rotates about that edge (a
flight) until the rotation is zero again (impact), and continues about the other edge with the velocity times the
restitution of the edge that it leaves. A body against a wall (one-sided) has an edge of infinite slenderness, which
resists any acceleration: after an impact it rotates about the same edge again, with -eta times its velocity. Impacts
that accumulate end in rest (chatter). When the ground motion has ended, the energy alone decides the outcome.

All functions work on a solver state with the fields `BODY_FIELDS` and `PROGRESS_FIELDS` of `rocking._solver.state`. The
event loops (`rocking._solver.kernels.event_loop` of pulses, `rocking._solver.records.event_loop` of samples) know where
the ground motion is: they find the next uplift, follow flights, and call these functions at each event.

The equation of a flight about the edge s (0: right, sgn(theta) = 1; 1: left), with z = |theta|/alpha, w = dz/dtau and
alpha, p of the right edge, V = 1 + (vertical ground acceleration)/g, F = sgn(theta) a_s f, a_s = a_g/(g tan(alpha_s)):

    z'' = -pull_s (V S + F C),   pull_s = (p_s/p)^2 sin(alpha_s)/alpha,
    S = sin(alpha_s - alpha z)/sin(alpha_s),   C = cos(alpha_s - alpha z)/cos(alpha_s)

It is (2.2) for equal edges and V = 1, and (3.1) as alpha goes to 0. q = V + F is the restoring acceleration at z = 0.
z has one scale on both edges, so that an impact changes the velocity by the restitution alone.

Worked example, slender, eta = 0.9: at u = a f = 1 the block uplifts with theta < 0, about the left edge. It returns
with w = -0.5: the first impact, after which it continues about the right edge with w = 0.45. The pulse ends at z = 0.4,
w = 0.1. X = 1 - z = 0.6 exceeds w, so that the block does not escape; it rises to 1 - sqrt(0.36 - 0.01) = 0.408, and
each further flight is lower: it survives.
"""

import math
from typing import Any

from rocking._numba.compilation import FloatArray, Record, kernel
from rocking._numba.records import copy_fields
from rocking._numba.simd import maximum, square_root
from rocking._solver.free_rocking import barrier_of, highest_rotation, release
from rocking._solver.restrained_rocking import free_flight, set_restraint
from rocking._solver.state import set_empty_response

IMPACT_LIMIT = 200_000
"""After so many impacts a block that neither rests nor overturns is set to rest and flagged as chatter."""

MODES_PER_UPLIFT = 65536  # number of peak modes reserved for the motion between two uplifts from rest
MAX_UPLIFT_MODE = 32_767  # largest number of uplifts that the mode of a peak counts: it is an int32

NO_UPLIFT, RECOVERS, DIRECTLY, AFTER_IMPACT = 0, 1, 2, 3
"""Values of `rocking.Outcome`, as plain integers for the kernels."""


@kernel
def set_edge(state: Record, side: int, slenderness: float, eta: float, ratio: float, stiffness: float) -> None:
    """Set one edge: g tan(alpha_s)/a_g, eta_s, alpha_s/alpha and (p_s/p)^2; the last two are 1 on the right edge."""
    state.slenderness[side], state.a[side], state.eta[side] = slenderness, 1.0 / slenderness, eta
    state.ratio[side], state.stiffness[side] = ratio, stiffness
    state.speed[side] = ratio * math.sqrt(stiffness)


@kernel
def set_body(state: Record, cell: Record, each_side: bool) -> None:
    """Set the body of a `BODY_CELL`; `each_side`: peaks are wanted for each edge, as always where the edges differ."""
    differ = cell.ratio != 1.0 or cell.stiffness != 1.0 or cell.eta[0] != cell.eta[1]
    # pull 0: not known yet, `pulls_of` computes it at the first impact that needs it
    state.alpha, state.pull[0], state.each_side = cell.alpha, 0.0, int(each_side or differ)
    # an edge of infinite slenderness is a wall: the body rebounds, and sgn(theta) stays
    state.turn = -1.0 if max(cell.slenderness[0], cell.slenderness[1]) < math.inf else 1.0
    set_restraint(state, cell)
    set_edge(state, 0, state.level * cell.slenderness[0], cell.eta[0], 1.0, 1.0)
    set_edge(state, 1, state.level * cell.slenderness[1], cell.eta[1], cell.ratio, cell.stiffness)


@kernel
def reset_response(state: Record) -> None:
    """Set the body to rest before the first uplift, with an empty response."""
    state.at_rest, state.uplifts, state.impacts_before_uplift = 1, 0, 0
    set_empty_response(state)
    state.side_peak[0], state.side_peak[1], state.end_sign, state.final_sign = 0.0, 0.0, 0.0, 0.0


@kernel
def set_sign(state: Record, sign: float) -> None:
    """Set sgn(theta) of the flight, the edge about which the body rotates, and sgn(theta) a_s."""
    state.sign, state.side = sign, (0 if sign > 0.0 else 1)
    state.strength = sign * state.a[state.side]


@kernel
def count_uplift(state: Record, time: float) -> None:
    """Count an uplift from rest at `time` since the start of the motion [tau]."""
    state.uplifts, state.impacts_before_uplift = state.uplifts + 1, state.impacts
    if state.outcome == NO_UPLIFT:
        state.outcome, state.uplift_time = RECOVERS, time


@kernel
def known_rotation(state: Record) -> float:
    """Rotation z that a peak of the present flight has to exceed to change the response."""
    return float(state.side_peak[state.side] if state.each_side == 1 else state.peak_rotation)


@kernel
def peak_mode(uplifts: Any, impacts: Any, impacts_before: Any, free: Any) -> Any:
    """Mode of a peak, a number or a SIMD vector: uplifts, impacts since the last of them, whether in free rocking."""
    return MODES_PER_UPLIFT * (uplifts - 1) + 2 * (impacts - impacts_before) + free


@kernel
def update_peak(state: Record, side: int, z: float, impacts: int, free: int) -> None:
    """Take a peak z into the response if it is the largest so far; `impacts`: before it, `free`: 1 in free rocking."""
    if z <= state.side_peak[side]:
        return
    peak = z / state.ratio[side]  # over the angle of the edge itself; z is over the angle of the right edge
    # of two peaks that differ by rounding the earlier one gives the mode, which would else depend on the last digit
    if peak > state.peak_rotation * (1.0 + 1e-12):
        uplifts = min(state.uplifts, MAX_UPLIFT_MODE)
        state.peak_mode = peak_mode(uplifts, impacts, state.impacts_before_uplift, free)
    state.peak_rotation = max(state.peak_rotation, peak)
    state.side_peak[side] = z


@kernel
def count_impact(state: Record, time: float, w: float) -> float:
    """Count an impact with velocity w < 0 at `time` since the first uplift; returns the velocity after it.

    It multiplies sgn(theta) by `state.turn`.
    """
    if state.impacts == 0:
        state.first_impact_time, state.first_impact_velocity = time, state.sign * w
    state.impacts += 1
    return float(-state.eta[state.side] * w)  # (2.3)


@kernel
def overturn(state: Record, further_impacts: int) -> None:
    """Set the outcome of a body that overturns after `further_impacts` more impacts."""
    state.impacts += further_impacts
    state.outcome = DIRECTLY if state.impacts == 0 else AFTER_IMPACT
    state.peak_rotation, state.peak_mode = math.nan, -1
    state.side_peak[0], state.side_peak[1] = math.nan, math.nan
    # each impact takes the body to its other edge; against a wall `turn` is 1 and there is no other one
    state.final_sign = state.sign if further_impacts % 2 == 0 else state.turn * state.sign


@kernel
def final_outcome(state: Record, z: float, w: float, overturns: bool) -> None:
    """Set the outcome from z and w at the end of the motion, or where overturning is certain before it.

    Given: z and w on the present edge, and whether overturning is certain. Decided: whether the body overturns, after
    how many more impacts, and its highest peak. No impact that matters is left out: free rocking loses energy at
    impacts only, by the factor eta_s^2 <= 1 where the body leaves the edge s. So the second flight about an edge starts
    with less energy than the first one, which did not suffice. Two impacts show each edge once.
    """
    side = state.side
    state.end_rotation, state.end_velocity, state.end_sign = z, w, state.sign
    if overturns:
        overturn(state, 0)
        return
    if state.restrained == 1:
        restrained_outcome(state, z, w)
        return
    # in the units of the edge: z over alpha_s, w over alpha_s p_s
    escapes, top, squared = release(z / state.ratio[side], w / state.speed[side], state.alpha * state.ratio[side])
    if escapes:
        overturn(state, 0)
        return
    update_peak(state, side, top * state.ratio[side], state.impacts, 1)
    # Edges that differ: the next impact leads to the other edge, the one after it back to the present one. Equal edges:
    # the next impact decides, unless the body rises (w > 0): then its energy was below the barrier before the impact.
    further = 2 if state.each_side == 1 else (1 if w <= 0.0 else 0)
    for impact in range(1, further + 1):
        other = 1 - side if state.turn < 0.0 else side
        change = state.eta[side] * (state.speed[side] / state.speed[other])
        squared *= change * change  # (2.3): of the velocity after the impact, in the units of the other edge
        edge_alpha = state.alpha * state.ratio[other]
        barrier = barrier_of(edge_alpha)
        left = barrier * barrier - squared
        if left <= 0.0:  # (3.16), (3.17)
            overturn(state, impact)
            return
        top = highest_rotation(squared, math.sqrt(left), barrier, edge_alpha)
        update_peak(state, other, top * state.ratio[other], state.impacts + impact, 1)
        side = other


@kernel
def restrained_outcome(state: Record, z: float, w: float) -> None:
    """Set the outcome of a body with tendon or damper, two equal edges, from z and w at the end of the motion.

    As `final_outcome`, by following the flights: the energy falls in flights and at impacts, and rises with z below the
    equilibrium at w = 0. So no later peak is higher than the first one after the motion, and none escapes after it. A
    body that rises (w > 0) has its first peak in this flight, otherwise in the next one.
    """
    escapes, top, speed, _ = free_flight(state, z, w, w <= 0.0)
    if escapes:
        overturn(state, 0)
        return
    update_peak(state, state.side, top, state.impacts, 1)
    if w > 0.0:
        return
    escapes, top, _, _ = free_flight(state, 0.0, state.eta[state.side] * speed, False)
    if escapes:
        overturn(state, 1)
        return
    update_peak(state, 1 - state.side, top, state.impacts + 1, 1)


@kernel
def pulls_of(state: Record) -> tuple[float, float]:
    """-z'' at z = 0 over q on both edges, (p_s/p)^2 sin(alpha_s)/alpha [-]; sets `softening`, too.

    `softening` bounds |dz''/dz| over V on both edges while |F| <= V, (p_s/p)^2 (1 + tan(alpha_s)) [-]. Both are
    computed once for a body, where they are first needed: most bodies never ask.
    """
    pull, alpha = state.pull, state.alpha
    if pull[0] == 0.0:
        pull[0] = 1.0 if alpha == 0.0 else math.sin(alpha) / alpha
        pull[1], state.softening = pull[0], 1.0 + math.tan(alpha)
        if state.ratio[1] != 1.0 or state.stiffness[1] != 1.0:
            left, stiffness = alpha * state.ratio[1], state.stiffness[1]
            pull[1] = 1.0 if alpha == 0.0 else stiffness * (math.sin(left) / alpha)
            state.softening = max(state.softening, stiffness * (1.0 + math.tan(left)))
        if state.restrained == 1:
            # of F C, of sigma D and of kappa sin(alpha z)/alpha; a damper makes flights lower, shorter and slower
            pull[0], pull[1] = state.level * pull[0], state.level * pull[1]
            state.softening = state.level * state.softening + (state.level - 1.0) + state.spring
    return pull[0], pull[1]


@kernel
def impacts_accumulate(
    state: Record,
    w: float,
    pulls: tuple[float, float],
    window: float,
    right: tuple[float, float],
    left: tuple[float, float],
    vertical: float,
) -> bool:
    """Whether impacts from velocity w > 0 just after an impact certainly accumulate to rest within a time `window`.

    Given: the velocity w, and bounds of the ground acceleration during the window. Decided: whether all further impacts
    can be replaced by rest at the end of the window. The response does not change by it: True only if the times of all
    flights add up to less than the window, and none of the flights can exceed the peak so far.

    Near the ground -z'' lies within pull_s q +- k z, k = V (p_s/p)^2 (1 + tan(alpha_s)), with the restoring
    acceleration q of the edge, which lies in [q1, q2] during the window. A flight from w rises to
    z_m <= w^2/(2 (pull q1 - k z_m)), lasts at most 2 w/(pull q1 - k z_m), and its impact velocity is at most
    w sqrt((pull q2 + k z_m)/(pull q1 - k z_m)). With the restitution this bounds a geometric series. Against a wall all
    flights are about one edge; the other one, where q = V, only widens the bounds.

    `pulls`: of `pulls_of`; `window`: time [tau]; `right`, `left`: smallest and largest q of both edges during it;
    `vertical`: largest V during it.
    """
    right_pull, left_pull = pulls
    weakest = min(right_pull * right[0], left_pull * left[0])
    if weakest <= 0.0:  # the ground lifts the body within the window
        return False
    height = w * w / weakest  # above z_m while k z_m stays below weakest/2
    softening = vertical * state.softening * height
    # the peak that a flight of the series may not exceed, on whichever edge it takes place
    known = state.side_peak[state.side]
    if state.turn < 0.0:
        known = min(state.side_peak[0], state.side_peak[1]) if state.each_side == 1 else state.peak_rotation
    if softening > 0.5 * weakest or height > known:
        return False
    right, left = (right_pull * right[0], right_pull * right[1]), (left_pull * left[0], left_pull * left[1])
    return bool(series_fits(w, window, max(state.eta[0], state.eta[1]), weakest, softening, right, left))


@kernel
def series_fits(w: Any, window: Any, eta: Any, weakest: Any, softening: Any, right: Any, left: Any) -> Any:
    """Whether the series of `impacts_accumulate` ends within a window, a number or a SIMD vector each.

    `right`, `left`: smallest and largest -z'' at z = 0 on both edges, `weakest` the smallest of both; `softening`:
    largest change of -z'' during a flight.
    """
    # most by which a flight can raise the squared velocity: it rises under the weakest pull, falls under the strongest
    spread = maximum((right[1] + softening) / (right[0] - softening), (left[1] + softening) / (left[0] - softening))
    ratio = eta * square_root(spread)  # of the velocities after two impacts in succession
    # the first flight lasts 2 w/(weakest - softening) at most, each one after it `ratio` times the one before
    return (ratio < 1.0) & (2.0 * w <= window * (weakest - softening) * (1.0 - ratio))


@kernel
def write_response(state: Record, response: Record) -> None:
    """Write the response: all declared fields."""
    state.exceeded_alpha = not (state.peak_rotation <= 1.0)  # also where it is nan
    copy_fields(state, response)


@kernel
def write_edges(state: Record, edges: FloatArray, cell: int) -> None:
    """Write what differs from edge to edge, `EDGE_COLUMNS`, if it is wanted."""
    if state.each_side == 1:
        edges[cell, 0], edges[cell, 1] = state.side_peak[0], state.side_peak[1]
        edges[cell, 2], edges[cell, 3] = state.end_sign, state.final_sign
