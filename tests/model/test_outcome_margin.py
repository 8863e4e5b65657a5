"""Outcome margin against free rocking by integration and the barrier energy by quadrature."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

import rocking
from rocking._model.energy import outcome_margin

ALPHAS = st.sampled_from([0.0, 1e-6, 0.1, 0.4, 1.2])
EXACT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}


def pull(z, alpha):
    """-z'' in free rocking, (2.2) and (3.1) without ground motion [-]."""
    return math.sin(alpha * (1 - z)) / alpha if alpha > 0 else 1 - z


def barrier_energy(z, alpha):
    """Twice the work of the restoring moment from z to the unstable equilibrium z = 1 [-]."""
    return 2 * quad(pull, z, 1.0, args=(alpha,), epsabs=1e-14, epsrel=1e-13)[0]


def next_impact(z, w, alpha):
    """Impact velocity in free rocking; None without an impact."""

    def falls(_, state):
        return state[0]

    def is_lost(_, state):
        return state[0] - farthest

    falls.terminal, falls.direction = True, -1  # the flight may start at z = 0
    is_lost.terminal = True
    farthest = 2.0 + z
    run = solve_ivp(lambda _, y: [y[1], -pull(y[0], alpha)], (0.0, 60.0), [z, w], events=(falls, is_lost), **EXACT)
    assert run.status == 1
    return None if run.t_events[1].size else float(run.y[1, -1])


def margin(z, w, eta, alpha):
    return float(outcome_margin(*(np.asarray(x, dtype=np.float64) for x in (z, w, eta, alpha))))


@given(z=st.floats(0.01, 1.4), w=st.floats(-1.6, 1.2), eta=st.floats(0.3, 1.0), alpha=ALPHAS)
def test_margin_is_the_energy_beyond_the_barrier(z, w, eta, alpha):
    assume(alpha * z < 1.5)
    barrier = barrier_energy(0.0, alpha)
    left = math.copysign(math.sqrt(abs(barrier_energy(z, alpha))), 1 - z)
    escape = (w - left) / math.sqrt(barrier)
    assume(abs(escape) > 1e-6)  # on the barrier the duration is infinite
    velocity = next_impact(z, w, alpha)
    found = margin(z, w, eta, alpha)
    if velocity is None:
        assert escape > 0
        assert found == pytest.approx(escape, abs=1e-9)
    else:
        rebound = (eta * velocity) ** 2 / barrier - 1  # (3.16)
        assert found == pytest.approx(max(escape, rebound), abs=1e-8)


@pytest.mark.parametrize("alpha", [0.0, 0.3])
@pytest.mark.parametrize("pulse", ["sine", "ricker"])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_tolerance_is_kept_near_an_outcome_boundary(pulse, alpha, tolerance):
    """Near a threshold the peak is sensitive, and cells are solved at full precision whatever the tolerance."""
    for omega in (2.0, 4.0, 7.0):
        threshold = rocking.thresholds(pulse, frequency_ratio=omega, restitution=0.9, alpha=alpha)
        distance = 10.0 ** np.arange(-9, -1)
        beside = threshold.amplitude[:, None] * (1 + np.concatenate([-distance, distance]))
        groups = {"slenderness": 1 / beside.ravel(), "frequency_ratio": omega, "restitution": 0.9, "alpha": alpha}
        exact = rocking.peak_response(pulse, **groups)
        quick = rocking.peak_response(pulse, **groups, relative_tolerance=tolerance)
        np.testing.assert_array_equal(quick.outcome, exact.outcome)
        np.testing.assert_allclose(quick.peak_rotation, exact.peak_rotation, rtol=tolerance)
