"""One block from rest to its final fate, event by event: uplift, impact, rest, uplift again, peak, fate.

Between events the motion is one exact arc where there is one, that is for the slender block (3.1) under sinusoids
(`slender_events`), and a chain of Taylor steps elsewhere (`taylor_flight`), with restitution (2.3) at impact. The cuts
of the pulse (`cuts`) prove for every stretch whether it holds an impact; `free_rocking` decides after the pulse.
"""

from __future__ import annotations

import math

from rocking.chatter import settles
from rocking.compilation import Record, Vector, kernel
from rocking.cuts import cut
from rocking.free_rocking import free_fate
from rocking.scratch import FALLEN, IMPACT
from rocking.slender_events import fly, hop
from rocking.slender_flight import start_flight, turn
from rocking.taylor_flight import fly_steps

IMPACT_LIMIT = 20_000
"""Impacts after which a block that neither rests nor overturns is declared at rest, and flagged as chattering."""

NO_UPLIFT, SAFE, DIRECTLY, AFTER_IMPACT = 0, 1, 2, 3
"""Values of `rocking.Outcome`, as plain integers for the kernels."""


@kernel
def begin(slenderness: float, omega: float, alpha: float, flight: Record) -> None:
    """Set up a cell: the empty answer, the cuts, rest before the first of them."""
    flight.outcome, flight.peak, flight.mode = NO_UPLIFT, 0.0, -1
    flight.impacts, flight.chatter = 0, 0
    flight.uplift_time, flight.first_time, flight.first_velocity = math.nan, math.nan, math.nan
    flight.end_z, flight.end_w, flight.end_sign = 0.0, 0.0, 0.0
    flight.interval, flight.count, flight.at_rest = 0, 0, 1
    if slenderness >= 1.0:
        return
    flight.a, flight.omega, flight.alpha = 1.0 / slenderness, omega, alpha
    flight.fastest = 1.0
    for k in range(len(flight.force)):
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
    for k in range(len(flight.force)):
        flight.cosine0[k] = flight.cut_cosine[flight.interval, k]
        flight.sine0[k] = flight.cut_sine[flight.interval, k]
    if flight.outcome == NO_UPLIFT:
        flight.outcome = SAFE
        flight.uplift_time = (flight.next_phase - flight.end_phase[0]) / flight.omega
    return True


@kernel
def raise_peak(flight: Record, peak: float, mode: int) -> None:
    """Take a later peak if it is higher; of two that differ by rounding the mode of the earlier one stands."""
    if peak > flight.peak * (1.0 + 1e-12):
        flight.mode = mode
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
        raise_peak(flight, peak, 2 * (flight.impacts + after) + 1)


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
    turn(flight, phase, flight.cosine0, flight.sine0)
    flight.at_rest = 0
    if flight.cut_level[flight.interval] == 0.0:
        if flight.next_w <= 0.0:
            flight.at_rest = 1
        elif flight.impacts >= IMPACT_LIMIT or settles(
            flight, flight.next_w, eta, phase, flight.cut_phase[flight.interval + 1], flight.peak
        ):
            flight.at_rest = flight.chatter = 1
    elif flight.next_w <= 0.0:  # eta = 0 while the ground already pushes: up again at once
        flight.next_sign, flight.next_w = -flight.cut_level[flight.interval], 0.0


@kernel
def advance(flight: Record, eta: float) -> bool:
    """Follow the next flight to its end; False if there is none, or if it was the last."""
    if flight.at_rest == 1 and not uplift(flight):
        return False
    lifted = flight.at_rest == 1 and flight.interval > 0
    start_flight(flight, flight.next_phase, flight.next_w, flight.next_sign, lifted)
    ended, z = IMPACT, 0.0
    if flight.alpha == 0.0 and flight.spread == 0.0:
        to_cut = (flight.cut_phase[flight.interval + 1] - flight.phase) / flight.omega
        h, w, top = hop(flight, to_cut, flight.peak)
        if h < 0.0:
            ended, h, w, z, top = fly(flight, eta)
    else:
        ended, h, w, z, top = fly_steps(flight)
    flight.length = h
    raise_peak(flight, top, 2 * flight.impacts)
    if ended != IMPACT:
        conclude(flight, z, w, eta, ended == FALLEN)
        return False
    land(flight, w, eta)
    return True


@kernel
def rock(slenderness: float, omega: float, eta: float, alpha: float, flight: Record) -> None:
    """One block from rest to its final fate; the answer is left in `flight`.

    Parameters
    ----------
    slenderness, omega, eta, alpha : float
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-]; slenderness angle in [0, pi/2) [rad], 0: slender.
    flight
        The pulse, scratch and answer, laid out as in `scratch.layout`.
    """
    begin(slenderness, omega, alpha, flight)
    while advance(flight, eta):
        pass


@kernel
def rock_many(
    slenderness: Vector,
    omega: Vector,
    eta: Vector,
    alpha: Vector,
    flight: Record,
    outcome: Vector,
    peak: Vector,
    impacts: Vector,
    chatter: Vector,
    uplift_time: Vector,
    first_time: Vector,
    first_velocity: Vector,
    mode: Vector,
) -> None:
    """`rock` for each entry of the first four arrays (cells,); fills the last eight (cells,). `flight` as there."""
    for i in range(len(slenderness)):
        rock(slenderness[i], omega[i], eta[i], alpha[i], flight)
        outcome[i] = flight.outcome
        peak[i] = flight.peak
        impacts[i] = flight.impacts
        chatter[i] = flight.chatter
        uplift_time[i] = flight.uplift_time
        first_time[i] = flight.first_time
        first_velocity[i] = flight.first_velocity
        mode[i] = flight.mode
