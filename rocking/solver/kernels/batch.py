"""Many blocks: by arcs one after another, by Taylor steps `LANES` of them side by side.

A lane takes the next question as soon as it is done with one. Questions in a row that differ in eta alone are one
cell: its first flight is followed once. Slender blocks under one sinusoid have an entry of their own, `rock_arcs`:
compiled for a single sinusoid, arcs take three quarters of the time.
"""

from __future__ import annotations

import numpy as np

from rocking._numba.cancellation import stopped
from rocking._numba.compilation import Record, Vector, entry, kernel
from rocking._numba.simd import LANES
from rocking.errors import SearchError
from rocking.solver.kernels.event_loop import advance_by_arc, begin, first_flight_again, take_off, touch_down
from rocking.solver.state import UNDERWAY
from rocking.solver.taylor.flight import MAX_STEPS, follow_step, start_steps
from rocking.solver.taylor.step import set_block, take_step


@kernel
def answer(flight: Record, into: Record) -> None:
    """Write down what became of a cell."""
    into.outcome, into.chatter, into.impacts, into.mode = flight.outcome, flight.chatter, flight.impacts, flight.mode
    into.peak, into.uplift_time = flight.peak, flight.uplift_time
    into.first_time, into.first_velocity = flight.first_time, flight.first_velocity
    into.end_z, into.end_w = flight.end_z, flight.end_w


@kernel
def same_cell(i: int, j: int, slenderness: Vector, omega: Vector, alpha: Vector) -> bool:
    """Whether two questions differ in eta at most."""
    return bool(slenderness[i] == slenderness[j] and omega[i] == omega[j] and alpha[i] == alpha[j])


@kernel
def follow_arcs(flight: Record, eta: float, stop: Vector) -> None:
    """Follow a block by arcs to its end."""
    while advance_by_arc(flight, eta) and not stopped(stop):
        pass


@kernel
def next_eta(flight: Record, eta: Vector, stop: Vector, answers: Record) -> bool:
    """Write down the answer of a cell that is done and go on with its next eta; False if that was the last.

    By Taylor steps it stops where the next flight begins, by arcs it runs to the end.
    """
    while True:
        answer(flight, answers[flight.cell])
        if flight.cell == flight.last:
            return False
        flight.cell += 1
        if flight.known == 0:  # it never took off, whatever eta
            continue
        going = first_flight_again(flight, eta[flight.cell])
        if flight.by_arcs == 1:
            if going:
                follow_arcs(flight, eta[flight.cell], stop)
        elif going and take_off(flight):
            return True


@kernel
def begin_cell(flight: Record, first: int, slenderness: Vector, omega: Vector, alpha: Vector) -> int:
    """Set up the cell of a question; the first question that belongs to another."""
    flight.cell, flight.last = first, first
    while flight.last + 1 < len(slenderness) and same_cell(flight.cell, flight.last + 1, slenderness, omega, alpha):
        flight.last += 1
    begin(slenderness[first], omega[first], alpha[first], flight)
    return flight.last + 1


@kernel
def next_cell(
    flight: Record,
    steps: Record,
    lane: int,
    following: int,
    slenderness: Vector,
    omega: Vector,
    eta: Vector,
    alpha: Vector,
    stop: Vector,
    answers: Record,
) -> int:
    """Put the next cell that needs Taylor steps into a lane and answer those before it; the first question after it."""
    while following < len(slenderness) and not stopped(stop):
        following = begin_cell(flight, following, slenderness, omega, alpha)
        if flight.by_arcs == 1:
            follow_arcs(flight, eta[flight.cell], stop)
        elif take_off(flight):
            set_block(steps, lane, flight.alpha, flight.omega)
            start_steps(flight, steps, lane)
            return following
        next_eta(flight, eta, stop, answers)
    flight.cell = -1
    return following


@entry
def rock_arcs(
    slenderness: Vector, omega: Vector, eta: Vector, alpha: Vector, flight: Record, stop: Vector, answers: Record
) -> None:
    """`rock_many` for slender blocks under one sinusoid: `alpha` is 0, `flight` a record `SINGLE`."""
    following = 0
    while following < len(slenderness) and not stopped(stop):
        following = begin_cell(flight, following, slenderness, omega, alpha)
        follow_arcs(flight, eta[flight.cell], stop)
        next_eta(flight, eta, stop, answers)


@entry
def rock_many(
    slenderness: Vector,
    omega: Vector,
    eta: Vector,
    alpha: Vector,
    flights: Record,
    steps: Record,
    stop: Vector,
    answers: Record,
) -> None:
    """Follow blocks from rest to their final fate.

    Parameters
    ----------
    slenderness, omega, eta, alpha : float arrays (cells,)
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-]; slenderness angle in [0, pi/2) [rad], 0: slender.
    flights, steps
        The pulse and scratch: an array (LANES,) of records as `scratch.prepared`, and `scratch.prepared_steps`.
    stop : uint8 array (1,)
        Once another thread sets it to 1, this returns within a flight or a Taylor step, with answers missing.
    answers : array (cells,) of `scratch.ANSWER`
        Filled.
    """
    following, busy, taken = 0, 0, np.zeros(LANES, dtype=np.int64)
    for lane in range(LANES):
        following = next_cell(flights[lane], steps, lane, following, slenderness, omega, eta, alpha, stop, answers)
        if flights[lane].cell >= 0:
            busy += 1
    while busy > 0 and not stopped(stop):
        take_step(steps)
        for lane in range(LANES):
            flight = flights[lane]
            if flight.cell < 0:
                continue
            ended, w, z = follow_step(flight, steps, lane)
            taken[lane] += 1
            if ended == UNDERWAY:
                if taken[lane] >= MAX_STEPS:
                    raise SearchError("a flight does not end")
                continue
            taken[lane] = 0
            flight.length = flight.elapsed
            going = touch_down(flight, eta[flight.cell], ended, w, z, flight.largest) and take_off(flight)
            if going or next_eta(flight, eta, stop, answers):
                start_steps(flight, steps, lane)
                continue
            following = next_cell(flight, steps, lane, following, slenderness, omega, eta, alpha, stop, answers)
            if flight.cell < 0:
                busy -= 1
