"""One block from rest to its final fate, event by event: uplift, impact, rest, uplift again, peak, fate.

Between events the motion is one exact arc where there is one, that is for the slender block (3.1) under sinusoids
(`slender_events`), and a chain of Taylor steps elsewhere (`taylor_flight`), with restitution (2.3) at impact. The cuts
of the pulse (`cuts`) prove for every stretch whether it holds an impact; `free_rocking` decides after the pulse. The
first flight does not depend on the restitution: it is kept, and continued for each.
"""

from __future__ import annotations

import math

from rocking._numba.compilation import Record, kernel
from rocking.errors import SearchError
from rocking.solver.arcs.events import fly, hop
from rocking.solver.arcs.flight import start_arc, turn
from rocking.solver.kernels.chatter import settles
from rocking.solver.kernels.free_rocking import free_fate
from rocking.solver.kernels.intervals import cut
from rocking.solver.state import FALLEN, IMPACT, terms_of
from rocking.solver.taylor.flight import fly_steps

IMPACT_LIMIT = 200_000
"""Impacts after which a block that neither rests nor overturns is declared at rest, and flagged as chattering."""

LOBES = 65536
"""Modes kept for the lobes between one rest and the next."""

NO_UPLIFT, SAFE, DIRECTLY, AFTER_IMPACT = 0, 1, 2, 3
"""Values of `rocking.Outcome`, as plain integers for the kernels."""


@kernel
def begin(slenderness: float, omega: float, alpha: float, flight: Record) -> None:
    """Set up a cell: the empty answer, the cuts, rest before the first of them."""
    flight.known = 0
    flight.by_arcs = int(alpha == 0.0 and flight.spread == 0.0)
    flight.outcome, flight.peak, flight.mode = NO_UPLIFT, 0.0, -1
    flight.impacts, flight.chatter = 0, 0
    flight.uplift_time, flight.first_time, flight.first_velocity = math.nan, math.nan, math.nan
    flight.end_z, flight.end_w, flight.end_sign = 0.0, 0.0, 0.0
    flight.interval, flight.count, flight.at_rest = 0, 0, 1
    flight.uplifts, flight.before_uplift = 0, 0
    if slenderness >= 1.0:
        return
    flight.a, flight.omega, flight.alpha = 1.0 / slenderness, omega, alpha
    flight.fastest = 1.0
    for k in range(terms_of(flight)):
        flight.rate[k] = omega * flight.multiple[k]
        flight.fastest = max(flight.fastest, flight.rate[k])
    flight.count = cut(slenderness, flight)


@kernel
def uplift(flight: Record) -> bool:
    """Go from rest to the next uplift; False if there is none."""
    while flight.interval < flight.count and flight.cut_level[flight.interval] == 0.0:
        flight.interval += 1
    if flight.interval == flight.count:
        return False
    flight.next_phase, flight.next_w = flight.cut_phase[flight.interval], 0.0
    flight.next_sign = -flight.cut_level[flight.interval]  # positive ground acceleration: negative rotation
    flight.uplifts, flight.before_uplift = flight.uplifts + 1, flight.impacts
    for k in range(terms_of(flight)):
        flight.cosine0[k] = flight.cut_cosine[flight.interval, k]
        flight.sine0[k] = flight.cut_sine[flight.interval, k]
    if flight.outcome == NO_UPLIFT:
        flight.outcome = SAFE
        flight.uplift_time = (flight.next_phase - flight.end_phase[0]) / flight.omega
    return True


@kernel
def raise_peak(flight: Record, peak: float, impacts: int, free: int) -> None:
    """Take a later peak if it is higher; of two that differ by rounding the mode of the earlier one stands.

    The mode numbers the lobe by the impacts since the last uplift: rest forgets how many went before.
    """
    if peak > flight.peak * (1.0 + 1e-12):
        flight.mode = LOBES * (flight.uplifts - 1) + 2 * (impacts - flight.before_uplift) + free
    flight.peak = max(flight.peak, peak)


@kernel
def conclude(flight: Record, z: float, w: float, eta: float, fallen: bool) -> None:
    """Decide the fate from the state at the end of the pulse, or after a fall during it."""
    flight.end_z, flight.end_w, flight.end_sign = z, w, flight.sign
    escapes, peak, after = (1, 0.0, 0) if fallen else free_fate(z, w, eta, flight.alpha)
    if escapes > 0:
        flight.outcome = DIRECTLY if escapes == 1 and flight.impacts == 0 else AFTER_IMPACT
        flight.impacts += escapes - 1
        flight.peak, flight.mode = math.nan, -1
    else:
        raise_peak(flight, peak, flight.impacts + after, 1)


