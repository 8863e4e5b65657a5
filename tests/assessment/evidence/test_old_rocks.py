"""Survival of old rocks: worked by hand for a step, and records at the scale that overturns."""

import math

import numpy as np
import pytest
import rocking_assessment
import xarray as xr
from rocking_assessment._evidence.old_rocks import survival, unexceeded

import rocking
from benchmarks.accuracy.unexceeded import SUITES, coverage, library
from rocking._base.errors import InvalidArgumentError
from tests.sampling import but_long, number
from tests.suites.motions import noise

STEP = xr.Dataset({"median_intensity": ("model", [4.0]), "dispersion": ("model", [0.0])}, {"model": ["lognormal"]})


def test_a_rock_that_falls_above_an_intensity_worked_by_hand():
    """H = 1e-3 (2/x)^2 a year: of x > 4 there are 2.5e-4 a year, and none in 10,000 years with exp(-2.5)."""
    x = np.array([1.0, 2.0, 5.0, 20.0])
    rate = 1e-3 * (2.0 / x) ** 2
    probability = survival(STEP, (x, np.stack([rate, 0.1 * rate])), years=1e4)
    np.testing.assert_allclose(probability["annual_rate"].sel(model="lognormal"), [2.5e-4, 2.5e-5], rtol=6e-3)
    np.testing.assert_allclose(
        probability["survival"].sel(model="lognormal"), [math.exp(-2.5), math.exp(-0.25)], rtol=2e-2
    )
    alone = survival(STEP, (x, rate), years=1e4)
    assert "branch" not in alone.dims
    xr.testing.assert_allclose(alone["survival"], probability["survival"].isel(branch=0))
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


BLOCK = rocking.Block(0.4, 1.6)


@pytest.fixture(scope="module")
def records():
    """Records and their outcomes at factors 5 % apart; the long run has those of the benchmark."""
    return library(rocking.Block(0.6, 2.0), number(120, 1200), number(0.05, 0.02))


def line_of(pairs, ratio):
    """ln PGA of the pairs at ln(PGV/PGA)."""
    return pairs["intercept"].item() + pairs["slope"].item() * ratio + pairs["margin"].item()


def test_pairs_of_a_few_records():
    motions = [noise(k) for k in range(5)]
    median, certain = (unexceeded(BLOCK, motions, probability=share, resolution=0.02) for share in (0.5, 0.9))
    first = BLOCK.response(motions[0]).thresholds.value[0]
    assert median["overturning_acceleration"][0].item() == pytest.approx(first * motions[0].peak_acceleration, rel=1e-2)
    ratio = np.array([motion.peak_velocity / motion.peak_acceleration for motion in motions])
    for pairs in (median, certain):
        level = np.exp(line_of(pairs, np.log(ratio)))
        tried = level <= 10.0 * BLOCK.uplift_acceleration
        np.testing.assert_allclose(pairs["unexceeded_acceleration"], np.where(tried, level, np.nan))
        np.testing.assert_allclose(pairs["unexceeded_velocity"], pairs["unexceeded_acceleration"] * ratio)
    assert median["margin"].item() == pytest.approx(0.0, abs=1e-12)
    student, prediction = 1.6377444, math.sqrt(5.0 / 3.0 * (1.2 + 1.2 / 2.0))  # of 0.9 with 3 degrees of freedom
    assert certain["margin"] == pytest.approx(1.2 * certain["dispersion"].item() * student * prediction, rel=1e-6)


def test_a_rock_that_survives_above_the_lowest_factor_has_not_overturned():
    """The line is that of the outcomes: it is above the lowest factors, half of whose records survive just above."""
    motions = [noise(k) for k in range(12)]
    limits = unexceeded(BLOCK, motions, probability=0.5, resolution=0.02)
    ratio = np.log([motion.peak_velocity / motion.peak_acceleration for motion in motions])
    line = line_of(limits, ratio)
    lowest = np.log(limits["overturning_acceleration"].values)
    assert (line - lowest).mean() > 0.1
    overturned = 0
    for motion, level in zip(motions, np.exp(line), strict=True):
        scaled = rocking.Record(motion.acceleration * level / motion.peak_acceleration, motion.time_step, "m/s2")
        overturned += BLOCK.response(scaled).overturned
    assert 4 <= overturned <= 9


@pytest.mark.parametrize("size", but_long([5, 8, 12, 20, 30, 60, 100, 500], 5, 20))
@pytest.mark.parametrize("share", but_long([0.8, 0.95], 0.95))
def test_held_out_records_overturn_with_the_stated_probability(records, size, share):
    covered = coverage(records, size, number(60, SUITES[size]), share)
    assert covered.overturned >= share - number(0.03, 0.015)
    assert covered.stated > 0.1


def test_refusals():
    curve = [1.0, 2.0], [1e-2, 1e-3]
    for hazard, years, message in (
        (curve, -1.0, "years"),
        (([1.0, 2.0], [1e-2, math.nan]), 1.0, "hazard rate"),
        ("none.csv", 1.0, r"none\.csv"),
        *((wrong, 1.0, "hazard") for wrong in (5, None, {"a": 1}, [1.0, 2.0, 3.0])),
    ):
        with pytest.raises(InvalidArgumentError, match=message):
            survival(STEP.assign_attrs(measure="pga"), hazard, years=years)
    with pytest.raises(InvalidArgumentError, match="four records"):
        unexceeded(rocking.Block(0.4, 1.6), [noise(1), noise(2)])
