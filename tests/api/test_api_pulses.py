"""GET /v1/pulses: the catalogue of excitations."""

import numpy as np
import pytest

import rocking
from rocking._excitation.pulses import PULSE_NAMES
from tests.api.conftest import assert_problem


def test_pulses_are_those_of_the_package(client):
    found = client.get("/v1/pulses", params={"samples": 33}).json()["pulses"]
    assert [one["name"] for one in found][: len(PULSE_NAMES)] == list(PULSE_NAMES)
    for one in found[: len(PULSE_NAMES)]:
        pulse = rocking.pulse(one["name"])
        phase = np.linspace(pulse.start, pulse.end, 33)
        np.testing.assert_allclose(one["time"], (phase - pulse.start) / (2 * np.pi), atol=5.1e-5)
        np.testing.assert_allclose(one["acceleration"], pulse.shape(phase), atol=5.1e-5)
        assert one["duration"] == pytest.approx((pulse.end - pulse.start) / (2 * np.pi))
        assert one["definition"].endswith((".", ")"))
    durations = {one["name"]: one["duration"] for one in found}
    assert durations["half_sine"] == durations["rectangular"] == 0.5
    last = next(one for one in found if one["name"] == "mavroeidis_papageorgiou")
    assert {one["name"]: one["default"] for one in last["parameters"]} == {"cycles": 2.0, "phase": 0.0}


def test_samples_are_limited(client):
    assert_problem(client.get("/v1/pulses", params={"samples": 1}), 422, "samples")