@kernel
def land(flight: Record, w: float, eta: float) -> None:
    """An impact with velocity w < 0 ends the flight: what starts the next one, or rest."""
    phase = flight.phase + flight.omega * flight.length
    if flight.impacts == 0:
        flight.first_time, flight.first_velocity = flight.length, flight.sign * w
    flight.impacts += 1
    flight.next_phase, flight.next_w, flight.next_sign = phase, -eta * w, -flight.sign  # (2.3)
    while flight.interval < flight.count - 1 and phase >= flight.cut_phase[flight.interval + 1]:
        flight.interval += 1
    if flight.by_arcs == 1:
        turn(flight, phase, flight.cosine0, flight.sine0)
    flight.at_rest = 0
    if flight.cut_level[flight.interval] == 0.0:
        if flight.next_w <= 0.0:
            flight.at_rest = 1
        elif flight.impacts >= IMPACT_LIMIT or settles(
            flight, flight.next_w, eta, phase, flight.cut_phase[flight.interval + 1], flight.peak
        ):
            flight.at_rest = flight.chatter = 1
    else:
        # such an interval holds at most three impacts: in it no flight ends on the side to which the ground pushes
        if flight.impacts > IMPACT_LIMIT + 3 * flight.count:
            raise SearchError("impacts do not end")
        if flight.next_w <= 0.0:  # eta = 0 while the ground already pushes: up again at once
            flight.next_sign, flight.next_w = -flight.cut_level[flight.interval], 0.0


@kernel
def take_off(flight: Record) -> bool:
    """Begin the next flight; False if there is none."""
    if flight.at_rest == 1 and not uplift(flight):
        return False
    flight.lifted = int(flight.at_rest == 1 and flight.interval > 0)
    flight.phase, flight.w0, flight.sign = flight.next_phase, flight.next_w, flight.next_sign
    if flight.by_arcs == 1:
        start_arc(flight)
    return True


@kernel
def touch_down(flight: Record, eta: float, ended: int, w: float, z: float, top: float) -> bool:
    """End a flight of `flight.length` with w and z, and `top` on the way; False if it was the last."""
    if flight.known == 0:
        flight.known, flight.known_end, flight.known_w, flight.known_z, flight.known_top = 1, ended, w, z, top
        flight.known_length, flight.known_phase = flight.length, flight.phase
        flight.known_sign, flight.known_interval = flight.sign, flight.interval
    raise_peak(flight, top, flight.impacts, 0)
    if ended != IMPACT:
        conclude(flight, z, w, eta, ended == FALLEN)
        return False
    land(flight, w, eta)
    return True


@kernel
def first_flight_again(flight: Record, eta: float) -> bool:
    """End the first flight of the cell anew, for another eta; False if it was the last."""
    flight.outcome, flight.peak, flight.mode, flight.impacts, flight.chatter = SAFE, 0.0, -1, 0, 0
    flight.first_time, flight.first_velocity = math.nan, math.nan
    flight.length, flight.phase, flight.sign = flight.known_length, flight.known_phase, flight.known_sign
    flight.interval, flight.uplifts, flight.before_uplift = flight.known_interval, 1, 0
    return touch_down(flight, eta, flight.known_end, flight.known_w, flight.known_z, flight.known_top)


@kernel
def advance_by_arc(flight: Record, eta: float) -> bool:
    """Follow the next flight of a slender block under sinusoids to its end; False if there is none, or no other."""
    if not take_off(flight):
        return False
    to_cut = (flight.cut_phase[flight.interval + 1] - flight.phase) / flight.omega
    ended, z = IMPACT, 0.0
    h, w, top = hop(flight, to_cut, flight.peak)
    if h < 0.0:
        ended, h, w, z, top = fly(flight)
    flight.length = h
    return touch_down(flight, eta, ended, w, z, top)


@kernel
def advance(flight: Record, steps: Record, eta: float) -> bool:
    """The same for any block and pulse."""
    if flight.by_arcs == 1:
        return advance_by_arc(flight, eta)
    if not take_off(flight):
        return False
    ended, w, z = fly_steps(flight, steps)
    flight.length, top = flight.elapsed, flight.largest
    return touch_down(flight, eta, ended, w, z, top)
