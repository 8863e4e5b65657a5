"""A flight set up for tests that call the compiled kernels one by one."""

from rocking._numba.compilation import Record
from rocking.excitation.pulses import AbstractPulse, get_pulse
from rocking.solver.arcs.flight import turn
from rocking.solver.kernels.event_loop import begin, take_off
from rocking.solver.state import prepared


def cell(pulse: str | AbstractPulse, slenderness: float, omega: float, alpha: float = 0.0) -> Record:
    """The record of a block at rest before the pulse."""
    flight = prepared(get_pulse(pulse) if isinstance(pulse, str) else pulse).copy()
    begin(slenderness, omega, alpha, flight)
    return flight


def first_flight(pulse: str | AbstractPulse, slenderness: float, omega: float, alpha: float = 0.0) -> Record:
    """The record of a block that has just been lifted."""
    flight = cell(pulse, slenderness, omega, alpha)
    assert take_off(flight)
    return flight


def flight_from(flight: Record, phase: float, w: float, sign: float) -> Record:
    """The record, at the start of a flight after an impact at `phase`."""
    turn(flight, phase, flight["cosine0"], flight["sine0"])
    flight["at_rest"], flight["next_phase"], flight["next_w"], flight["next_sign"] = 0, phase, w, sign
    assert take_off(flight)
    return flight
