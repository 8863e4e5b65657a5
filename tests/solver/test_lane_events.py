"""Impacts and peaks of Taylor steps in all lanes, compared with the scalar functions and with known roots."""

import numpy as np
import pytest

import rocking
from rocking._numba.compilation import kernel
from rocking._numba.simd import LANES, load, store
from rocking._solver.kernels.event_loop import init_state, start_flight
from rocking._solver.rules import set_body
from rocking._solver.state import MAX_ORDER, block_cells, pulse_state, step_state
from rocking._solver.taylor import events
from rocking._solver.taylor.flight import free_lanes, highest_peak, impact_in_step, start_steps
from rocking._solver.taylor.lane_events import (
    NO_IMPACT,
    UNDECIDED,
    evaluate,
    locate_events,
    refine_roots,
    second_derivative_bounds,
    values_and_slopes,
)
from rocking._solver.taylor.step import take_step


@kernel
def at(series, top, h, found):
    value, slope = values_and_slopes(series, top, load(h, 0))
    store(found, 0, evaluate(series, top, load(h, 0)))
    store(found, 1, value)
    store(found, 2, slope)
    store(found, 3, second_derivative_bounds(series, top, load(h, 0)))


@kernel
def roots(series, top, lines, found):
    root, slope = refine_roots(
        series, top, load(lines, 0), load(lines, 1), load(lines, 2) > 0.0, load(lines, 3), load(lines, 4) > 0.0
    )
    store(found, 0, root)
    store(found, 1, slope)


@pytest.mark.parametrize("top", [5, 6, MAX_ORDER - 1, MAX_ORDER])
def test_series_of_all_lanes_are_those_of_one(top):
    rng = np.random.default_rng(top)
    series, h, found = rng.normal(size=(MAX_ORDER + 1, LANES)), rng.uniform(0.1, 1.2, (1, LANES)), np.empty((4, LANES))
    at(series, top, h, found)
    for lane in range(LANES):
        value, slope = events.value_and_slope(series, lane, top, h[0, lane])
        bound = events.second_derivative_bound(series, lane, top, h[0, lane])
        scale = np.abs(series[:, lane]) @ h[0, lane] ** np.arange(MAX_ORDER + 1)
        assert found[:2, lane] == pytest.approx(value, abs=1e-15 * scale)
        assert found[2, lane] == pytest.approx(slope, abs=1e-14 * scale * top)
        assert found[3, lane] == pytest.approx(bound, rel=1e-14)


def test_roots_of_all_lanes_are_refined_to_rounding():
    """Decreasing zeros, half of them beside one at the start that is divided out; lanes that are not wanted wait."""
    rng = np.random.default_rng(1)
    root, rate, wanted = rng.uniform(0.05, 1.0, LANES), rng.uniform(-0.5, 0.5, LANES), np.arange(LANES) % 5 != 4
    deflated = np.arange(LANES) % 2 == 1
    series = np.zeros((MAX_ORDER + 1, LANES))
    for lane in range(LANES):  # (root - h) (1 + rate h), times h if a zero is divided out
        numbers = np.array([root[lane], rate[lane] * root[lane] - 1.0, -rate[lane]])
        series[int(deflated[lane]) : int(deflated[lane]) + 3, lane] = numbers
    series[:, ~wanted] = np.nan
    low, high = np.zeros(LANES), np.minimum(1.5 * root, 1.4)
    guess = np.where(np.arange(LANES) % 3 == 0, np.inf, 0.9 * high)  # outside of the bracket: its middle is taken
    found = np.empty((2, LANES))
    roots(series, MAX_ORDER, np.array([low, high, deflated, guess, wanted], dtype=float), found)
    assert found[0, wanted] == pytest.approx(root[wanted], rel=1e-14)
    assert (found[1, wanted] < 0.0).all()
    for lane in np.flatnonzero(wanted):
        alone, _ = events.refine_root(series, lane, MAX_ORDER, 0.0, high[lane], True, deflated[lane], guess[lane])
        assert found[0, lane] == pytest.approx(alone, rel=4e-16)


@kernel
def first_steps(flights, steps, cells):
    free_lanes(steps)
    for lane in range(LANES - 1):  # the last lane is not in use
        set_body(flights[lane], cells[lane], False)
        init_state(flights[lane], cells[lane].rate)
        start_flight(flights[lane])
        steps.omega[lane] = cells[lane].rate
        start_steps(flights[lane], steps, lane)


@pytest.mark.parametrize("pulse", ["sine", "-ricker", "mavroeidis_papageorgiou"])
def test_events_of_all_lanes_are_those_of_one(pulse):
    """Steps from uplift, then with states in the air: where a lane is decided, the scalar functions agree."""
    rng = np.random.default_rng(2)
    state = pulse_state(rocking.pulse(pulse))
    flights, steps = np.array([state] * LANES), step_state(state)
    impacts = peaks = undecided = 0
    for case in range(120):
        slenderness = rng.uniform(0.1, 0.9, LANES)
        omega, alpha = rng.uniform(0.5, 8.0, LANES), rng.uniform(0.05, 1.0, LANES)
        first_steps(flights, steps, block_cells(omega, slenderness, np.full(LANES, 0.9), alpha))
        if case % 2:
            steps["z0"], steps["w0"] = rng.uniform(0.0, 0.3, LANES), rng.uniform(-0.5, 0.5, LANES)
            steps["at_ground"], steps["starts_at_uplift"], steps["limit"] = 0.0, 0.0, 3.0
            steps["phase"] = rng.uniform(*state["end_phase"][[0, state["pieces"]]], LANES)
            steps["destabilised"] = rng.integers(0, 2, LANES)
            steps["restoring_phase"] = steps["phase"]
        steps["known"] = rng.choice([0.0, 0.1], LANES)
        take_step(steps)
        locate_events(steps)
        assert steps["impact"][-1] == NO_IMPACT
        assert steps["peak"][-1] == 0.0
        for lane in range(LANES - 1):
            destabilised, h, z, w = (
                bool(steps["destabilised"][lane]),
                *(steps[name][lane] for name in ("h", "z1", "w1")),
            )
            impact, peak = steps["impact"][lane], steps["peak"][lane]
            alone = impact_in_step(steps, lane, destabilised, bool(steps["at_ground"][lane]))
            if impact == NO_IMPACT:
                assert alone == -1.0 or (destabilised and w > 0.0)  # a dip, which is searched for
            else:
                assert impact == pytest.approx(alone, rel=1e-14)
                h, z, w, impacts = impact, 0.0, steps["impact_w"][lane], impacts + 1
                speed = events.evaluate_series(steps["rate"], lane, MAX_ORDER - 1, impact)
                assert w == pytest.approx(speed, rel=1e-13, abs=1e-15)
            if destabilised:
                assert peak == 0.0
                continue
            undecided += peak == UNDECIDED
            if peak == UNDECIDED:
                continue
            start = (steps["restoring_phase"][lane] - steps["phase"][lane]) / steps["omega"][lane]
            expected = highest_peak(steps, lane, start, h, z, w, steps["known"][lane])
            assert peak == pytest.approx(expected, rel=1e-14)
            peaks += peak > 0.0
    assert min(impacts, peaks) > 30
    assert undecided < 0.3 * 120 * LANES
