"""Volume under the rocking spectrum: limits, additivity, single responses."""

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking.suites import spectrum_volume
from tests.suites.motions import noise

RECORD = noise(3)


def scaled(factor):
    return rocking.Record(factor * RECORD.acceleration, RECORD.time_step, "m/s2")


def test_from_no_uplift_to_overturning():
    still = scaled(0.99 * 9.80665 * np.tan(0.1) / RECORD.peak_acceleration)
    assert spectrum_volume(still, points=4)["mean"] == 0.0
    strong = spectrum_volume(scaled(1e3), points=4)
    assert strong["mean"] == strong["overturned"] == 1.0
    assert strong["volume"].item() == pytest.approx(3.0 * 0.3)


def test_volumes_of_parts_add_up_to_that_of_the_whole():
    full = spectrum_volume(RECORD, points=8)
    parts = [
        spectrum_volume(RECORD, frequency_parameter=p, alpha=alpha, points=4)
        for p in ((1.0, 2.5), (2.5, 4.0))
        for alpha in ((0.1, 0.25), (0.25, 0.4))
    ]
    assert sum(part["volume"].item() for part in parts) == pytest.approx(full["volume"].item(), rel=1e-12)
    assert 0.0 < full["mean"] < 1.0


def test_its_heights_are_responses_of_blocks():
    ends = {"frequency_parameter": (2.0, 2.2), "alpha": (0.2, 0.24)}
    spectrum = spectrum_volume(RECORD, **ends, points=2)
    peaks = [
        rocking.Block.from_slenderness_angle(alpha, 0.75 * 9.80665 / p**2).response(RECORD).peak_rotation
        for p in (2.05, 2.15)
        for alpha in (0.21, 0.23)
    ]
    assert spectrum["mean"].item() == pytest.approx(np.mean(np.minimum(np.nan_to_num(peaks, nan=1.0), 1.0)), rel=1e-9)


def test_refusals():
    for name, value in (("alpha", (0.3, 0.1)), ("alpha", 0.2), ("frequency_parameter", (0.0, 1.0)), ("points", 1)):
        with pytest.raises(InvalidArgumentError, match=name):
            spectrum_volume(RECORD, **{name: value})
