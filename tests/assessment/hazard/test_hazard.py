"""Annual rates against closed forms; hazard curves in the formats of OpenQuake and of the USGS, made up."""

import math

import numpy as np
import pytest
import xarray as xr
from rocking_assessment._hazard.curve_files import read_hazard
from rocking_assessment._hazard.rates import annual_rate

from rocking._base.errors import InvalidArgumentError


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
        rate = annual_rate(curves(median, dispersion), hazard)
        expected = np.exp(np.interp(np.log(median), *np.log(hazard)))
        np.testing.assert_allclose(rate.annual_rate, expected, rtol=1e-7)
        assert rate.annual_rate.attrs["units"] == "year-1"


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


OPENQUAKE = """\
#,,,,,,"generated_by='OpenQuake engine 3.26.0', start_date='2026-03-03T07:31:10', kind='mean', \
investigation_time=50.0, imt='PGA'"
lon,lat,depth,poe-0.0050000,poe-0.0500000,poe-0.5000000,poe-1.0000000
8.50000,47.40000,0.00000,1.000000E+00,3.934693E-01,4.987521E-03,0.000000E+00
"""
CURVES = "name,lon,lat,0.0025,0.05,0.5,1.5\nLos Angeles CA,-118.25,34.05,5.2e-01,2.1e-02,1.4e-03,3.0e-05\n"
TOOL = """\
Edition: Dynamic: Conterminous U.S. 2014 (update)
Region: Conterminous U.S.
Vs30: 760 m/s (B/C boundary)
Latitude: 34.05
Longitude: -118.25
0.20 Second Spectral Acceleration
0.0025\t0.1
0.9\t0.05
Peak Ground Acceleration
0.0025\t0.05\t0.5\t1.5
5.2e-1\t2.1e-2\t1.4e-3\t3.0e-5
"""


def written(tmp_path, text, name="PGA/curves.csv"):
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


def test_probabilities_of_openquake_are_rates_of_a_poisson_process(tmp_path):
    curve = read_hazard(written(tmp_path, OPENQUAKE))
    np.testing.assert_allclose(curve, [0.01, 1e-4], rtol=1e-6)  # 1 - exp(-0.5), 1 - exp(-0.005) in 50 years
    np.testing.assert_allclose(curve["intensity"], [0.05 * 9.80665, 0.5 * 9.80665])
    assert curve.attrs["measure"] == "pga"
    assert math.isclose(-math.expm1(-50.0 * curve[0].item()), 0.3934693, rel_tol=1e-6)


@pytest.mark.parametrize("text", [CURVES, TOOL, CURVES.replace("name,", "").replace("Los Angeles CA,", "")])
def test_rates_of_the_usgs(tmp_path, text):
    curve = read_hazard(written(tmp_path, text))
    np.testing.assert_array_equal(curve, [5.2e-1, 2.1e-2, 1.4e-3, 3.0e-5])
    np.testing.assert_allclose(curve["intensity"] / 9.80665, [0.0025, 0.05, 0.5, 1.5])


def test_pgv_is_in_centimetres_a_second(tmp_path):
    curve = read_hazard(written(tmp_path, CURVES, "PGV/curves.csv"))
    np.testing.assert_allclose(curve["intensity"], [0.000025, 0.0005, 0.005, 0.015])
    assert (curve.attrs["measure"], curve["intensity"].attrs["units"]) == ("pgv", "m s-1")
    with pytest.raises(InvalidArgumentError, match="no such file"):
        read_hazard(tmp_path / "PGV" / "none.csv")


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        (OPENQUAKE.replace("imt='PGA'", "imt='SA(0.2)'"), "a.csv", "PGA or PGV"),
        (OPENQUAKE.replace("investigation_time", "time"), "a.csv", "investigation_time"),
        (OPENQUAKE.replace("1.000000E+00", "1.2"), "a.csv", r"\[0, 1\]"),
        (OPENQUAKE.replace("=50.0", "=0"), "a.csv", "year"),
        (OPENQUAKE + OPENQUAKE.splitlines()[-1], "a.csv", "2 sites"),
        (CURVES, "SA0P2/curves.csv", "measure SA0P2"),
        (CURVES.replace(",3.0e-05", ""), "PGA/curves.csv", "cells"),
        (CURVES.replace("2.1e-02", "much"), "PGA/curves.csv", "much"),
        (CURVES.replace("2.1e-02", "0.9"), "PGA/curves.csv", "do not increase"),
        (CURVES.replace("5.2e-01", "0").replace("2.1e-02", "0").replace("1.4e-03", "0"), "PGA/a.csv", "two at least"),
        (TOOL.replace("Peak Ground", "Mean Ground"), "a.txt", "Unified Hazard Tool"),
        (TOOL.replace("1.5\n5.2e-1", "\n5.2e-1"), "a.txt", "hazard"),
        ("", "a.csv", "Unified Hazard Tool"),
        ("pga [s],annual rate\n0.1,1e-3\n", "a.csv", "'0.1 s'"),
        ("pga [g],annual rate\n0.1,1e-3\n0.2\n", "a.csv", "numbers"),
        ("pga [g],annual rate\n0.1,1e-3\n0.2,often\n", "a.csv", "often"),
        ("pga [g],probability in 50 years\n0.1,1e-3\n0.2,1e-4\n", "a.csv", "annual rate"),
        ("\x00\n,lon,lat", "a.csv", "hazard"),
    ],
)
def test_other_files_are_refused_with_the_reason(tmp_path, text, name, message):
    with pytest.raises(InvalidArgumentError, match=message):
        read_hazard(written(tmp_path, text, name))


@pytest.mark.parametrize("header", ["pga [g],annual rate [1/year]", "PGA [gal],annual_rate", "pgv [cm/s], Annual rate"])
def test_a_table_of_ones_own(tmp_path, header):
    curve = read_hazard(written(tmp_path, f"{header}\n0.1,2e-2\n0.4,4e-4\n\n", "own.csv"))
    unit = {"g": 9.80665, "gal": 0.01, "cm/s": 0.01}[header.split("[")[1].split("]")[0]]
    np.testing.assert_allclose(curve["intensity"], [0.1 * unit, 0.4 * unit])
    assert curve.values.tolist() == [2e-2, 4e-4]
    assert curve.attrs["measure"] == header[:3].lower()
