"""Fragility of objects, one row a direction."""

import numpy as np
import rocking_assessment

import rocking
from tests.suites.motions import noise


def test_an_object_has_the_fragility_of_each_of_its_directions():
    motions, levels = [noise(seed) for seed in range(3)], [2.0, 6.0, 18.0]
    box = rocking_assessment.Object("box", width=0.4, depth=0.6, height=1.6, restitution=0.8)
    fragility = rocking.fragility(motions, box, intensity=levels)
    assert fragility.direction.values.tolist() == ["width", "depth"]
    for direction, width in (("width", 0.4), ("depth", 0.6)):
        block = rocking.fragility(motions, rocking.Block(width, 1.6), intensity=levels, restitution=0.8)
        np.testing.assert_array_equal(fragility.overturned.sel(direction=direction), block.overturned)
    leaning = rocking_assessment.Object("box", width=0.4, height=1.6, offset_width=0.05)
    assert rocking.fragility(motions, leaning, intensity=levels).sizes["record"] == 6
