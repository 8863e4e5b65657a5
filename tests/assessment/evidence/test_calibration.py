"""Blocks from the outcomes of tests that a known block gives."""

import numpy as np
import pytest
from rocking_assessment._evidence.calibration import calibrate

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError
from tests.suites.motions import noise

# the block is a point of the grid of 7
RANGES = {"alpha": (0.1, 0.4), "half_diagonal": (0.2, 2.0), "restitution": (0.72, 0.99)}
BLOCK = rocking.Block.from_slenderness_angle(0.25, 0.8)
SCALES = np.random.default_rng(1).uniform(1.0, 4.0, 60)


@pytest.fixture(scope="module")
def tests():
    motions = []
    for k, scale in enumerate(SCALES):
        shape = noise(k % 12)
        factor = scale * STANDARD_GRAVITY * np.tan(0.25) / shape.peak_acceleration
        motions.append(rocking.Record(factor * shape.acceleration, shape.time_step, "m/s2"))
    return motions, np.array([BLOCK.response(motion, restitution=0.9).overturned for motion in motions])


def test_the_block_is_within_the_intervals(tests):
    block = calibrate(*tests, **RANGES, points=7)
    for name, true in (("alpha", 0.25), ("half_diagonal", 0.8), ("restitution", 0.9)):
        assert block[f"{name}_lower"] <= true <= block[f"{name}_upper"], name
    assert block["right"] > 0.95
    assert block["validated"] >= block["validated_pga"]
    assert block["right"] >= block["validated"]


def test_a_wider_confidence_widens_the_intervals(tests):
    narrow, wide = (calibrate(*tests, **RANGES, points=4, confidence=level) for level in (0.5, 0.999))
    for name in RANGES:
        assert wide[f"{name}_lower"] <= narrow[f"{name}_lower"]
        assert wide[f"{name}_upper"] >= narrow[f"{name}_upper"]


def test_a_threshold_that_divides_the_outcomes_is_found(tests):
    motions, _ = tests
    pga = np.array([motion.peak_acceleration for motion in motions])
    block = calibrate(motions, pga > np.median(pga), **RANGES, points=2)
    assert block["validated_pga"] > 0.9


def test_refusals(tests):
    motions, fell = tests
    for outcomes in (fell[:-1], np.ones(fell.size, dtype=bool), fell.astype(float)):
        with pytest.raises(InvalidArgumentError, match="outcomes"):
            calibrate(motions, outcomes, **RANGES)
    with pytest.raises(InvalidArgumentError, match="alpha"):
        calibrate(motions, fell, **RANGES | {"alpha": (0.4, 0.1)})
