"""Chatter: rest is set only where the followed impacts come to rest too and have no effect on the peak."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import rocking
from rocking import Outcome
from rocking._excitation.pulses import PULSE_NAMES
from rocking._solver.kernels.chatter import chatter_ends_in_rest
from rocking._solver.state import IMPACT, step_state
from tests.kernels import cell, flight_by_steps, flight_from
from tests.sampling import number

SIGNED = tuple(sign + name for name in PULSE_NAMES if name != "rectangular" for sign in ("", "-"))
WANTED = st.tuples(
    st.sampled_from(SIGNED),
    st.floats(0.02, 0.999),
    st.floats(-2.5, 2.0).map(lambda x: 10**x),
    st.one_of(st.floats(0, 0.95), st.floats(0.95, 0.999)),
    st.one_of(st.just(0.0), st.floats(-6, 0.15).map(lambda x: 10**x)),
    st.floats(0, 1),
    st.floats(0.001, 0.999),
    st.floats(-9, 0).map(lambda x: 10**x),
    st.sampled_from([-1.0, 1.0]),
)


def follow(flight, w, eta, phase, sign) -> tuple[float, float]:
    """Follow every impact until the velocity is negligible; returns the phase and the largest peak [z]."""
    highest, first, steps = 0.0, w, step_state(flight)
    while w > 1e-7 * first:
        flight_from(flight, phase, w, sign)
        ended, landing, _ = flight_by_steps(flight, steps)
        h, highest = float(flight["elapsed"]), max(highest, float(flight["largest_z"]))
        if ended != IMPACT:
            return math.inf, highest
        phase, w, sign = phase + float(flight["omega"]) * h, -eta * landing, -sign
    return phase, highest


def ends_in_rest(flight, w, eta, phase, end, peak) -> bool:
    flight["eta"], flight["peak_rotation"] = eta, peak
    return chatter_ends_in_rest(flight, w, phase, end)


@given(WANTED)
@settings(max_examples=number(6, 500))
def test_chatter_bound_holds_for_the_followed_impacts(wanted):
    pulse, slenderness, omega, eta, alpha, where, within, w, sign = wanted
    flight = cell(pulse, slenderness, omega, alpha)
    quiet = np.flatnonzero(flight["interval_level"][: int(flight["interval_count"])] == 0.0)
    interval = int(quiet[min(int(where * len(quiet)), len(quiet) - 1)])
    flight["interval"] = interval
    start, end = (float(x) for x in flight["interval_phase"][interval : interval + 2])
    phase = start + within * (end - start)
    assume(start < phase < end)
    peak = 0.5 * w  # an earlier peak of the block
    if ends_in_rest(flight, w, eta, phase, end, peak):
        rest, highest = follow(flight, w, eta, phase, sign)
        assert rest <= end
        assert highest <= peak


def test_chatter_bound_applies_to_small_velocities_within_an_interval():
    flight = cell("sine", 0.9, 1.0)
    end = float(flight["interval_phase"][1])
    for eta in (0.0, 0.3, 0.9, 0.99):
        assert ends_in_rest(flight, 1e-7, eta, 0.1, end, 0.5)
    assert not ends_in_rest(flight, 1e-7, 1.0, 0.1, end, 0.5)  # no energy loss: no rest
    assert not ends_in_rest(flight, 1e-7, 0.9, 0.1, end, 1e-15)  # a flight may exceed the peak
    assert not ends_in_rest(flight, 0.5, 0.9, 0.1, end, 0.5)  # the window is too short
    assert not ends_in_rest(flight, 1e-3, 0.9, end - 1e-6, end, 0.5)
    flight["each_side"] = 1
    for peaks, rests in (((0.5, 0.5), True), ((0.5, 1e-15), False), ((1e-15, 0.5), False)):  # on either edge
        flight["side_peak"] = peaks
        assert ends_in_rest(flight, 1e-7, 0.9, 0.1, end, 0.5) is rests


@pytest.mark.parametrize("alpha", [None, 0.25])
def test_a_block_at_rest_after_chatter_uplifts_again(alpha):
    # small uplift by the first crest, rest before the second, which uplifts the block to the other side
    question = {"slenderness": 0.97, "frequency_ratio": 8.0, "restitution": 0.3, "alpha": alpha}
    found = rocking.peak_response("sine", **question)
    assert found.outcome == Outcome.RECOVERS
    assert found.chatter
    history = rocking.time_history("sine", **question, samples=4000)
    tau, rotation = history.tau.values, history.rotation.values
    lobes = [rotation[(tau > a) & (tau < b)] for a, b in ((0.0, math.pi / 8), (math.pi / 8, math.pi / 4))]
    assert lobes[0].min() < 0  # positive ground acceleration: negative rotation first
    assert lobes[1].max() > 0
    rest = (rotation == 0) & (tau > found.uplift_time) & (tau < math.pi / 4 + 0.01)
    assert rest.sum() > 10


@pytest.mark.parametrize("alpha", [None, 1e-6, 0.25])
@pytest.mark.parametrize("name", SIGNED[::2])
def test_zero_restitution_gives_rest_or_immediate_uplift(name, alpha):
    rng = np.random.default_rng(6)
    n = 300
    found = rocking.peak_response(
        name,
        slenderness=rng.uniform(0.3, 0.999, n),
        frequency_ratio=np.exp(rng.uniform(0, 3, n)),
        restitution=0.0,
        alpha=alpha,
    )
    # one impact per lobe, or two where uplift follows immediately
    assert found.impacts.max() <= 16
    assert not (found.outcome == Outcome.NO_UPLIFT).any()
    assert not found.chatter.any()  # a single impact is not chatter


@pytest.mark.parametrize("alpha", [None, 0.1])
def test_nearly_elastic_blocks_under_slow_pulses_end(alpha):
    found = rocking.peak_response(
        "sine", slenderness=0.9999, frequency_ratio=0.02, restitution=[1 - 1e-12, 1.0], alpha=alpha
    )
    assert np.isin(
        found.outcome, [Outcome.RECOVERS, Outcome.OVERTURNED_DIRECTLY, Outcome.OVERTURNED_AFTER_IMPACT]
    ).all()
