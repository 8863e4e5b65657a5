"""The solver against first principles: (2.1) to (2.3), (3.1), (3.2), (3.4) to (3.6) and (4.1)."""

import math

import numpy as np
import pytest

import rocking
from rocking import paper
from rocking import paper as cf
from rocking._dimensional.block import Block
from tests.direct_integration import integrate

G = 9.81


def moment_balance(theta, ground, alpha, R, mass=3.0):
    """(2.1), solved for the angular acceleration [rad/s2]."""
    inertia = 4 / 3 * mass * R * R
    side = math.copysign(alpha, theta)
    return (-mass * ground * R * math.cos(side - theta) - mass * G * R * math.sin(side - theta)) / inertia


def equation_2_2(theta, ground, alpha, p):
    side = math.copysign(alpha, theta)
    return p * p * (-math.sin(side - theta) - ground / G * math.cos(side - theta))


@pytest.mark.parametrize("theta", [-0.3, -0.01, 0.02, 0.25])
@pytest.mark.parametrize("ground", [-6.0, 0.0, 3.0])
def test_moment_balance_gives_the_equation_of_motion(theta, ground):
    block = Block.from_slenderness_angle(0.28, 1.4, gravity=G)
    found = moment_balance(theta, ground, block.alpha, block.half_diagonal)  # (2.1)
    expected = equation_2_2(theta, ground, block.alpha, block.frequency_parameter)  # (2.2)
    assert found == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("theta", [-0.7, 0.4])
def test_linearisation_is_the_limit_of_slender_blocks(theta):
    a = 1.7  # ground acceleration in units of g alpha
    errors = []
    for alpha in (1e-2, 1e-3):
        exact = equation_2_2(theta * alpha, a * G * alpha, alpha, 1.0)
        linear = theta * alpha - alpha * math.copysign(1, theta) - a * alpha  # (3.1)
        errors.append(abs(exact / linear - 1))
    assert errors[0] < 2e-3
    assert errors[1] == pytest.approx(errors[0] / 100, rel=0.05)


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
