"""Friction demand under a suite, and the effect of restitution and sampling: against direct calls."""

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from tests.suites.motions import BLOCK, noise, sampled

LEVELS = [2.5, 4.5, 7.0]


@pytest.fixture(scope="module")
def motions():
    return [noise(seed) for seed in range(5)]


@pytest.fixture(scope="module")
def sensitivity(motions):
    return rocking.suites.suite_sensitivity(motions, BLOCK, intensity=LEVELS, restitution_step=0.1)


def direct(motion, level, *, resampled=False, change=0.0):
    """Whether the block overturns at a level of PGA, by a single call."""
    used = motion.resampled(motion.time_step / 2) if resampled else motion
    eta = min(max(BLOCK.inelastic_restitution + change, 0.0), 1.0)
    return BLOCK.response(used, scale=level / motion.peak_acceleration, restitution=eta).overturned


def test_outcomes_are_those_of_direct_calls(sensitivity, motions):
    fragility = rocking.fragility(motions, BLOCK, intensity=LEVELS)
    for name in ("overturned", "peak_rotation", "exceedances", "fraction_upper"):
        np.testing.assert_array_equal(sensitivity[name], fragility[name])
    for n, level in enumerate(LEVELS):
        for k, motion in enumerate(motions):
            cell = sensitivity.isel(intensity=n, record=k)
            assert bool(cell.overturned_low_restitution) == direct(motion, level, change=-0.1)
            assert bool(cell.overturned_high_restitution) == direct(motion, level, change=0.1)
            assert bool(cell.overturned_resampled) == direct(motion, level, resampled=True)
    for name in ("low_restitution", "high_restitution"):
        assert sensitivity[f"changed_{name}"].max() > 0


def test_friction_demand_is_that_of_the_history(sensitivity, motions):
    for n, k in ((0, 0), (1, 3), (2, 1)):
        scale = LEVELS[n] / motions[k].peak_acceleration
        history = BLOCK.history(motions[k], scale=scale, restitution=BLOCK.inelastic_restitution, contact=True)
        assert float(sensitivity.friction_demand[n, k]) == pytest.approx(
            history.attrs["largest_friction_demand"], rel=1e-9
        )
    ordered = np.sort(sensitivity.friction_demand.values, axis=-1)
    np.testing.assert_array_equal(sensitivity.friction_demand_median, ordered[:, 2])
    np.testing.assert_array_equal(sensitivity.friction_demand_largest, ordered[:, 4])
    assert (sensitivity.friction_demand > np.tan(BLOCK.alpha)).all()


def test_coarse_samples_change_the_outcome_and_are_named(motions):
    fine = sampled("sine", 4.0, samples=2001, name="fine")
    coarse = rocking.Record(fine.acceleration[::200], 200 * fine.time_step, "m/s2", "coarse")
    levels = np.linspace(4.9, 5.3, 5) * BLOCK.uplift_acceleration
    sensitivity = rocking.suites.suite_sensitivity([fine, coarse, motions[0]], [BLOCK], intensity=levels)
    named = {
        name for text in sensitivity.records_changed_by_sampling.values.ravel().tolist() for name in text.split("; ")
    }
    assert "coarse" in named
    assert "fine" not in named
    changed = sensitivity.overturned_resampled != sensitivity.overturned
    np.testing.assert_array_equal(sensitivity.changed_resampled, changed.sum("record"))
    np.testing.assert_allclose(sensitivity.fraction_resampled, sensitivity.overturned_resampled.mean("record"))
    assert sensitivity.resampled_time_step.values.tolist() == [r.time_step / 2 for r in (fine, coarse, motions[0])]


def test_restitution_stays_between_0_and_1(motions):
    sensitivity = rocking.suites.suite_sensitivity(
        motions[0], BLOCK, intensity=[3.0], restitution=0.98, restitution_step=0.5
    )
    assert float(sensitivity.restitution_low) == pytest.approx(0.48)
    assert float(sensitivity.restitution_high) == 1.0


def test_forces_of_equivalent_blocks_are_not_known(motions):
    frame = rocking.EquivalentBlock.rocking_frame(BLOCK, mass_ratio=0.5)
    sensitivity = rocking.suites.suite_sensitivity(motions[0], frame, intensity=[3.0])
    assert np.isnan(sensitivity.friction_demand.item())
    assert sensitivity.overturned.item() == rocking.fragility(motions[0], frame, intensity=[3.0]).overturned.item()


@pytest.mark.parametrize("wrong", [{"restitution_step": 0.0}, {"restitution_step": 1.5}, {"intensity": []}])
def test_invalid_arguments_are_named(motions, wrong):
    with pytest.raises(InvalidArgumentError, match=f"`{next(iter(wrong))}`"):
        rocking.suites.suite_sensitivity(motions[:1], BLOCK, **({"intensity": [3.0]} | wrong))
