"""Many blocks: by arcs one after another, by Taylor steps `LANES` of them side by side.

A lane takes the next question as soon as it is done with one. Questions in a row that differ in eta alone are one
cell: its first flight is followed once.
"""

from __future__ import annotations

from rocking.compilation import Record, Vector, kernel
from rocking.lanes import LANES
from rocking.rock import advance_by_arc, begin, first_flight_again, take_off, touch_down
from rocking.scratch import UNDERWAY
from rocking.taylor_flight import follow_step, start_steps
from rocking.taylor_step import set_block, take_step


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
def next_eta(flight: Record, eta: Vector, answers: Record) -> bool:
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
            while going:
                going = advance_by_arc(flight, eta[flight.cell])
        elif going and take_off(flight):
            return True


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
    answers: Record,
) -> int:
    """Put the next cell that needs Taylor steps into a lane and answer those before it; the first question after it."""
    while following < len(slenderness):
        flight.cell, flight.last = following, following
        while flight.last + 1 < len(slenderness) and same_cell(flight.cell, flight.last + 1, slenderness, omega, alpha):
            flight.last += 1
        following = flight.last + 1
        i = flight.cell
        begin(slenderness[i], omega[i], alpha[i], flight)
        if flight.by_arcs == 1:
            while advance_by_arc(flight, eta[i]):
                pass
        elif take_off(flight):
            set_block(steps, lane, flight.alpha, flight.omega)
            start_steps(flight, steps, lane)
            return following
        next_eta(flight, eta, answers)
    flight.cell = -1
    return following


@kernel
def rock_many(
    slenderness: Vector,
    omega: Vector,
    eta: Vector,
    alpha: Vector,
    flights: Record,
    steps: Record,
    answers: Record,
) -> None:
    """Follow blocks from rest to their final fate.

    Parameters
    ----------
    slenderness, omega, eta, alpha : float arrays (cells,)
        1/a > 0, frequency ratio > 0, restitution in [0, 1] [-]; slenderness angle in [0, pi/2) [rad], 0: slender.
    flights, steps
        The pulse and scratch: an array (LANES,) of records as `scratch.prepared`, and `scratch.prepared_steps`.
    answers : array (cells,) of `scratch.ANSWER`
        Filled.
    """
    following, busy = 0, 0
    for lane in range(LANES):
        following = next_cell(flights[lane], steps, lane, following, slenderness, omega, eta, alpha, answers)
        if flights[lane].cell >= 0:
            busy += 1
    while busy > 0:
        take_step(steps)
        for lane in range(LANES):
            flight = flights[lane]
            if flight.cell < 0:
                continue
            ended, w, z = follow_step(flight, steps, lane)
            if ended == UNDERWAY:
                continue
            flight.length = flight.elapsed
            going = touch_down(flight, eta[flight.cell], ended, w, z, flight.largest) and take_off(flight)
            if going or next_eta(flight, eta, answers):
                start_steps(flight, steps, lane)
                continue
            following = next_cell(flight, steps, lane, following, slenderness, omega, eta, alpha, answers)
            if flight.cell < 0:
                busy -= 1
