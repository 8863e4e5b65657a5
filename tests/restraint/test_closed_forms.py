"""Closed forms of restrained slender blocks: published check values, the free block, and the 192-bit integrator."""

import numpy as np
import pytest
from flint import arb

from reference.exact_response import working_precision
from reference.multiprecision import integrate
from rocking import paper, restraint

HELD = {"stiffness": 0.2, "prestress": 0.15, "damping": 0.1}
CLOSE = 1e-10


def outcome(amplitude: float, frequency_ratio: float, restitution: float, pulse: str = "sine") -> bool:
    """Whether the block with `HELD` overturns, by the multi-precision integrator."""
    with working_precision(192):
        groups = {"slenderness": 1 / arb(amplitude), "frequency_ratio": frequency_ratio, "restitution": restitution}
        return integrate(pulse, **groups, **HELD).overturned


@pytest.mark.parametrize(
    ("frequency_ratio", "amplitudes"),
    [
        (2.0, (2.349903, 2.591268, 3.195978)),
        (3.0, (3.63115, 4.102694, 5.295898)),
        (5.0, (7.168129, 8.308823, 11.234083)),
    ],
)
def test_amplitudes_without_impact_of_the_damper(frequency_ratio: float, amplitudes: tuple[float, ...]) -> None:
    """Confirmed from both sides by two integrators."""
    direct = restraint.direct_amplitude(frequency_ratio, damping=[0.0, 0.1, 0.3])
    assert direct == pytest.approx(np.array(amplitudes), abs=6e-7)


def test_amplitudes_of_the_tendon() -> None:
    amplitudes = restraint.overturning_amplitudes(3.0, 0.9, stiffness=0.3, prestress=0.2)
    assert [float(a) for a in amplitudes] == pytest.approx([1.907354, 5.118697, 5.440404], abs=6e-7)


def test_without_restraint_the_amplitudes_are_those_of_the_paper() -> None:
    omega, eta = np.meshgrid([1.0, 2.0, 3.0, 4.0, 5.0], [0.85, 0.9, 0.95])
    for own, printed in zip(
        restraint.overturning_amplitudes(omega, eta), paper.overturning_amplitudes(omega, eta), strict=True
    ):
        assert own == pytest.approx(printed, rel=1e-13)
    assert restraint.limit_amplitude(omega) == pytest.approx(paper.limit_amplitude(omega), rel=1e-13)


@pytest.mark.parametrize("frequency_ratio", [1.0, 2.0, 3.0])
def test_outcome_changes_at_each_amplitude(frequency_ratio: float) -> None:
    amplitudes = restraint.overturning_amplitudes(frequency_ratio, 0.95, **HELD)
    for amplitude, above in zip(amplitudes, (True, False, True), strict=True):
        assert outcome(float(amplitude) * (1.0 + CLOSE), frequency_ratio, 0.95) == above
        assert outcome(float(amplitude) * (1.0 - CLOSE), frequency_ratio, 0.95) != above


@pytest.mark.parametrize("frequency_ratio", [0.7, 2.0, 6.0])
def test_first_impact_is_within_the_pulse_exactly_below_the_limit(frequency_ratio: float) -> None:
    limit = float(restraint.limit_amplitude(frequency_ratio, **HELD))
    with working_precision(192):
        for factor, inside in ((1.0 - CLOSE, True), (1.0 + CLOSE, False)):
            groups = {"slenderness": 1 / arb(limit * factor), "frequency_ratio": frequency_ratio, "restitution": 0.0}
            assert (integrate("sine", **groups, **HELD).first_impact_time is not None) == inside


@pytest.mark.parametrize("pulse", ["sine", "-cosine", "half_sine", "ricker", "c1"])
def test_margins_under_any_pulse_have_the_sign_of_the_outcome(pulse: str) -> None:
    """Overturning without impact depends on no restitution; 0 keeps the block from overturning after one."""
    name = pulse.removeprefix("-")
    for amplitude in (1.5, 4.0, 12.0):
        margin = restraint.margin_without_impact(pulse, amplitude, 2.0, **HELD)
        with working_precision(192):
            groups = {"slenderness": 1 / arb(amplitude), "frequency_ratio": 2.0, "restitution": 0.0}
            response = integrate(name, **groups, **HELD)
        if response.first_impact_time is None:
            assert (margin > 0.0) == response.overturned


def test_margin_after_an_impact_is_the_one_under_a_sine() -> None:
    with working_precision(192):
        groups = {"slenderness": 1 / arb(2.0), "frequency_ratio": 3.0, "restitution": 0.95}
        response = integrate("sine", **groups, **HELD)
        phase = 3.0 * float(response.uplift_time + response.first_impact_time)
        velocity = float(response.first_impact_velocity)
    margin = restraint.margin_after_impact("sine", 2.0, 3.0, 0.95, phase, velocity, **HELD)
    assert margin == pytest.approx(float(restraint.margin_after_one_impact(2.0, 3.0, 0.95, **HELD)), rel=1e-11)


def test_there_is_no_escape_from_stiffness_one_on() -> None:
    assert np.isinf(restraint.direct_amplitude(2.0, stiffness=[1.0, 3.0])).all()
    assert np.isinf(restraint.equilibrium_rotation(1.0))
    assert np.isnan(restraint.limit_amplitude(2.0, stiffness=1.0))
    assert restraint.margin_without_impact("sine", 5.0, 2.0, stiffness=1.5) == -1.0
    assert np.isnan(restraint.overturning_amplitudes(2.0, 0.9, stiffness=1.0).overturns_from)
