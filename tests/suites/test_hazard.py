"""Annual rates against closed forms."""

import math

import numpy as np
import pytest
import xarray as xr

from rocking._base.errors import InvalidArgumentError
from rocking.suites.hazard import annual_rate


def curves(median, dispersion):
    """A data set with fitted curves, as `rocking.fragility` gives."""
    values = {"median_intensity": ("model", [median] * 2), "dispersion": ("model", [dispersion] * 2)}
    return xr.Dataset(values, {"model": ["lognormal", "logistic"]}, {"measure": "pga"})


X = np.geomspace(1e-3, 1e4, 50)


@pytest.mark.parametrize("slope", [1.0, 2.5])
def test_power_law_and_lognormal_curve_have_a_closed_form(slope):
    # H = k0 x^-k: k0 median^-k exp(k^2 beta^2/2) (Cornell et al. 2002, eq. 8)
    rate = annual_rate(curves(3.0, 0.5), (X, 1e-3 * X**-slope)).annual_rate.sel(model="lognormal")
    assert float(rate) == pytest.approx(1e-3 * 3.0**-slope * math.exp(0.5 * (slope * 0.5) ** 2), rel=1e-6)


def test_logistic_curve_has_a_closed_form():
    # E[x^-k] of a log-logistic capacity of scale s is median^-k pi k s/sin(pi k s)
    s = 0.5 * math.sqrt(3.0) / math.pi
    rate = annual_rate(curves(3.0, 0.5), (X, 1e-3 * X**-1.0)).annual_rate.sel(model="logistic")
    assert float(rate) == pytest.approx(1e-3 / 3.0 * math.pi * s / math.sin(math.pi * s), rel=1e-5)


@pytest.mark.parametrize("dispersion", [0.0, 1e-9])
def test_a_step_gives_the_hazard_at_the_median(dispersion):
    hazard = [0.5, 2.0, 5.0], [0.3, 0.01, 1e-4]
    for median in (1.0, 1.23456, 2.0, 3.3333):
        found = annual_rate(curves(median, dispersion), hazard)
        expected = np.exp(np.interp(np.log(median), *np.log(hazard)))
        np.testing.assert_allclose(found.annual_rate, expected, rtol=1e-7)
        assert found.annual_rate.attrs["units"] == "year-1"


def test_intensities_above_the_hazard_curve_are_bounded():
    found = annual_rate(curves(3.0, 0.5), ([0.1, 1.0], [1e-1, 1e-2])).sel(model="lognormal")
    whole = annual_rate(curves(3.0, 0.5), (X, 1e-2 / X)).annual_rate.sel(model="lognormal")
    assert float(found.annual_rate) < float(whole) < float(found.annual_rate_upper)
    assert float(found.annual_rate_upper) == pytest.approx(1e-2, rel=0.1)


def test_labelled_hazard_curve():
    hazard = xr.DataArray(1e-3 / X, {"intensity": X}, dims="intensity")
    xr.testing.assert_identical(annual_rate(curves(3.0, 0.5), hazard), annual_rate(curves(3.0, 0.5), (X, 1e-3 / X)))
    assert np.isnan(annual_rate(curves(math.nan, math.nan), hazard).annual_rate).all()
    with pytest.raises(InvalidArgumentError, match="a hazard curve of pga"):
        annual_rate(curves(3.0, 0.5), hazard.assign_attrs(measure="pgv"))
    with pytest.raises(InvalidArgumentError, match=r"rocking\.fragility"):
        annual_rate(xr.Dataset({"x": 1.0}), hazard)


@pytest.mark.parametrize(
    "hazard",
    [
        ([1.0], [1e-3]),
        ([1.0, 2.0], [1e-3]),
        ([2.0, 1.0], [1e-3, 1e-4]),
        ([1.0, 2.0], [1e-4, 1e-3]),
        ([0.0, 2.0], [1e-3, 1e-4]),
        ([1.0, 2.0], [1e-3, 0.0]),
        ([1.0, 2.0], [1e-3, 1e-4], [0.0]),
        xr.DataArray([1e-3, 1e-4], {"x": [1.0, 2.0]}, dims="x"),
    ],
)
def test_invalid_hazard_curve_is_refused(hazard):
    with pytest.raises(InvalidArgumentError, match="hazard"):
        annual_rate(curves(3.0, 0.5), hazard)
