"""Reactions of the ground: Newton's law by differences of the motion, slender limit, impacts."""

import math
from itertools import pairwise

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._model.reactions import impulse_ratio, reactions

RADIUS = 0.75
"""R in units of g/p^2; masses are 1, so that forces are in units of m g."""

PULSES = ("sine", "cosine", "c1", "ricker_antisymmetric", "-half_sine")
ALPHAS = (0.05, math.radians(20), 0.6)
QUESTIONS = (
    {"slenderness": 0.45, "frequency_ratio": 4.0, "restitution": 0.85},
    {"slenderness": 0.7, "frequency_ratio": 2.0, "restitution": 0.6},
    {"slenderness": 0.15, "frequency_ratio": 3.0, "restitution": 0.9},
)


def flights(pulse, question, alpha, samples=8001):
    """Uniformly sampled intervals between events, up to the last crossing of alpha."""
    history = rocking.time_history(pulse, **question, alpha=alpha, contact=True, samples=samples)
    step = history.tau.values[-1] / (samples - 1) if not history.overturned else None
    events = np.concatenate([history.impact_time.values, [0.0, history.pulse_end]])
    tau = history.tau.values
    step = np.median(np.diff(tau)) if step is None else step
    on_grid = np.abs(tau / step - np.round(tau / step)) < 1e-6
    history = history.isel(tau=on_grid)
    tau, y = history.tau.values, history.rotation.values
    inside = (y != 0) & (np.abs(y) < 1.5)
    bounds = np.concatenate([[0.0], np.sort(events), [np.inf]])
    for left, right in pairwise(bounds):
        part = np.flatnonzero(inside & (tau > left) & (tau < right))
        runs = np.split(part, np.flatnonzero(np.diff(part) > 1) + 1)
        for run in runs:
            if run.size > 40:
                yield history.isel(tau=run), step


