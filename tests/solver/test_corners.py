"""Corners of the parameter space: each has a response, without exception, endless loop or unexplained nan."""

import itertools

import numpy as np
import pytest

import rocking
from rocking.model import parameters

SLENDERNESS = (parameters.SLENDERNESS.lower, 1e-3, 0.5, 0.999, 1 - 1e-15)
FREQUENCY_RATIO = (parameters.FREQUENCY_RATIO.lower, 1e-3, 1.0, 1e3, parameters.FREQUENCY_RATIO.upper)
RESTITUTION = (0.0, 0.9, 1 - 1e-12, 1.0)
ALPHA = (0.0, parameters.SMALLEST_ALPHA, 1e-3, 1.2, parameters.ALPHA.upper)


@pytest.mark.slow
@pytest.mark.parametrize("pulse", ["sine", "cosine", "rectangular", "c2", "ricker", "ricker_antisymmetric"])
def test_corners_of_the_parameter_space(pulse: str) -> None:
    groups = np.array(list(itertools.product(SLENDERNESS, FREQUENCY_RATIO, RESTITUTION, ALPHA))).T
    response = rocking.peak_response(
        pulse, slenderness=groups[0], frequency_ratio=groups[1], restitution=groups[2], alpha=groups[3]
    )
    assert np.array_equal(np.isnan(response.peak_rotation), response.overturned)
    standing = response.peak_rotation[~response.overturned]
    assert ((standing >= 0) & np.isfinite(standing)).all()


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("slenderness", 1e-13),
        ("frequency_ratio", 1e-10),
        ("frequency_ratio", 1e10),
        ("alpha", 1e-13),
        ("alpha", 1.5705),
    ],
)
def test_arguments_beyond_the_corners_are_rejected(name: str, value: float) -> None:
    question = {"slenderness": 0.5, "frequency_ratio": 2.0, "restitution": 0.9, "alpha": 0.1, name: value}
    with pytest.raises(rocking.InvalidArgumentError) as refusal:
        rocking.peak_response("sine", **question)
    assert refusal.value.parameter == name
