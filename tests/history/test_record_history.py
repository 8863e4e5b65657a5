"""Time histories under records: against the responses, the equation of motion, and a direct integration."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from tests.solver.records.tables import record

MOTION = record("napa_HNE", 0.005)
BLOCK = {"frequency_parameter": 2.2, "slenderness": 0.45, "restitution": 0.9}
ALPHAS = [None, 0.2]


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_peak_is_that_of_the_response(alpha: float | None) -> None:
    history = rocking.time_history(MOTION, **BLOCK, alpha=alpha, samples=200_000)
    response = rocking.peak_response(MOTION, **BLOCK, alpha=alpha)
    assert history.attrs["peak_rotation"] == pytest.approx(float(response.peak_rotation), rel=1e-12)
    assert float(np.abs(history.rotation).max()) == pytest.approx(float(response.peak_rotation), rel=1e-6)
    assert history.attrs["impacts"] == response.impacts
    assert history.attrs["outcome"] == "RECOVERS"


@pytest.mark.parametrize("alpha", ALPHAS)
def test_a_vertical_component_enters_the_equation(alpha: float | None) -> None:
    """Every flight, by the work of the ground and of gravity between samples; the peak is that of the response."""
    motion = rocking.Record(MOTION.acceleration, 0.005, "m/s2", vertical=0.7 * np.roll(MOTION.acceleration, 40))
    groups = BLOCK | {"slenderness": 0.6, "alpha": alpha, "vertical_scale": 1.3}
    history = rocking.time_history(motion, **groups, samples=100_000)
    response = rocking.peak_response(motion, **groups)
    assert history.attrs["peak_rotation"] == pytest.approx(float(response.peak_rotation), rel=1e-11)
    assert float(np.abs(history.rotation).max()) == pytest.approx(float(response.peak_rotation), rel=1e-6)
    assert history.attrs["vertical_scale"] == 1.3
    expected = np.interp(history.time, motion.times, 1.3 * motion.vertical / STANDARD_GRAVITY, right=0.0)
    np.testing.assert_allclose(history.vertical_acceleration, expected, rtol=1e-9, atol=1e-12)
    theta, rate, tau = history.rotation.values, history.angular_velocity.values, history.tau.values
    u, pressing, sign = history.ground_acceleration.values, 1.0 + history.vertical_acceleration.values, np.sign(theta)
    if alpha is None:
        acceleration = pressing * (theta - sign) - u
    else:
        lean = alpha * (sign - theta)
        acceleration = (-pressing * np.sin(lean) - u * math.tan(alpha) * np.cos(lean)) / alpha
    free = (sign[1:] == sign[:-1]) & (sign[1:] != 0.0) & ~np.isin(tau[1:], history.impact_time * 2.2)
    step = np.diff(tau)
    trapezium = 0.5 * step * (acceleration[1:] + acceleration[:-1])
    wrong = np.abs(np.diff(rate) - trapezium)[free & (step > 1e-5)]
    assert wrong.size > 1000
    assert wrong.max() < 1e-6


@pytest.mark.parametrize("alpha", ALPHAS)
def test_between_impacts_the_motion_satisfies_the_equation(alpha: float | None) -> None:
    """The first long flight, integrated by scipy with a step at each sample."""
    history = rocking.time_history(MOTION, **BLOCK, alpha=alpha)
    p, angle = BLOCK["frequency_parameter"], alpha or 0.0
    bounds = np.concatenate([[float(history.time[history.rotation != 0.0][0])], history.impact_time.values])
    longest = int(np.diff(bounds).argmax())
    inside = (history.time >= bounds[longest]) & (history.time <= bounds[longest + 1])
    part = history.isel(time=np.flatnonzero(inside.values)[1:-1])
    tau = part.tau.values
    sign = math.copysign(1.0, float(part.rotation[part.sizes["time"] // 2]))

    def rate(at: float, state: np.ndarray) -> list[float]:
        u = np.interp(at / p, MOTION.times, MOTION.acceleration / MOTION.peak_acceleration) / BLOCK["slenderness"]
        theta, velocity = state
        if angle == 0.0:
            return [velocity, theta - sign - u]
        fall = angle * (sign - theta)
        return [velocity, (-math.sin(fall) - u * math.tan(angle) * math.cos(fall)) / angle]

    start = [float(part.rotation[0]), float(part.angular_velocity[0])]
    found = solve_ivp(rate, (tau[0], tau[-1]), start, "DOP853", tau, rtol=1e-11, atol=1e-13, max_step=p * 0.005)
    np.testing.assert_allclose(found.y[0], part.rotation.values, atol=1e-9)
    np.testing.assert_allclose(found.y[1], part.angular_velocity.values, atol=1e-8)


def test_by_default_the_samples_are_those_of_the_record_and_some_more() -> None:
    history = rocking.time_history(MOTION, **BLOCK)
    interval = BLOCK["frequency_parameter"] * MOTION.time_step
    assert np.isin(interval * np.arange(MOTION.samples + 700), history.tau).all()
    assert np.diff(history.time).max() == pytest.approx(MOTION.time_step)
    long = rocking.Record(np.append(np.zeros(1_200_000), 1.0), 0.01, "m/s2")
    assert rocking.time_history(long, **BLOCK).time[-1] > long.duration
    for samples, step in (([0.0, 3.0, -2.0, 1.0], 1e-6), (np.sin(np.arange(20_000)), 1e-5)):
        short = rocking.Record(samples, step, "m/s2")
        history = rocking.time_history(short, **BLOCK)
        events = history.sizes["impact"] + 3
        assert history.sizes["time"] <= short.samples + max(short.samples, 10_000) + events
        assert history.time[-1] == pytest.approx(short.duration + 8.0 / BLOCK["frequency_parameter"])


def test_impacts_reduce_the_velocity_by_the_restitution() -> None:
    history = rocking.time_history(MOTION, **BLOCK)
    before = rocking.time_history(MOTION, **BLOCK, samples=400_000)
    for time in history.impact_time.values[:20:3]:
        after = float(history.angular_velocity.sel(time=time))
        place = int(np.searchsorted(before.time.values, time)) - 1
        dt = (time - float(before.time[place])) * BLOCK["frequency_parameter"]
        assert after == pytest.approx(0.9 * float(before.angular_velocity[place]), abs=5 * dt)
        assert float(history.rotation.sel(time=time)) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_an_overturning_block_is_followed_until_it_has_fallen(alpha: float | None) -> None:
    history = rocking.time_history(MOTION, **(BLOCK | {"slenderness": 0.2}), alpha=alpha)
    assert history.attrs["overturned"] == 1
    last = float(abs(history.rotation[-1]))
    assert last > 3.9  # the last sample before it passes 4, the first of pi/2 and 4
    assert bool((abs(history.rotation[:-1]) <= last).all())


def test_after_the_motion_the_block_rocks_freely() -> None:
    """A short motion: the energy is constant between impacts after its end."""
    motion = rocking.Record([0.0, 1.0, 1.0, -0.5], 0.1, unit="g")
    history = rocking.time_history(motion, frequency_parameter=3.0, slenderness=0.4, restitution=0.8, samples=5000)
    assert history.attrs["overturned"] == 0
    z, w = np.abs(history.rotation.values), history.angular_velocity.values
    free = (history.time.values > motion.duration) & (z > 0.0)
    count = np.searchsorted(history.impact_time.values, history.time.values, side="right")
    energy = w * w - (1.0 - z) ** 2
    for flight in np.unique(count[free])[:4]:
        np.testing.assert_allclose(energy[free & (count == flight)], energy[free & (count == flight)][0], atol=1e-9)
    assert history.ground_acceleration.values[history.time.values > motion.duration].max() == 0.0


@pytest.mark.parametrize("alpha", ALPHAS)
def test_contact_forces_of_a_rocking_block(alpha: float | None) -> None:
    history = rocking.time_history(MOTION, **BLOCK, alpha=alpha, contact=True)
    rest = (history.rotation == 0.0) & (history.angular_velocity == 0.0) & (abs(history.ground_acceleration) < 1.0)
    np.testing.assert_allclose(history.normal_reaction.values[rest], 1.0)
    slope = math.tan(alpha or 0.0)
    np.testing.assert_allclose(
        history.horizontal_reaction.values[rest], slope * history.ground_acceleration.values[rest]
    )
    demand = history.friction_demand_over_slope.values
    assert history.attrs["largest_friction_demand_over_slope"] >= demand.max() * (1 - 1e-12)
    assert history.attrs["largest_friction_demand_over_slope"] == pytest.approx(demand.max(), rel=0.05)
    assert history.attrs["smallest_normal_reaction"] <= history.normal_reaction.values.min() + 1e-12


def test_without_uplift_nothing_moves() -> None:
    history = rocking.time_history(MOTION, **(BLOCK | {"slenderness": 1.5}))
    assert not history.rotation.any()
    assert history.attrs["outcome"] == "NO_UPLIFT"
