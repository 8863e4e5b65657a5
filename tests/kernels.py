"""A flight set up for tests that call the compiled kernels one by one."""

from rocking.compilation import Record
from rocking.pulses import AbstractPulse, get_pulse
from rocking.rock import begin, uplift
from rocking.scratch import prepared
from rocking.slender_flight import start_flight


def cell(pulse: str | AbstractPulse, slenderness: float, omega: float, alpha: float = 0.0) -> Record:
    """The record of a block at rest before the pulse."""
    flight = prepared(get_pulse(pulse) if isinstance(pulse, str) else pulse).copy()
    begin(slenderness, omega, alpha, flight)
    return flight


def first_flight(pulse: str | AbstractPulse, slenderness: float, omega: float, alpha: float = 0.0) -> Record:
    """The record of a block that has just been lifted."""
    flight = cell(pulse, slenderness, omega, alpha)
    assert uplift(flight)
    lifted = bool(flight["interval"] > 0)
    start_flight(flight, float(flight["next_phase"]), 0.0, float(flight["next_sign"]), lifted)
    return flight
