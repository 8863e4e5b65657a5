"""Probability of overturning of uncertain bodies against a closed form."""

import numpy as np
import pytest
from rocking_assessment._objects.assess import assess
from rocking_assessment._objects.objects import Object
from rocking_assessment._objects.site import Site
from rocking_assessment._objects.uncertainty import overturning_probability
from scipy import stats

from rocking._base.errors import InvalidArgumentError

SITE = Site(pga=4.0, periods=(0.9, 0.9), shapes=["half_sine"])


def test_normal_width_where_one_width_decides_has_the_probability_of_the_normal_distribution() -> None:
    # a half sine overturns every narrower block, so that P = Phi((critical - mean)/deviation)
    (row,) = assess(Object("block", width=0.3, height=2.0), SITE).rows
    width = stats.norm(row["smallest_width"] * 1.01, 0.02)
    result = overturning_probability(SITE, width=width, height=2.0, samples=8192, seed=1)
    assert result.probability == pytest.approx(width.cdf(row["smallest_width"]), abs=5e-4)
    assert result.interval[0] <= width.cdf(row["smallest_width"]) <= result.interval[1]
    assert result.first_order == {"width": 1.0}
    assert result.samples == 8192


def test_the_input_that_varies_most_matters_most_and_seeds_repeat() -> None:
    (row,) = assess(Object("block", width=0.3, height=2.0), SITE).rows
    inputs = {
        "width": stats.norm(row["smallest_width"], 0.03),
        "height": stats.norm(2.0, 0.01),
        "restitution": stats.uniform(0.8, 0.1),
    }
    result = overturning_probability(SITE, **inputs, samples=512, seed=3)
    assert result.probability == pytest.approx(0.5, abs=0.1)
    assert result.first_order["width"] > 0.8
    assert abs(result.first_order["restitution"]) < 0.05  # no impact before the half sine overturns
    assert result == overturning_probability(SITE, **inputs, samples=512, seed=3)
    uncertain = {"width": stats.norm(0.4, 0.05), "samples": 64, "seed": 1}
    number, text = (overturning_probability(SITE, height=height, **uncertain) for height in (2.0, "200 cm"))
    assert number == text
    assert "width matters most" in repr(result)


def test_a_certain_outcome_has_no_indices() -> None:
    result = overturning_probability(SITE, width=stats.uniform(3.0, 0.1), height=1.0, samples=64)
    assert (result.probability, result.interval) == (0.0, (0.0, 1.0 / 8.0))
    assert np.isnan(result.first_order["width"])


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({"width": 0.4}, "width"),
        ({"width": stats.norm(0.1, 0.2)}, "width"),
        ({"samples": 3}, "samples"),
        *(({name: value}, f"`{name}`") for name, value in (("restitution", "momentom"), ("restitution", 7.0))),
        *(({name: value}, f"`{name}`") for name, value in (("height", "1 kg"), ("mass_height", -1.0))),
    ],
)
def test_impossible_bodies_and_certain_inputs_are_refused(inputs, message) -> None:
    with pytest.raises(InvalidArgumentError, match=message):
        overturning_probability(SITE, **{"width": stats.norm(1, 0.1), "height": 1.0} | inputs)
