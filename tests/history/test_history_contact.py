"""Extremes of the contact forces during a motion, the sentences derived from them, and their cost."""

import math

import numpy as np
import pytest
import xarray as xr

import rocking
from rocking._excitation.pulses import PULSE_NAMES
from rocking._history import contact
from rocking._history.contact import MAX_FRICTION, MAX_STEP, MAX_STEPS, PRACTICAL_FRICTION, contact_extremes
from rocking._history.motion import build_motion
from tests.model.test_contact import QUESTIONS
from tests.sampling import ALL


@pytest.mark.parametrize("alpha", [None, 0.1, 0.45])
@pytest.mark.parametrize("pulse", [*PULSE_NAMES])
def test_extremes_are_those_of_a_very_finely_sampled_motion(pulse, alpha):
    for question in QUESTIONS:
        fine = rocking.time_history(pulse, **question, alpha=alpha, contact=True, samples=100_001)
        coarse = rocking.time_history(pulse, **question, alpha=alpha, contact=True, samples=2)
        for name in ("largest_friction_demand_over_slope", "smallest_normal_reaction", "lifts_off"):
            assert fine.attrs[name] == coarse.attrs[name]  # independent of the samples
        until = fine.tau.size
        if fine.overturned:
            until = int(np.flatnonzero(np.abs(fine.rotation.values) <= 1)[-1]) + 1
        demand = fine.friction_demand_over_slope.values[:until].max()
        if np.isfinite(demand):
            assert demand * (1 - 1e-12) <= fine.largest_friction_demand_over_slope
            if not fine.lifts_off:
                assert fine.largest_friction_demand_over_slope == pytest.approx(demand, rel=2e-3)
        lowest = fine.normal_reaction.values[:until].min()
        assert lowest - 5e-3 * (1 + abs(lowest)) <= fine.smallest_normal_reaction <= lowest + 1e-12
        assert fine.largest_friction_demand_over_slope > 1 - 1e-9  # it uplifts


def test_extremes_include_the_instant_before_an_impact():
    # the impact velocity is so large that the normal reaction has its minimum there
    question = {"slenderness": 0.25, "frequency_ratio": 3.0, "restitution": 0.72, "alpha": 0.57}
    impact = rocking.time_history("cosine", **question).impact_time.values[0]
    before = rocking.time_history("cosine", **question, duration=impact * (1 - 1e-9), contact=True)
    whole = rocking.time_history("cosine", **question, contact=True)
    assert before.normal_reaction.values[-1] == pytest.approx(whole.smallest_normal_reaction, abs=1e-6)
    assert whole.normal_reaction.sel(tau=impact) > whole.smallest_normal_reaction + 0.1


def test_a_stocky_block_under_a_strong_pulse_lifts_off(tmp_path):
    question = {"slenderness": 0.2, "frequency_ratio": 12.0, "restitution": 0.85, "alpha": math.radians(45)}
    history = rocking.time_history("sine", **question, contact=True)
    assert history.lifts_off == 1
    assert history.smallest_normal_reaction < 0
    assert history.largest_friction_demand == math.inf
    assert "lifts off" in history.warnings
    pulled = history.normal_reaction.values <= 0
    assert pulled.any()
    np.testing.assert_array_equal(np.isinf(history.friction_demand.values), pulled)
    history.to_netcdf(tmp_path / "history.nc")
    again = xr.load_dataset(tmp_path / "history.nc")
    assert again.largest_friction_demand == math.inf
    np.testing.assert_array_equal(again.friction_demand, history.friction_demand)


def test_extremes_of_an_overturning_block_end_at_the_last_crossing_of_alpha():
    question = {"slenderness": 0.2, "frequency_ratio": 5.0, "restitution": 0.85, "alpha": math.radians(20)}
    history = rocking.time_history("sine", **question, contact=True, samples=50_001)
    assert history.overturned
    last = np.flatnonzero(np.abs(history.rotation.values) <= 1)[-1] + 1
    demand = history.friction_demand.values
    assert history.largest_friction_demand == pytest.approx(demand[:last].max(), rel=1e-6)
    assert (
        demand[last:].max() > 3 * history.largest_friction_demand
    )  # the demand during the fall is larger and is not included
    brief = rocking.time_history("sine", **question, contact=True, duration=0.4)
    assert brief.largest_friction_demand <= history.largest_friction_demand * (1 + 1e-9)


