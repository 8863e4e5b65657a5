"""The declared fields of a response are those of the classes, records, files and pages that derive from them."""

import re

import numpy as np
import pytest

import rocking
from rocking._solver.peak_response import peak_response

GROUPS = {"slenderness": 0.4, "frequency_ratio": 5.0, "restitution": 0.85}


def test_data_set_of_one_response():
    found = peak_response("-sine", **GROUPS).to_xarray()
    assert float(found.peak_rotation) == pytest.approx(0.553568707, abs=1e-9)
    assert found.attrs == {"pulse": "-sine"}
    assert {name: float(found[name]) for name in found.coords} == GROUPS | {"alpha": 0.0}
    for name in found.data_vars:
        assert {"units", "long_name", "equation"} <= set(found[name].attrs)
    assert not bool(found.overturned)


def test_an_axis_is_named_after_the_argument_that_varies_along_it():
    s, w, eta = np.linspace(0.2, 0.8, 3), np.array([1.0, 2.0, 5.0, 9.0]), np.array([0.8, 0.9])
    found = peak_response("c1", slenderness=s[:, None, None], frequency_ratio=w[:, None], restitution=eta, alpha=0.2)
    labelled = found.to_xarray()
    assert labelled.peak_rotation.dims == ("slenderness", "frequency_ratio", "restitution")
    one = peak_response("c1", slenderness=s[1], frequency_ratio=w[2], restitution=eta[0], alpha=0.2).peak_rotation
    picked = labelled.peak_rotation.sel(slenderness=s[1], frequency_ratio=w[2], restitution=eta[0])
    np.testing.assert_array_equal(picked, one)


def test_arguments_that_vary_together_are_coordinates_of_one_axis():
    found = peak_response("sine", slenderness=[0.2, 0.5], frequency_ratio=[3.0, 4.0], restitution=0.9)
    assert found.to_xarray().peak_rotation.dims == ("dim_0",)
    named = found.to_xarray(("block",))
    assert named.slenderness.dims == named.frequency_ratio.dims == ("block",)
    with pytest.raises(rocking.InvalidArgumentError, match="1 name"):
        found.to_xarray(("block", "pulse"))


@pytest.mark.parametrize(
    ("groups", "words"),
    [
        ({}, "under sine: rocks and comes to rest: peak rotation 0.553569 alpha, 1 impact"),
        ({"slenderness": 1.2}, "under sine: never uplifts"),
        ({"slenderness": 0.05}, "under sine: overturns without impact, 0 impacts"),
        (
            {"slenderness": [1.2, 0.4]},
            "of 2 blocks: 1 never uplift, 1 rock and come to rest, largest peak rotation 0.55",
        ),
        ({"slenderness": [[0.05, 0.05]]}, "of 1 x 2 blocks: 2 overturn without impact"),
        ({"slenderness": []}, "of 0 blocks"),
    ],
)
def test_repr_describes_the_outcome(groups, words):
    shown = repr(peak_response("sine", **GROUPS | groups))
    assert words in shown
    assert len(shown) < 200
    assert not re.search(r"array|nan", shown)
