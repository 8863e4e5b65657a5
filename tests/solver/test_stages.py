"""The stages for slender blocks: the same responses as the event loop with Taylor steps, whatever the company."""

import math

import numpy as np
import pytest

import rocking
from rocking import Outcome
from rocking._excitation.pulses import SinusoidalPulse
from rocking._solver.kernels.batch import solve_batch
from rocking._solver.peak_response import NO_EDGES, NO_FLIGHTS, solver_state
from rocking._solver.stages.batch import LEFT, solve_by_arcs
from rocking._solver.stages.state import stage_state
from rocking._solver.state import FULL_PRECISION, RESPONSE_RECORD, block_cells, pulse_state
from tests.sampling import number

SINUSOIDS = [name for name in rocking.PULSE_NAMES if rocking.pulse(name).series.has_exact_arcs]
SIGNED = [sign + name for name in SINUSOIDS for sign in ("", "-")]
NUMBERS = ("uplift_time", "first_impact_time", "first_impact_velocity", "peak_rotation")
STATE = ("end_rotation", "end_velocity")
WHOLE = ("outcome", "impacts", "chatter", "peak_mode", "exceeded_alpha")


COUNT = number(600, 4000)


def cells(count, seed):
    """Random slenderness, frequency ratio and restitution, a tenth of them close to the onset."""
    rng = np.random.default_rng(seed)
    s = np.where(rng.random(count) < 0.1, 1.0 - 10.0 ** rng.uniform(-12, -1, count), rng.uniform(0.005, 1.01, count))
    eta = np.where(rng.random(count) < 0.1, rng.choice([0.0, 0.85, 0.999, 1.0], count), rng.uniform(0, 1, count))
    return s, np.exp(rng.uniform(math.log(0.05), math.log(20), count)), eta


def by_stages_alone(pulse, s, w, eta):
    found = np.zeros(s.size, RESPONSE_RECORD)
    stop = np.zeros(1, np.uint8)
    left = solve_by_arcs(s, w, eta, pulse_state(pulse).copy(), *stage_state(), stop, found)
    assert left == np.count_nonzero(found["outcome"] == LEFT)
    return found


def by_stages(pulse, s, w, eta):
    found = by_stages_alone(pulse, s, w, eta)
    rest = found["outcome"] == LEFT
    found[rest] = by_event_loop(pulse, s[rest], w[rest], eta[rest])
    return found


def by_event_loop(pulse, s, w, eta):
    found = np.zeros(s.size, RESPONSE_RECORD)
    state = solver_state.of_steps(pulse, FULL_PRECISION)
    cells = block_cells(w, s, eta, np.zeros(s.size))
    solve_batch(cells, *state, np.zeros(1, np.uint8), found, NO_EDGES, NO_FLIGHTS)
    return found


def assert_equal(first, second):
    for name in first.dtype.names:
        np.testing.assert_array_equal(first[name], second[name], err_msg=name)


def assert_agree(stages, loop, s, eta):
    """Equal events and modes; values equal to rounding where the problem is well conditioned."""
    # where the peaks of two uplifts differ by rounding only, which 1/(1 - s) amplifies, either may be the first
    tie = (stages["peak_mode"] - loop["peak_mode"]) % 65536 == 0
    rounding = 1e-10 + 1e-15 / np.maximum(1.0 - s, 1e-13)
    tie &= np.abs(stages["peak_rotation"] - loop["peak_rotation"]) <= rounding * loop["peak_rotation"]
    assert np.count_nonzero(stages["peak_mode"] != loop["peak_mode"]) <= 0.04 * s.size  # a tenth is close to the onset
    for field in WHOLE:
        decided = ~tie if field == "peak_mode" else slice(None)
        np.testing.assert_array_equal(stages[field][decided], loop[field][decided], err_msg=field)
    assert {*WHOLE, *NUMBERS, *STATE} == set(RESPONSE_RECORD.names)
    survives = loop["outcome"] == Outcome.RECOVERS  # they are certain of overturning at other times
    for field in STATE:
        error = np.abs(stages[field] - loop[field]) / np.maximum(1.0, np.abs(loop[field]))
        assert error[survives & (s < 0.9) & (eta < 0.9)].max() < 1e-9, field
    for field in NUMBERS:
        np.testing.assert_array_equal(np.isnan(stages[field]), np.isnan(loop[field]))
        scale = np.where(loop[field] == 0.0, 1.0, np.abs(loop[field]))
        error = np.abs(stages[field] - loop[field]) / scale
        plain = (s < 0.9) & (eta < 0.9) & np.isfinite(error)  # close to 1 in either the problem is ill-conditioned
        assert np.count_nonzero(error[plain] > 1e-13) <= 0.05 * np.count_nonzero(plain), field
        assert error[plain].max(initial=0.0) < 1e-9, field


@pytest.mark.parametrize("name", SIGNED)
def test_stages_and_event_loop_agree(name):
    pulse = rocking.pulse(name)
    s, w, eta = cells(COUNT, SIGNED.index(name))
    assert_agree(by_stages(pulse, s, w, eta), by_event_loop(pulse, s, w, eta), s, eta)


def test_a_start_above_the_level_and_pieces_without_a_cut():
    """Sums of sinusoids whose extrema have different heights: some levels are reached on some pieces only."""
    terms = ((1.0, 1.0, -math.pi / 2), (0.6, 2.0, 0.3), (0.3, 3.0, 1.0))
    for start, end in ((0.2, 7.0), (-3.0, 4.0), (1.0, 12.0)):
        pulse = SinusoidalPulse.of_unit_peak("sum", start, end, terms)
        s, w, eta = cells(COUNT // 2, 9)
        stages, loop = by_stages(pulse, s, w, eta), by_event_loop(pulse, s, w, eta)
        for field in ("outcome", "impacts", "chatter"):
            np.testing.assert_array_equal(stages[field], loop[field], err_msg=field)
        error = np.abs(stages["peak_rotation"] / np.where(loop["peak_rotation"] > 0, loop["peak_rotation"], 1.0) - 1.0)
        assert np.nanmedian(error[loop["peak_rotation"] > 0]) < 1e-14


def test_a_peak_after_a_minimum_of_the_velocity_is_found():
    """w > 0 at both ends of a monotone interval and negative inside; found among 420,000 random blocks."""
    s, w, eta = np.array([0.9716350970804516]), np.array([0.41023686938728526]), np.array([0.993624995799155])
    (found,) = by_stages(rocking.pulse("c1"), s, w, eta)
    motion = rocking.time_history("c1", slenderness=s[0], frequency_ratio=w[0], restitution=eta[0], samples=200_000)
    assert np.abs(motion.rotation.values).max() == pytest.approx(float(found["peak_rotation"]), rel=1e-6)
