"""The solver against first principles: (2.1) to (2.3), (3.1), (3.2), (3.4) to (3.6) and (4.1)."""

import numpy as np
import pytest

import rocking
from rocking import paper
from rocking import paper as cf
from tests.direct_integration import integrate

G = 9.81


@pytest.mark.parametrize(
    ("a", "omega", "eta", "impacts"), [(1.3, 1.5, 0.7, 1), (2.5, 5.0, 0.85, 1), (1.12, 1.2, 0.9, 1), (6.0, 9.0, 0.8, 0)]
)
def test_solver_follows_the_equation_of_motion_and_the_law_of_impact(a, omega, eta, impacts):
    direct = integrate(a, omega, eta, most_impacts=9)  # (3.2), (2.3)
    found = rocking.peak_response("sine", slenderness=1 / a, frequency_ratio=omega, restitution=eta)
    assert len(direct.impact_times) >= impacts
    if direct.impact_times:
        assert found.first_impact_time == pytest.approx(direct.impact_times[0], rel=1e-9)
        assert found.first_impact_velocity == pytest.approx(direct.impact_velocities[0], rel=1e-9)
    if not found.overturned:
        assert found.peak_rotation >= direct.peak - 1e-9


def test_response_depends_on_the_groups_only():
    wanted = paper.Groups(frequency_ratio=3.3, slenderness=0.45)  # (3.6)
    peaks = []
    for alpha, p in ((0.1, 2.0), (0.2, 1.1)):
        problem = paper.problem_of_block(
            wanted, paper.GroupSet.SLENDER_BY_BLOCK, alpha=alpha, frequency_parameter=p, gravity=G
        )
        a = float(problem.peak_acceleration) / (G * alpha)
        omega = float(problem.pulse_frequency) / p
        peaks.append(integrate(a, omega, 0.9).peak)
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-9)


@pytest.mark.parametrize(("a", "omega"), [(2.5, 4.0), (4.0, 5.0)])
def test_free_rocking_continues_the_forced_arc(a, omega):
    falling, growing = cf.after_pulse_coefficients(a, omega)
    y, v = cf.state_at_pulse_end(a, omega)  # (3.4) at the end of the pulse
    grown = growing * np.exp(cf.pulse_end(a, omega))
    assert y == pytest.approx((falling + grown) / 2 - 1, rel=1e-11)  # (3.5)
    assert v == pytest.approx((grown - falling) / 2, rel=1e-11)  # (3.5)


def test_rotation_in_the_scale_of_the_pulse():
    a, omega, tau = 2.0, 3.0, 0.7
    A, B = cf.integration_constants(a, omega)
    printed = (
        -1 / a
        + np.sin(omega * tau + cf.uplift_phase(a)) / (omega**2 + 1)
        + (A * np.exp(-tau) + B * np.exp(tau)) / a  # g A/a_g = (A/alpha)/a
    )
    assert cf.rotation(a, omega, tau) / a == pytest.approx(printed, rel=1e-12)  # (4.1)
