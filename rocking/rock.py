"""One block from rest to its final fate, event by event: uplift, impact, rest, uplift again, peak, fate.

Between events the motion is one exact arc where there is one, that is for the slender block (3.1) under sinusoids
(`slender_events`), and a chain of Taylor steps elsewhere (`taylor_flight`), with restitution (2.3) at impact. The cuts
of the pulse (`cuts`) prove for every stretch whether it holds an impact; `free_rocking` decides after the pulse.
"""

from __future__ import annotations

import math

import numpy as np

from rocking.chatter import settles
from rocking.compilation import Record, Vector, kernel
from rocking.cuts import cut
from rocking.free_rocking import free_fate
from rocking.slender_events import fly, hop, sample_arc
from rocking.slender_flight import start_flight, turn
from rocking.taylor_flight import FALLEN, IMPACT, PULSE_END, fly_steps

IMPACT_LIMIT = 100_000
"""Impacts after which a block that neither rests nor overturns is declared at rest, and flagged as chattering."""

NO_UPLIFT, SAFE, DIRECTLY, AFTER_IMPACT = 0, 1, 2, 3
"""Values of `rocking.Outcome`, as plain integers for the kernels."""


@kernel
def begin(slenderness: float, omega: float, alpha: float, flight: Record) -> int:
    """Set up a cell and the empty answer; returns the number of intervals between cuts, 0 if it cannot uplift."""
    flight.outcome, flight.peak, flight.mode = NO_UPLIFT, 0.0, -1
    flight.impacts, flight.chatter = 0, False
    flight.uplift_time, flight.first_time, flight.first_velocity = math.nan, math.nan, math.nan
    flight.end_z, flight.end_w, flight.end_sign = 0.0, 0.0, 0.0
    if slenderness >= 1.0:
        return 0
    flight.a = 1.0 / slenderness
    flight.omega = omega
    flight.alpha = alpha
    flight.fastest = 1.0
    for k in range(len(flight.force)):
        flight.rate[k] = omega * flight.multiple[k]
        flight.fastest = max(flight.fastest, flight.rate[k])
    return cut(slenderness, flight)


@kernel
def conclude(flight: Record, z: float, w: float, eta: float, fallen: bool) -> None:
    """Decide the fate from the state at the end of the pulse, or after a fall during it."""
    flight.end_z, flight.end_w, flight.end_sign = z, w, flight.sign
    escapes, peak, after = (1, 0.0, 0) if fallen else free_fate(z, w, eta, flight.alpha)
    if escapes > 0:
        flight.outcome = DIRECTLY if escapes == 1 and flight.impacts == 0 else AFTER_IMPACT
        flight.impacts += escapes - 1
        flight.peak, flight.mode = math.nan, -1
    elif peak > flight.peak:
        flight.peak, flight.mode = peak, 2 * (flight.impacts + after) + 1


@kernel
def rock(
    slenderness: float,
    omega: float,
    eta: float,
    alpha: float,
    flight: Record,
    tau: Vector,
    rotation: Vector,
    velocity: Vector,
    landings: Vector,
) -> None:
    """One block from rest to its final fate; the answer is left in `flight`.

    Parameters
    ----------
    slenderness, omega, eta, alpha : float
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-]; slenderness angle in [0, pi/2) [rad], 0: slender.
    flight
        The pulse, scratch and answer, laid out as in `scratch.layout`.
    tau : float array (samples,)
        Times from the pulse's start [-], ascending, at which to fill `rotation` theta/alpha and `velocity`
        theta'/(p alpha) as long as the pulse lasts; zero on entry; may be empty.
    landings : float array
        Filled with the times of the impacts as far as it reaches; may be empty.
    """
    count = begin(slenderness, omega, alpha, flight)
    interval = 0
    origin = flight.end_phase[0]
    exact = alpha == 0.0 and flight.spread == 0.0
    phase, w, sign, peak, filled = 0.0, 0.0, 0.0, 0.0, 0
    at_rest = True
    while True:
        if at_rest:
            while interval < count and flight.cut_level[interval] == 0.0:
                interval += 1
            if interval == count:
                return
            phase, w, sign = flight.cut_phase[interval], 0.0, -flight.cut_level[interval]
            for k in range(len(flight.force)):
                flight.cosine0[k] = flight.cut_cosine[interval, k]
                flight.sine0[k] = flight.cut_sine[interval, k]
            if flight.outcome == NO_UPLIFT:
                flight.outcome = SAFE
                flight.uplift_time = (phase - origin) / omega
        start_flight(flight, phase, w, sign, at_rest and interval > 0)
        ended, z = IMPACT, 0.0
        if exact:
            h, w_end, top = hop(flight, (flight.cut_phase[interval + 1] - phase) / omega, flight.peak)
            if h < 0.0:
                ended, h, w_end, z, top = fly(flight, interval, count, eta)
            if filled < len(tau):
                filled = sample_arc(flight, origin, h, tau, filled, rotation, velocity)
        else:
            ended, h, w_end, z, top, filled = fly_steps(
                flight, interval, count, at_rest and interval > 0, origin, tau, filled, rotation, velocity
            )
        if top > flight.peak:
            flight.peak, flight.mode = top, 2 * flight.impacts
        if ended != IMPACT:
            conclude(flight, z, w_end, eta, ended == FALLEN)
            return
        phase += omega * h
        if flight.impacts < len(landings):
            landings[flight.impacts] = (phase - origin) / omega
        if flight.impacts == 0:
            flight.first_time, flight.first_velocity = h, sign * w_end
        flight.impacts += 1
        w = -eta * w_end  # (2.3)
        sign = -sign
        while interval < count - 1 and phase >= flight.cut_phase[interval + 1]:
            interval += 1
        turn(flight, phase, flight.cosine0, flight.sine0)
        at_rest = False
        if flight.cut_level[interval] == 0.0:
            if w <= 0.0:
                at_rest = True
            elif flight.impacts >= IMPACT_LIMIT or settles(
                flight, w, eta, phase, flight.cut_phase[interval + 1], flight.peak
            ):
                at_rest = flight.chatter = True
        elif w <= 0.0:  # eta = 0 while the ground already pushes: up again at once
            sign, w = -flight.cut_level[interval], 0.0


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
    nothing = np.empty(0)
    for i in range(len(slenderness)):
        rock(slenderness[i], omega[i], eta[i], alpha[i], flight, nothing, nothing, nothing, nothing)
        outcome[i] = flight.outcome
        peak[i] = flight.peak
        impacts[i] = flight.impacts
        chatter[i] = flight.chatter
        uplift_time[i] = flight.uplift_time
        first_time[i] = flight.first_time
        first_velocity[i] = flight.first_velocity
        mode[i] = flight.mode
