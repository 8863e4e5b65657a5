"""The comparison with `rock.assets`: the number that its page prints, and the reading of a figure."""

import numpy as np
import pytest
from scipy.io import loadmat, savemat

from benchmarks.accuracy.rock_assets import CRITICAL, critical, surface


def test_the_printed_critical_cosine():
    """Eight digits were sought there with a relative tolerance of 1e-8 of the integration."""
    assert critical() == pytest.approx(CRITICAL, rel=1e-7)


def test_the_surface_of_a_figure_is_found(tmp_path):
    """Below axes, beside objects without data."""
    drawn = {"XData": np.arange(3.0), "YData": np.arange(2.0), "ZData": np.ones((2, 3))}
    leaf = {"type": "surface", "properties": drawn, "children": np.zeros(0)}
    axes = {"type": "axes", "properties": {"Tag": "a"}, "children": leaf}
    savemat(tmp_path / "one.mat", {"figure": {"type": "figure", "properties": {"Tag": "f"}, "children": axes}})
    found = surface(loadmat(tmp_path / "one.mat", squeeze_me=True)["figure"])
    np.testing.assert_array_equal(found[2], drawn["ZData"])