def test_warnings_give_the_demand():
    slides = rocking.time_history(
        "ricker", slenderness=0.2, frequency_ratio=5.0, restitution=0.85, alpha=math.radians(20), contact=True
    )
    assert slides.largest_friction_demand > PRACTICAL_FRICTION
    assert f"{slides.largest_friction_demand:.3g}" in slides.warnings
    impact = rocking.time_history(
        "sine", slenderness=0.6, frequency_ratio=5.0, restitution=0.5, alpha=math.radians(10), contact=True
    )
    assert impact.largest_friction_demand < PRACTICAL_FRICTION < impact.impulse_ratio
    assert "impact" in impact.warnings
    calm = rocking.time_history(
        "sine", slenderness=0.6, frequency_ratio=5.0, restitution=0.93, alpha=math.radians(12), contact=True
    )
    assert calm.warnings == ""


def contact_of(**question):
    return contact_extremes(build_motion("sine", **question))


def test_the_sentence_starts_with_an_invalid_rocking_model():
    upright = contact_of(slenderness=0.6, frequency_ratio=5.0, restitution=0.93, alpha=math.radians(12))
    assert (upright.rocking_applies, upright.sentence) == (True, "rocks and comes to rest")
    squat = {"restitution": 0.25, "alpha": math.radians(45)}
    slides = contact_of(slenderness=0.9, frequency_ratio=4.0, **squat)
    assert MAX_FRICTION < slides.largest_friction_demand < math.inf
    assert not slides.rocking_applies
    assert slides.sentence.startswith("would slide: the rocking model does not apply")
    assert slides.sentence.endswith("rocks and comes to rest")
    lifts = contact_of(slenderness=0.2, frequency_ratio=12.0, **squat)
    assert lifts.sentence.startswith("would lift off the ground: the rocking model does not apply")
    assert not lifts.rocking_applies


def test_a_block_at_rest_may_slide_but_does_not_overturn():
    strong, weak = "never uplifts, but slides unless the coefficient of friction is at least 1.9", "never uplifts"
    for amplitude, sentence in ((0.95, strong), (0.4, weak)):
        still = contact_of(slenderness=1 / amplitude, frequency_ratio=4.0, restitution=0.5, alpha=math.atan(2.0))
        assert still.largest_friction_demand == pytest.approx(2.0 * amplitude)  # a_g/g
        assert still.rocking_applies
        assert still.sentence == sentence
    slender = contact_of(slenderness=0.2, frequency_ratio=3.0, restitution=0.9)
    assert slender.rocking_applies  # friction is not assessed in the slender limit


@pytest.mark.parametrize("alpha", [None, 1e-12, 1e-3, 0.5, 1.57])
def test_extreme_arguments_give_numbers(alpha):
    for slenderness in (1e-9, 0.5, 1 - 1e-12, 1e9):
        for omega in (1e-6, 1.0, 1e6):
            for eta in (0.0, 1.0):
                if (
                    slenderness == 1 - 1e-12
                    and eta == 1.0
                    and omega >= 1.0
                    and not (ALL and (alpha, omega) == (0.5, 1.0))
                ):
                    continue  # 200,000 impacts each, once is enough
                history = rocking.time_history(
                    "sine", slenderness=slenderness, frequency_ratio=omega, restitution=eta, alpha=alpha, contact=True
                )
                for name in ("horizontal_reaction", "normal_reaction"):
                    assert np.isfinite(history[name].values).all()
                assert not np.isnan(history.friction_demand_over_slope.values).any()
                assert history.largest_friction_demand >= 0
                assert math.isfinite(history.smallest_normal_reaction)


def test_a_motion_of_any_length_is_sampled_a_bounded_number_of_times():
    # an elastic block that almost overturns: 10,000 impacts, each of which takes several units of tau
    question = {"frequency_ratio": 5.0, "restitution": 1.0, "alpha": 0.2}
    survives = 1.000001 / rocking.thresholds("sine", **question).amplitude[0]
    motion = build_motion("sine", slenderness=survives, **question, duration=1e9)
    record, impact_times = motion.events()
    assert impact_times[-1] > 20 * MAX_STEP * MAX_STEPS
    tau, _ = contact._fine_samples(motion, record, impact_times)
    assert tau.size < 4 * MAX_STEPS + 10 * impact_times.size
    short = contact_extremes(build_motion("sine", slenderness=survives, **question, duration=100.0))
    whole = contact_extremes(motion)
    assert whole.largest_friction_demand == pytest.approx(short.largest_friction_demand, rel=1e-3)
    assert whole.smallest_normal_reaction == pytest.approx(short.smallest_normal_reaction, rel=1e-3)
