"""The picture of a measured free rocking."""

import numpy as np
import pytest
import rocking_assessment
import xarray as xr
from matplotlib.figure import Figure

from rocking import InvalidArgumentError


def test_a_free_rocking_with_its_residual_in_degrees():
    ax = Figure().subplots()
    time = np.arange(0.0, 4.0, 0.02)
    names = "rotation", "fitted", "residual"
    data = xr.Dataset({name: ("time", np.full(time.size, k)) for k, name in enumerate(names)}, {"time": time})
    rocking_assessment.plot_free_rocking(data.assign(impact_time=("impact", [1.0, 2.0]), offset=0.1, drift=0.0), ax)
    assert [line.get_label() for line in ax.lines] == ["measured", "fitted", "impact", "residual"]
    np.testing.assert_allclose(ax.lines[3].get_ydata(), np.degrees(2.0))
    np.testing.assert_allclose(ax.lines[2].get_ydata(), np.degrees(0.1))
    with pytest.raises(InvalidArgumentError, match=r"identify_free_rocking"):
        rocking_assessment.plot_free_rocking(xr.Dataset())
