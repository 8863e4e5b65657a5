"""Solver states for tests that call single kernels."""

import rocking
from rocking._excitation.pulses import AbstractPulse
from rocking._numba.compilation import Record, kernel
from rocking._solver.kernels.event_loop import init_state, start_flight
from rocking._solver.rules import set_body
from rocking._solver.state import IN_FLIGHT, block_cell, pulse_state
from rocking._solver.taylor.flight import process_step, start_steps
from rocking._solver.taylor.lane_events import locate_events
from rocking._solver.taylor.step import take_step


def cell(pulse: str | AbstractPulse, slenderness: float, omega: float, alpha: float = 0.0, eta: float = 0.9) -> Record:
    flight = pulse_state(rocking.pulse(pulse) if isinstance(pulse, str) else pulse).copy()
    set_body(flight, block_cell(omega, slenderness, eta, alpha), False)
    init_state(flight, omega)
    return flight


def first_flight(pulse: str | AbstractPulse, slenderness: float, omega: float, alpha: float = 0.0) -> Record:
    flight = cell(pulse, slenderness, omega, alpha)
    assert start_flight(flight)
    return flight


def flight_from(flight: Record, phase: float, w: float, sign: float) -> Record:
    flight["at_rest"], flight["next_phase"], flight["next_w"], flight["next_sign"] = 0, phase, w, sign
    assert start_flight(flight)
    return flight


@kernel
def flight_by_steps(flight: Record, steps: Record) -> tuple[int, float, float]:
    """Follow one flight in the first lane, the others being unused; what `process_step` returns at its end."""
    for lane in range(len(steps.in_use)):
        steps.in_use[lane] = 0.0
    steps.omega[0] = flight.omega
    start_steps(flight, steps, 0)
    ended, w, z = IN_FLIGHT, 0.0, 0.0
    while ended == IN_FLIGHT:
        take_step(steps)
        locate_events(steps)
        ended, w, z = process_step(flight, steps, 0)
    return ended, w, z
