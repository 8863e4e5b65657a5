"""Survival of old rocks: worked by hand for a step, and records at the scale that overturns."""

import math

import numpy as np
import pytest
import rocking_assessment
import xarray as xr
from rocking_assessment._evidence.old_rocks import survival, unexceeded

import rocking
from rocking._base.errors import InvalidArgumentError
from tests.suites.motions import noise

STEP = xr.Dataset({"median_intensity": ("model", [4.0]), "dispersion": ("model", [0.0])}, {"model": ["lognormal"]})


def test_a_rock_that_falls_above_an_intensity_worked_by_hand():
    """H = 1e-3 (2/x)^2 a year: of x > 4 there are 2.5e-4 a year, and none in 10,000 years with exp(-2.5)."""
    x = np.array([1.0, 2.0, 5.0, 20.0])
    rate = 1e-3 * (2.0 / x) ** 2
    found = survival(STEP, (x, np.stack([rate, 0.1 * rate])), years=1e4)
    np.testing.assert_allclose(found["annual_rate"].sel(model="lognormal"), [2.5e-4, 2.5e-5], rtol=6e-3)
    np.testing.assert_allclose(found["survival"].sel(model="lognormal"), [math.exp(-2.5), math.exp(-0.25)], rtol=2e-2)
    alone = survival(STEP, (x, rate), years=1e4)
    assert "branch" not in alone.dims
    xr.testing.assert_allclose(alone["survival"], found["survival"].isel(branch=0))
    assert survival(STEP, xr.DataArray(rate, {"intensity": x}), years=0.0)["survival"].item() == 1.0


def test_hazard_files_are_branches(tmp_path):
    x = np.array([1.0, 2.0, 5.0, 20.0])
    rates = 1e-3 * (2.0 / x) ** 2 * np.array([[0.1], [1.0]])
    files = [tmp_path / "mild.csv", tmp_path / "strong.csv"]
    for file, rate in zip(files, rates, strict=True):
        rows = "".join(f"{a!r},{r!r}\n" for a, r in zip(x.tolist(), rate.tolist(), strict=True))
        file.write_text("pga [m/s2],annual rate [1/year]\n" + rows)
    curve = STEP.assign_attrs(measure="pga")
    expected = survival(curve, (x, rates), years=1e4)
    xr.testing.assert_allclose(survival(curve, files, years=1e4), expected)
    xr.testing.assert_allclose(survival(curve, str(files[1]), years=1e4), expected.isel(branch=1))
    xr.testing.assert_allclose(rocking_assessment.annual_rate(curve, files[1])["annual_rate"], expected.annual_rate[1])
    site = rocking_assessment.Site(records=[noise(0)], hazard=files[1])
    np.testing.assert_allclose(site.hazard, (x, rates[1]))


def test_pairs_that_overturn_are_those_of_the_thresholds():
    block = rocking.Block(0.4, 1.6)
    motions = [noise(k) for k in range(5)]
    found = unexceeded(block, motions, probability=0.5)
    first = block.response(motions[0]).thresholds.value[0]
    assert found["overturning_acceleration"][0].item() == pytest.approx(first * motions[0].peak_acceleration)
    assert np.log(found["overturning_acceleration"]).mean().item() == pytest.approx(
        np.log(found["unexceeded_acceleration"]).mean().item()
    )
    more = unexceeded(block, motions, probability=0.95)
    ratio = np.log(more["unexceeded_velocity"] / found["unexceeded_velocity"])
    np.testing.assert_allclose(ratio, 1.6448536 * found["dispersion"], rtol=1e-6)


def test_refusals():
    curve = [1.0, 2.0], [1e-2, 1e-3]
    for hazard, years, said in (
        (curve, -1.0, "years"),
        (([1.0, 2.0], [1e-2, math.nan]), 1.0, "hazard rate"),
        ("none.csv", 1.0, r"none\.csv"),
        *((wrong, 1.0, "hazard") for wrong in (5, None, {"a": 1}, [1.0, 2.0, 3.0])),
    ):
        with pytest.raises(InvalidArgumentError, match=said):
            survival(STEP.assign_attrs(measure="pga"), hazard, years=years)
    with pytest.raises(InvalidArgumentError, match="four records"):
        unexceeded(rocking.Block(0.4, 1.6), [noise(1), noise(2)])
