"""Free rocking: energy is conserved between impacts and reduced at impacts."""

import math
from itertools import pairwise

import numpy as np
import pytest

import rocking


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