def centre_of_mass(flight):
    """Horizontal and vertical position relative to the pivot [g/p^2]; theta > 0 is a rotation to the right."""
    theta, alpha = flight.alpha * flight.rotation.values, flight.alpha
    side = np.sign(theta[theta.size // 2])
    return -side * RADIUS * np.sin(alpha - side * theta), RADIUS * np.cos(alpha - side * theta)


def second_derivative(values, step):
    """Derivative by differences of fourth order, without two samples at each end."""
    v = values
    return (-v[:-4] + 16 * v[1:-3] - 30 * v[2:-2] + 16 * v[3:-1] - v[4:]) / (12 * step**2)


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("pulse", PULSES)
def test_reactions_move_the_centre_of_mass(pulse, alpha):
    seen = 0
    for question in QUESTIONS:
        for flight, step in flights(pulse, question, alpha):
            x, y = centre_of_mass(flight)
            ground = flight.ground_acceleration.values[2:-2] * math.tan(alpha)  # u/g
            tolerance = 1e-4 * step**2 * (1 + question["frequency_ratio"] ** 4) / question["slenderness"] + 4e-9
            horizontal = ground + second_derivative(x, step)
            assert np.abs(flight.horizontal_reaction.values[2:-2] - horizontal).max() < tolerance
            normal = 1 + second_derivative(y, step)
            assert np.abs(flight.normal_reaction.values[2:-2] - normal).max() < tolerance
            seen += 1
    assert seen >= 4


@pytest.mark.parametrize("alpha", [None, 0.3])
def test_mirrored_pulse_has_mirrored_reactions(alpha):
    for question in QUESTIONS:
        one, other = (rocking.time_history(name, **question, alpha=alpha, contact=True) for name in ("sine", "-sine"))
        np.testing.assert_array_equal(one.horizontal_reaction, -other.horizontal_reaction)
        for name in ("normal_reaction", "friction_demand", "friction_demand_over_slope"):
            np.testing.assert_array_equal(one[name], other[name])
        assert one.largest_friction_demand == other.largest_friction_demand


@pytest.mark.parametrize("alpha", ALPHAS)
def test_friction_demand_at_uplift_is_tan_alpha_for_a_smooth_pulse(alpha):
    question = {"slenderness": 0.6, "frequency_ratio": 3.0, "restitution": 0.9}
    uplift = float(rocking.peak_response("sine", **question, alpha=alpha).uplift_time)
    for after in (0.0, 1e-9):
        history = rocking.time_history(
            "sine", **question, alpha=alpha, contact=True, duration=uplift * (1 + after) * (1 + 1e-15), samples=3
        )
        assert history.tau.values[-1] == pytest.approx(uplift)
        assert history.friction_demand.values[-1] == pytest.approx(math.tan(alpha), rel=1e-7)
        assert history.normal_reaction.values[-1] == pytest.approx(1.0, rel=1e-7)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_friction_demand_under_a_sudden_pulse_is_less_than_at_rest(alpha):
    a = 2.5
    history = rocking.time_history(
        "cosine", slenderness=1 / a, frequency_ratio=3.0, restitution=0.9, alpha=alpha, contact=True
    )
    square = math.sin(alpha) ** 2
    expected = (a - 0.75 * (1 - square) * (a - 1)) / (1 + 0.75 * square * (a - 1))
    assert history.friction_demand_over_slope.values[0] == pytest.approx(expected, rel=1e-13)
    assert 1 < expected < a


def test_reactions_at_rest_are_weight_and_inertia():
    history = rocking.time_history(
        "ricker", slenderness=1.25, frequency_ratio=3.0, restitution=0.9, alpha=0.4, contact=True
    )
    np.testing.assert_allclose(history.horizontal_reaction, math.tan(0.4) * history.ground_acceleration, rtol=1e-15)
    assert (history.normal_reaction == 1).all()
    assert history.largest_friction_demand == pytest.approx(math.tan(0.4) / 1.25, rel=1e-9)
    assert history.impulse_ratio == 0.0
    assert history.warnings == ""


@pytest.mark.parametrize("pulse", ["sine", "ricker"])
def test_slender_limit(pulse):
    question = {"slenderness": 0.45, "frequency_ratio": 4.0, "restitution": 0.85}
    limit = rocking.time_history(pulse, **question, contact=True)
    assert not limit.horizontal_reaction.any()
    assert not limit.friction_demand.any()
    assert (limit.normal_reaction == 1).all()
    y, u = limit.rotation.values, limit.ground_acceleration.values
    moving = y != 0
    printed = np.abs(0.25 * u + 0.75 * (y - np.sign(y)))
    np.testing.assert_allclose(limit.friction_demand_over_slope.values[moving], printed[moving], atol=1e-13)
    distances = []
    for alpha in (0.02, 0.01, 0.005):
        near = rocking.time_history(pulse, **question, alpha=alpha, contact=True)
        distances.append(abs(near.largest_friction_demand_over_slope - limit.largest_friction_demand_over_slope))
        assert near.largest_friction_demand == pytest.approx(
            math.tan(alpha) * near.largest_friction_demand_over_slope, rel=1e-14
        )
    assert np.log2(distances[0] / distances[1]) == pytest.approx(2, abs=0.1)  # of order alpha^2
    assert np.log2(distances[1] / distances[2]) == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_impulse_of_an_impact_is_the_change_of_momentum(alpha):
    question = {"slenderness": 0.6, "frequency_ratio": 3.0, "restitution": 0.7}
    impact = float(rocking.time_history("sine", **question, alpha=alpha).impact_time[0])
    velocities = []
    for time in (impact * (1 - 1e-9), impact * (1 + 1e-9)):
        state = rocking.time_history("sine", **question, alpha=alpha, duration=time, contact=True).isel(tau=-1)
        rate = alpha * float(state.angular_velocity)
        side = math.copysign(1, rate) * (
            -1 if time < impact else 1
        )  # towards rest before the impact, away from it after
        velocities.append((math.cos(alpha) * rate, side * math.sin(alpha) * rate))
    (x0, y0), (x1, y1) = velocities
    assert y1 > y0
    assert state.impulse_ratio == pytest.approx(abs(x1 - x0) / (y1 - y0), rel=1e-6)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_impulse_ratio_of_housner_is_the_demand_of_slow_rocking(alpha):
    block = rocking.Block.from_slenderness_angle(alpha, 1.0)
    slow = reactions(np.zeros(1), np.zeros(1), np.zeros(1), np.ones(1), alpha)
    ratio = impulse_ratio(block.momentum_restitution, alpha)
    assert ratio == pytest.approx(math.tan(alpha) * float(slow.friction_demand[0]), rel=1e-13)
    assert ratio < math.tan(alpha)


def test_impulse_ratio_at_the_ends_of_its_range():
    assert impulse_ratio(1.0, 0.0) == impulse_ratio(1.0, 0.3) == 0.0
    assert impulse_ratio(0.9, 0.0) == math.inf
    assert impulse_ratio(0.0, 0.3) == pytest.approx(1 / math.tan(0.3))
    with pytest.raises(InvalidArgumentError, match="restitution"):
        impulse_ratio(1.1, 0.3)
    with pytest.raises(InvalidArgumentError, match="alpha"):
        impulse_ratio(0.9, 1.6)
