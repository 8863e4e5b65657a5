"""Free rocking: energy is conserved between impacts, reduced at impacts, and determines the outcome."""

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rocking
from rocking._solver.free_rocking import highest_rotation
from tests.kernels import free_outcome

ALPHAS = st.one_of(st.just(0.0), st.floats(-8, 0.19).map(lambda x: 10**x))


def left_to_climb(z, alpha):
    """X(z): 1 - z, or (2/alpha) sin(alpha (1 - z)/2), in multi-precision."""
    z, alpha = mpmath.mpf(z), mpmath.mpf(alpha)
    return 1 - z if alpha == 0 else 2 / alpha * mpmath.sin(alpha * (1 - z) / 2)


@given(z=st.floats(0, 0.999), w=st.floats(1e-6, 3), eta=st.floats(0, 1), alpha=ALPHAS)
def test_a_rising_block_turns_at_the_height_given_by_its_energy(z, w, eta, alpha):
    assume(z < math.pi / 2 / alpha if alpha > 0 else True)
    escapes, peak, after = free_outcome(z, w, eta, alpha)
    with mpmath.workprec(160):
        energy = left_to_climb(z, alpha) ** 2 - mpmath.mpf(w) ** 2  # of X, conserved
        assert (escapes == 1) == (energy <= 0)
        if escapes == 0:
            assert after == 0
            spent = left_to_climb(peak, alpha) ** 2 - energy
            # change due to one ulp of z or of the peak
            assert abs(spent) <= 1e-14 * left_to_climb(0.0, alpha) ** 2
            assert z <= peak * (1 + 1e-15)
            assert peak < 1


@given(z=st.floats(0, 1.5), w=st.floats(-3, 0), eta=st.floats(0, 1), alpha=ALPHAS)
def test_a_falling_block_overturns_after_at_most_one_impact(z, w, eta, alpha):
    assume(z < math.pi / 2 / alpha if alpha > 0 else True)
    escapes, peak, after = free_outcome(z, w, eta, alpha)
    with mpmath.workprec(160):
        barrier = left_to_climb(0.0, alpha)
        x = left_to_climb(z, alpha)
        if w >= x:
            assert escapes == 1
            return
        squared = mpmath.mpf(w) ** 2 + barrier**2 - x**2  # of the impact velocity
        rebound = mpmath.mpf(eta) ** 2 * squared
        assume(abs(rebound - barrier**2) > 1e-13)
        assert escapes == (2 if rebound >= barrier**2 else 0)
        if escapes == 0:
            climbed = float(barrier**2 - left_to_climb(peak, alpha) ** 2)
            if after == 1:
                assert peak > z
                assert climbed == pytest.approx(float(rebound), abs=3e-15 * float(barrier) ** 2)
            else:
                assert peak == z
                assert rebound <= climbed + 3e-15


@pytest.mark.parametrize("alpha", [0.0, 1e-8, 1e-3, 0.3, 1.2])
@pytest.mark.parametrize("velocity", [1e-12, 1e-7, 1e-3, 0.3])
def test_small_rotations_keep_their_digits(alpha, velocity):
    with mpmath.workprec(200):
        barrier = left_to_climb(0.0, alpha)
        left = mpmath.sqrt(barrier**2 - mpmath.mpf(velocity) ** 2)
        if alpha == 0:
            true = 1 - left
        else:
            half = mpmath.mpf(alpha) / 2
            true = (half - mpmath.asin(half * left)) / half
        found = highest_rotation(velocity**2, float(left), float(barrier), alpha)
    assert found == pytest.approx(float(true), rel=4e-15)


@pytest.mark.parametrize("alpha", [None, 1e-7, 0.3])
@pytest.mark.parametrize("eta", [0.5, 0.9, 1.0])
def test_energy_is_conserved_between_impacts_and_reduced_by_eta_squared(alpha, eta):
    history = rocking.time_history(
        "sine", slenderness=0.7, frequency_ratio=6.0, restitution=eta, alpha=alpha, duration=8.0, samples=500
    )
    free = (history.tau.values > history.pulse_end) & (history.rotation.values != 0)
    tau, z, w = history.tau.values[free], np.abs(history.rotation.values[free]), history.angular_velocity.values[free]
    if alpha is None:
        energy, top = w**2 - (1 - z) ** 2, 1.0
    else:
        top = (2 * math.sin(alpha / 2) / alpha) ** 2
        energy = w**2 - (2 * np.sin(alpha * (1 - z) / 2) / alpha) ** 2
    flights = np.searchsorted(history.impact_time.values, tau, side="right")
    kinetic = []
    for flight in np.unique(flights):
        here = flights == flight
        if here.sum() >= 3:
            np.testing.assert_allclose(energy[here], energy[here][0], rtol=0, atol=1e-14)
            kinetic.append(energy[here].mean() + top)
    assert len(kinetic) >= 2
    for before, after in pairwise(kinetic):
        assert after == pytest.approx(eta**2 * before, rel=1e-9, abs=3e-14)
