"""The slender block under a sum of sinusoids, solved exactly event by event: uplift, impact, rest, peak, fate.

Equation (3.1) with restitution (2.3). Between events the motion is one exact arc (`slender_arcs`); the cuts of
`cuts` prove for every stretch whether it holds an impact or a peak, and bracket it, so that none is missed;
`free_rocking` decides the fate after the pulse.
"""

from __future__ import annotations

import math

import numpy as np

from rocking.compilation import Record, Vector, kernel
from rocking.free_rocking import free_fate
from rocking.slender_chatter import settles
from rocking.cuts import cut
from rocking.slender_events import fly, hop
from rocking.slender_flight import start_flight, turn

IMPACT_LIMIT = 100_000
"""Impacts after which a block that neither rests nor overturns is declared at rest, and flagged as chattering."""

NO_UPLIFT, SAFE, DIRECTLY, AFTER_IMPACT = 0, 1, 2, 3
"""Values of `rocking.Outcome`, as plain integers for the kernels."""


@kernel
def note(record: Vector, noted: int, phase: float, sign: float, w: float) -> int:
    """Write down the start of a flight (sign 0: rest) if there is room; the number of entries."""
    if noted < len(record):
        record[noted, 0], record[noted, 1], record[noted, 2] = phase, sign, w
        noted += 1
    return noted


@kernel
def rock(
    slenderness: float, omega: float, eta: float, flight: Record, record: Vector
) -> tuple[int, float, int, bool, float, float, float, int, int]:
    """One block from rest to its final fate.

    Parameters
    ----------
    slenderness, omega, eta : float
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-].
    flight
        The pulse, and scratch, laid out as in `scratch.layout`.
    record : float array (flights, 3)
        Filled with phase, sign and w at the start of each flight (sign 0: rest) as far as it reaches; may be empty.

    Returns
    -------
    outcome, peak, impacts, chatter, uplift time, time and velocity of the first impact, peak mode, entries recorded
    """
    noted = 0
    count = cut(slenderness, flight) if slenderness < 1.0 else 0
    interval = 0
    while interval < count and flight.cut_level[interval] == 0.0:
        interval += 1
    if interval == count:
        return NO_UPLIFT, 0.0, 0, False, math.nan, math.nan, math.nan, -1, noted
    flight.a = 1.0 / slenderness
    flight.omega = omega
    flight.fastest = 1.0
    for k in range(len(flight.force)):
        flight.rate[k] = omega * flight.multiple[k]
        flight.fastest = max(flight.fastest, flight.rate[k])
    uplift_time = (flight.cut_phase[interval] - flight.cut_phase[0]) / omega
    first_time, first_velocity = math.nan, math.nan
    outcome, peak, mode, impacts, chatter = SAFE, 0.0, -1, 0, False
    at_rest = True
    phase, w, sign = 0.0, 0.0, 0.0
    while True:
        if at_rest:
            while interval < count and flight.cut_level[interval] == 0.0:
                interval += 1
            if interval == count:
                break
            phase, w, sign = flight.cut_phase[interval], 0.0, -flight.cut_level[interval]
            for k in range(len(flight.force)):
                flight.cosine0[k] = flight.cut_cosine[interval, k]
                flight.sine0[k] = flight.cut_sine[interval, k]
        noted = note(record, noted, phase, sign, w)
        start_flight(flight, phase, w, sign, at_rest and interval > 0)
        ended, z = 0, 0.0
        h, w_end, top = hop(flight, (flight.cut_phase[interval + 1] - phase) / omega, peak)
        if h < 0.0:
            ended, h, w_end, z, top = fly(flight, interval, count, eta)
        if top > peak:
            peak, mode = top, 2 * impacts
        if ended == 1:
            escapes, free_peak, after = free_fate(z, w_end, eta)
            if escapes > 0:
                outcome = DIRECTLY if escapes == 1 and impacts == 0 else AFTER_IMPACT
                impacts += escapes - 1
                peak, mode = math.nan, -1
            elif free_peak > peak:
                peak, mode = free_peak, 2 * (impacts + after) + 1
            break
        phase += omega * h
        if impacts == 0:
            first_time, first_velocity = h, sign * w_end
        impacts += 1
        w = -eta * w_end  # (2.3)
        sign = -sign
        while interval < count - 1 and phase >= flight.cut_phase[interval + 1]:
            interval += 1
        turn(flight, phase, flight.cosine0, flight.sine0)
        at_rest = False
        if flight.cut_level[interval] == 0.0:
            if w <= 0.0:
                at_rest = True
            elif impacts >= IMPACT_LIMIT or settles(flight, w, eta, phase, flight.cut_phase[interval + 1], peak):
                at_rest = chatter = True
        elif w <= 0.0:  # eta = 0 while the ground already pushes: up again at once
            sign, w = -flight.cut_level[interval], 0.0
        if at_rest:
            noted = note(record, noted, phase, 0.0, 0.0)
    return outcome, peak, impacts, chatter, uplift_time, first_time, first_velocity, mode, noted


@kernel
def rock_many(
    slenderness: Vector,
    omega: Vector,
    eta: Vector,
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
    """`rock` for each entry of the first three arrays (cells,); fills the last eight (cells,). `flight` as there."""
    record = np.empty((0, 3))
    for i in range(len(slenderness)):
        (
            outcome[i],
            peak[i],
            impacts[i],
            chatter[i],
            uplift_time[i],
            first_time[i],
            first_velocity[i],
            mode[i],
            _,
        ) = rock(slenderness[i], omega[i], eta[i], flight, record)
