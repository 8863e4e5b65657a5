"""Time histories: equation of motion between events, restitution at impacts, agreement with the response."""

import math

import numpy as np
import pytest

import rocking
from rocking import PULSE_NAMES, Outcome

ALPHAS = (None, 1e-6, 0.3)
QUESTIONS = (
    {"slenderness": 0.7, "frequency_ratio": 3.0, "restitution": 0.9},
    {"slenderness": 0.45, "frequency_ratio": 5.0, "restitution": 0.6},
    {"slenderness": 0.3, "frequency_ratio": 2.0, "restitution": 0.85},
    {"slenderness": 0.97, "frequency_ratio": 1.2, "restitution": 0.5},
)


def pulled(z, alpha, ground):
    """z'' of a flight with `ground` = sgn(theta) a f."""
    if alpha is None:
        return z - 1 - ground  # (3.1)
    return -(np.sin(alpha * (1 - z)) + np.tan(alpha) * ground * np.cos(alpha * (1 - z))) / alpha  # (2.2)


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("name", PULSE_NAMES)
def test_equation_of_motion_between_events(name, alpha):
    for question in QUESTIONS:
        history = rocking.time_history(name, **question, alpha=alpha, samples=3000)
        tau, y, v = (history[key].values for key in ("tau", "rotation", "angular_velocity"))
        ground = history.ground_acceleration.values
        # three samples in a row within one flight: the slope of v is v', by differences of second order
        left, right = np.diff(tau)[:-1], np.diff(tau)[1:]
        smooth = (y[:-2] * y[1:-1] > 0) & (y[1:-1] * y[2:] > 0) & (np.abs(left / right - 1) < 1e-9)
        smooth &= (tau[2:] < history.pulse_end - 1e-12) | (tau[:-2] > history.pulse_end + 1e-12)
        smooth &= np.abs(y[1:-1]) < 2
        side = np.sign(y[1:-1])
        expected = side * pulled(np.abs(y[1:-1]), alpha, side * ground[1:-1])
        slope = (v[2:] - v[:-2]) / (left + right)
        step = np.where(smooth, right, 0.0)
        scale = (1 + question["frequency_ratio"] ** 2) / question["slenderness"] * 20
        assert (np.abs(slope - expected)[smooth] <= (scale * step**2 + 1e-10)[smooth]).all()
        speed = (y[2:] - y[:-2]) / (left + right)
        assert (np.abs(speed - v[1:-1])[smooth] <= (scale * step**2 + 1e-10)[smooth]).all()
        assert smooth.sum() > 20 or not history.rotation.any()


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("name", PULSE_NAMES)
def test_history_and_response_agree(name, alpha):
    for question in QUESTIONS:
        history = rocking.time_history(name, **question, alpha=alpha, samples=4000)
        found = rocking.peak_response(name, **question, alpha=alpha)
        assert history.overturned == found.overturned
        assert Outcome[history.outcome] == found.outcome
        assert history.impacts == found.impacts
        tau, y = history.tau.values, history.rotation.values
        assert np.isfinite(y).all()
        assert (np.diff(tau) > 0).all()
        moving = np.flatnonzero(y)
        assert tau[moving[0] - 1] <= found.uplift_time * (1 + 1e-15) <= tau[moving[0]]
        assert float(found.uplift_time) in tau
        assert history.pulse_end in tau or found.overturned
        if np.isfinite(found.first_impact_time):
            first = found.uplift_time + found.first_impact_time
            assert history.impact_time.values[0] == pytest.approx(float(first), rel=1e-13)
        if found.overturned:
            assert abs(y[-1]) >= 1
            assert np.isnan(history.peak_rotation)
        else:
            assert history.peak_rotation == found.peak_rotation
            assert np.abs(y).max() <= found.peak_rotation * (1 + 1e-12)
            assert np.abs(y).max() >= found.peak_rotation * (1 - 1e-3)


def test_duration_and_samples():
    question = {"slenderness": 0.7, "frequency_ratio": 4.0, "restitution": 0.9}
    short = rocking.time_history("sine", **question, duration=1.0, samples=11)
    assert short.tau.values[-1] == 1.0
    assert set(np.linspace(0, 1, 11)) <= set(short.tau.values)
    long = rocking.time_history("sine", **question, duration=30.0, samples=50)
    assert long.tau.values[-1] == 30.0
    assert long.rotation.values[-1] == 0.0  # at rest
    default = rocking.time_history("sine", **question)
    assert default.tau.values[-1] == pytest.approx(2 * math.pi / 4 + 8)
    fine = rocking.time_history("sine", **question, samples=799)
    common = np.isin(fine.tau.values, default.tau.values)
    assert common.sum() >= 400
    np.testing.assert_array_equal(fine.rotation.values[common], default.rotation.values)


@pytest.mark.parametrize("alpha", [None, 0.3, 1.2])
@pytest.mark.parametrize("name", PULSE_NAMES)
def test_an_overturning_block_is_followed_without_a_gap_to_the_ground(name, alpha):
    farthest = min(4.0, math.pi / 2 / alpha) if alpha else 4.0
    seen = 0
    for slenderness in (0.1, 0.3, 0.8):
        for omega in (0.1, 0.5, 2.0):  # overturning before the end of the pulse and after it
            history = rocking.time_history(
                name, slenderness=slenderness, frequency_ratio=omega, restitution=0.9, alpha=alpha, samples=4000
            )
            if not history.overturned:
                continue
            seen += 1
            tau, y, v = (history[key].values for key in ("tau", "rotation", "angular_velocity"))
            assert (np.abs(y[:-1]) <= farthest).all()
            assert abs(y[-1]) > 0.8 * farthest
            moved = 0.5 * (v[1:] + v[:-1]) * np.diff(tau)
            assert (np.abs(np.diff(y) - moved) <= np.maximum(0.01, 0.05 * np.abs(moved))).all()
    assert seen >= 3


@pytest.mark.parametrize("name", ["sine", "ricker"])
@pytest.mark.parametrize("alpha", [None, 0.3, 1.5])
def test_the_history_of_a_very_slow_pulse_ends(name, alpha):
    history = rocking.time_history(name, slenderness=0.5, frequency_ratio=1e-4, restitution=0.9, alpha=alpha)
    assert history.overturned
    assert np.isfinite(history.rotation.values).all()


@pytest.mark.parametrize(
    ("argument", "values"),
    [
        ("duration", [0.0, -1.0, math.nan, math.inf]),
        ("samples", [1, 0, -5, 2_000_000]),
    ],
)
def test_invalid_arguments(argument, values):
    question = {"slenderness": 0.7, "frequency_ratio": 4.0, "restitution": 0.9}
    for value in values:
        with pytest.raises(rocking.InvalidArgumentError, match=argument):
            rocking.time_history("sine", **{**question, argument: value})
