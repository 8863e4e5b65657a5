"""Solver states for tests that call single kernels."""

from rocking._numba.compilation import Record
from rocking.excitation.pulses import AbstractPulse, get_pulse
from rocking.solver.arcs.flight import set_angles
from rocking.solver.kernels.event_loop import init_state, start_flight
from rocking.solver.state import pulse_state


def cell(pulse: str | AbstractPulse, slenderness: float, omega: float, alpha: float = 0.0) -> Record:
    """Return the record of a block at rest before the pulse."""
    flight = pulse_state(get_pulse(pulse) if isinstance(pulse, str) else pulse).copy()
    init_state(slenderness, omega, alpha, flight)
    return flight


def first_flight(pulse: str | AbstractPulse, slenderness: float, omega: float, alpha: float = 0.0) -> Record:
    """The record of a block at the start of its first flight."""
    flight = cell(pulse, slenderness, omega, alpha)
    assert start_flight(flight)
    return flight


def flight_from(flight: Record, phase: float, w: float, sign: float) -> Record:
    """Return the record at the start of a flight after an impact at `phase`."""
    set_angles(flight, phase, flight["cosine0"], flight["sine0"])
    flight["at_rest"], flight["next_phase"], flight["next_w"], flight["next_sign"] = 0, phase, w, sign
    assert start_flight(flight)
    return flight
