"""`peak_mode` against time histories: impacts and rest before the largest rotation."""

import numpy as np
import pytest

import rocking

MODES_PER_UPLIFT = 65536


def mode_of_history(history):
    """The mode counted in a history, of the first of peaks that are equal; None if it is close to the pulse end."""
    tau, rotation, velocity = history.tau.values, history.rotation.values, history.angular_velocity.values
    top = int(np.argmax(np.abs(rotation) >= 0.999 * np.abs(rotation).max()))
    pulse_end = history.attrs["pulse_end"]
    if abs(tau[top] - pulse_end) < 0.1:
        return None
    rests = (rotation == 0.0) & (velocity == 0.0)  # up to and including the uplift
    uplifts = np.flatnonzero(rests[:top] & ~rests[1 : top + 1])
    impacts = np.count_nonzero((history.impact_time > tau[uplifts[-1]]) & (history.impact_time < tau[top]))
    return MODES_PER_UPLIFT * (uplifts.size - 1) + 2 * impacts + int(tau[top] > pulse_end)


@pytest.mark.parametrize("alpha", [None, 0.3])
@pytest.mark.parametrize(
    ("pulse", "some"),
    [
        ("sine", {0, 3}),
        ("-cosine", {0, 2, 5, 65536, 65539}),
        ("half_sine", {0, 1}),
        ("c2", {2, 4, 6, 65536, 65538}),
        ("ricker", {0, 2, 65536}),
        ("mavroeidis_papageorgiou", {0, 2, 4, 6, 65536}),
    ],
)
def test_the_mode_counts_impacts_since_the_last_uplift_and_tells_free_rocking(pulse, some, alpha):
    random = np.random.default_rng(22)
    n = 60
    s, omega, eta = random.uniform(0.3, 0.95, n), np.exp(random.uniform(-0.5, 2.0, n)), random.uniform(0.1, 1.0, n)
    found = rocking.peak_response(pulse, slenderness=s, frequency_ratio=omega, restitution=eta, alpha=alpha)
    modes = set()
    for i in np.flatnonzero(~found.overturned):
        groups = {"slenderness": s[i], "frequency_ratio": omega[i], "restitution": eta[i]}
        expected = mode_of_history(rocking.time_history(pulse, **groups, alpha=alpha, samples=8000))
        if expected is not None:
            assert found.peak_mode[i] == expected, groups
            modes.add(expected)
    assert modes >= some
