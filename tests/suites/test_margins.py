"""The mildest intensity at which a record overturns a block: on the side of survival of the levels that were tried."""

import numpy as np

import rocking
from rocking._dimensional.thresholds import overturning_scale
from rocking.suites.margins import with_margins
from rocking.suites.outcomes import check_suite, suite_outcomes
from rocking.suites.summary import record_margins
from tests.suites.motions import BLOCK, noise

RECORDS = [noise(seed) for seed in range(3)]
BLOCKS = [BLOCK, rocking.Block(0.8, 4.0)]


def outcomes_of(levels, measure="pga"):
    suite = check_suite(RECORDS, BLOCKS, levels, measure, "momentum")
    return with_margins(suite_outcomes(suite), suite)


def test_margins_do_not_depend_on_the_levels_and_lie_below_those_that_overturn():
    coarse, fine = (outcomes_of(np.geomspace(1.0, 40.0, points)) for points in (6, 20))
    exact = [[overturning_scale(record, block) for record in RECORDS] for block in BLOCKS]
    for outcomes in (coarse, fine):
        overturned = outcomes["overturned"].values.astype(bool)
        levels = np.where(overturned, outcomes["intensity"].values[:, None], np.inf).min(axis=1)
        assert np.isfinite(levels).all()
        assert (outcomes["overturning_intensity"].values < levels).all()
        margins = record_margins(outcomes)
        np.testing.assert_allclose(margins["overturning_scale"], exact, rtol=2e-6)
        stronger = outcomes["intensity"] > outcomes["overturning_intensity"]
        survived = ((outcomes["overturned"] == 0) & stronger).sum("intensity").transpose("block", "record")
        np.testing.assert_array_equal(margins["levels_survived_above"], survived)
        pga = [record.peak_acceleration for record in RECORDS]
        np.testing.assert_allclose(outcomes["overturning_intensity"], margins["overturning_scale"] * pga, rtol=1e-12)


def test_a_block_that_survives_all_levels_has_no_margin():
    outcomes = outcomes_of([0.5, 1.0])
    assert outcomes["overturning_intensity"].isnull().all()
    margins = record_margins(outcomes)
    assert margins["overturning_scale"].isnull().all()
    assert not margins["levels_survived_above"].any()


def test_the_largest_frequency_ratio_at_which_it_overturns_is_the_mildest():
    outcomes = outcomes_of(np.geomspace(0.3, 30.0, 8), "frequency_ratio")
    margins = record_margins(outcomes)
    found, overturned = outcomes["overturning_intensity"].values, outcomes["overturned"].values.astype(bool)
    assert np.isfinite(found).any()
    levels = outcomes["intensity"].values
    for k, n in np.argwhere(np.isfinite(found)):
        assert found[k, n] >= levels[overturned[k, :, n]].max()
        near = check_suite(
            RECORDS[n], BLOCKS[k], found[k, n] * np.array([1.0 - 1e-7, 1.0 + 1e-5]), "frequency_ratio", "momentum"
        )
        assert suite_outcomes(near)["overturned"].values.ravel().tolist() == [1, 0]
        assert margins["overturning_scale"][k, n] == 1.0
        survived = ~overturned[k, :, n] & (levels < found[k, n])
        assert margins["levels_survived_above"][k, n] == survived.sum()
