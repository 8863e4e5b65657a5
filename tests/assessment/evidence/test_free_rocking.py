"""Blocks from traces of free rocking that an independent integration makes."""

import itertools
import math
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._evidence.free_rocking import identify_free_rocking
from scipy.integrate import solve_ivp
from scipy.signal import lfilter

import rocking
from benchmarks.accuracy.free_rocking import KINDS, NAMES, errors, free_rocking
from rocking._base.errors import InvalidArgumentError, StoppedError
from rocking._numba.cancellation import StopFlag
from tests.sampling import but_long, number

ALPHA, P, ETA = 0.25, 2.5, 0.9


@pytest.fixture(autouse=True)
def fewer_steps(monkeypatch):
    """A quarter of those of the benchmark, of 0.25 to 0.8 ms: the traces differ by 3e-6 rad at the most."""
    monkeypatch.setattr("benchmarks.accuracy.free_rocking.STEPS", 20)


@cache
def trace(rate=100, held=20, duration=6.0, start=0.2):
    clean = free_rocking(np.array([start]), ALPHA, P, ETA, duration, rate)[0]
    rotation = np.concatenate([np.full(held, start), clean])
    return np.arange(rotation.size) / rate, rotation


@pytest.mark.parametrize("start", [0.2, -0.1])
def test_a_trace_without_noise_gives_the_block(start):
    fit = identify_free_rocking(*trace(start=start))
    assert fit["restitution"].item() == pytest.approx(ETA, abs=1e-5)
    assert fit["alpha"].item() == pytest.approx(ALPHA, rel=1e-4)
    assert fit["frequency_parameter"].item() == pytest.approx(P, rel=1e-4)
    assert fit["edge"].item() == "both"
    assert np.nanmax(np.abs(fit["residual"])) < 1e-4


def test_the_first_impact_is_where_the_equation_of_motion_has_it():
    time, rotation = trace()
    hit = solve_ivp(
        lambda _, y: [y[1], -P * P * np.sin(ALPHA - y[0])], (0.0, 3.0), [0.2, 0.0], rtol=1e-10, atol=1e-12,
        events=lambda _, y: y[0],
    ).t_events[0][0]  # fmt: skip
    assert identify_free_rocking(time, rotation)["impact_time"][0].item() == pytest.approx(0.2 + hit, abs=1e-5)


def test_peaks_obey_the_energy_of_housner():
    fit = identify_free_rocking(*trace())
    fitted, impacts = fit["fitted"].dropna("time"), fit["impact_time"].values
    peaks = [np.abs(fitted.sel(time=slice(*ends))).max().item() for ends in pairwise(impacts)]
    energy = np.cos(ALPHA - np.array([0.2, *peaks[:5]])) - np.cos(ALPHA)
    np.testing.assert_allclose(energy[1:] / energy[:-1], ETA**2, rtol=3e-3)  # peaks lie between samples


@pytest.mark.long
def test_two_edges_give_their_own_numbers():
    alpha, p, eta = np.array([[0.2], [0.3]]), np.array([[2.2], [2.4]]), np.array([[0.93], [0.88]])
    rotation = free_rocking(np.array([0.16]), alpha, p, eta, 6.0, 200)[0]
    noisy = rotation + 2e-4 * np.random.default_rng(5).normal(size=rotation.size)
    fit = identify_free_rocking(np.arange(noisy.size) / 200, noisy, edges=2)
    assert fit["edge"].values.tolist() == ["right", "left"]
    for name, true in (("alpha", alpha), ("frequency_parameter", p), ("restitution", eta)):
        np.testing.assert_allclose(fit[name], true[:, 0], rtol=0.02)


def test_two_edges_of_a_body_after_a_pulse():
    """Momentum about the new edge gives eta; the solver of bodies shares nothing with the fit."""
    left, right, height = 0.16, 0.2, 0.9
    body = rocking.RigidBody(left=left, right=right, height=height)
    motion = body.history("sine", peak_acceleration=2.6, period=0.7, duration=7.0, samples=420)
    free = motion.isel(time=motion["time"] > motion.attrs["motion_end"])
    fit = identify_free_rocking(free["time"], free["rotation"], edges=2)
    inertia = body.gyration.item() ** 2 + height**2  # about the middle of the ground, over the mass
    edge, opposite = np.array([right, left]), np.array([left, right])
    np.testing.assert_allclose(fit["alpha"], np.arctan(edge / height), rtol=1e-6)
    p = np.sqrt(9.80665 * np.hypot(edge, height) / (inertia + edge**2))
    np.testing.assert_allclose(fit["frequency_parameter"], p, rtol=1e-6)
    np.testing.assert_allclose(fit["restitution"], (inertia - edge * opposite) / (inertia + edge**2), rtol=1e-6)


def test_a_part_of_the_benchmark_is_within_its_bounds():
    result = errors(number(4, 20), 4)
    assert result.refused == 0
    assert np.abs(result.error).max(axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=0.05)
    assert np.abs(result.error[:, 0]).max() < 0.01
    assert np.all(result.within.mean(axis=0) > 0.7)
    assert NAMES[0] == "restitution"


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_intervals_hold_the_block_for_each_departure_from_a_plain_trace(kind):
    """In a run of the gate two traces a kind, where intervals that were wrong as often as they were would show soon."""
    result = errors(number(2, 100), 12, kind=kind)
    assert result.refused <= number(1, 10)
    assert np.all(result.within.mean(axis=0) >= number(0.5, 0.9))


@pytest.mark.long
def test_a_release_with_a_push_over_the_energy_of_the_tipping_angle():
    """The first flight is that of a body with more energy than one at rest at alpha: it has no peak."""
    clean = free_rocking(np.array([0.15]), ALPHA, P, ETA, 6.0, 100, velocity=-0.62 * P * ALPHA)[0]
    energy = 1.0 - (1.0 - 0.15 / ALPHA) ** 2 + 0.62**2  # slender, over that of alpha
    assert energy > 1.2
    time = np.arange(clean.size) / 100
    fit = identify_free_rocking(time, clean)
    assert fit["restitution"].item() == pytest.approx(ETA, abs=1e-5)
    assert fit["alpha"].item() == pytest.approx(ALPHA, rel=1e-4)
    assert fit["frequency_parameter"].item() == pytest.approx(P, rel=1e-4)


@pytest.mark.long
def test_a_moving_average_is_fitted():
    """Without noise it shifts alpha by 1 % if it is taken for the trace of a block; intervals were narrower."""
    time, rotation = trace()
    noisy = rotation + 1e-3 * np.random.default_rng(4).normal(size=time.size)
    averaged = np.convolve(noisy, np.full(9, 1.0 / 9.0), mode="valid")
    fit = identify_free_rocking(time[4:-4], averaged)
    assert "errors follow each other" in fit.attrs["warnings"]
    assert holds(fit)


def test_wider_confidence_widens_the_intervals():
    time, rotation = trace()
    noisy = rotation + 1e-3 * np.random.default_rng(2).normal(size=rotation.size)
    narrow, wide = (identify_free_rocking(time, noisy, confidence=level) for level in (0.5, 0.99))
    assert wide["alpha_lower"] < narrow["alpha_lower"] < narrow["alpha"] < narrow["alpha_upper"] < wide["alpha_upper"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t, y: (t, np.degrees(y)), "degrees"),
        (lambda t, y: (t, 0.06 * np.degrees(y)), "degrees"),
        (lambda t, y: (t[:120], y[:120]), "impacts"),
        (lambda t, y: (t, np.full(y.size, 0.1)), "0 impacts"),
        (lambda t, y: (t[::-1], y), "ascending"),
        (lambda t, y: (t[:10], y[:10]), "at least 15"),
        (lambda t, y: (50.0 * t, y), "times in seconds"),
        (lambda t, y: (1000.0 * t, y), "times in seconds"),
        (lambda t, y: (t, np.abs(y)), "none fits"),
        (lambda t, y: (t, np.where(t > 1.0, np.nan, y)), "nan"),
    ],
)
def test_refusals(change, message):
    with pytest.raises(InvalidArgumentError, match=message):
        identify_free_rocking(*change(*trace()))


def holds(fit, alpha=ALPHA, p=P, eta=ETA):
    return all(
        fit[name + "_lower"].item() <= true <= fit[name + "_upper"].item()
        for name, true in (("alpha", alpha), ("frequency_parameter", p), ("restitution", eta))
    )


def coloured(rng, size):
    """Errors that follow each other over some 20 samples."""
    return 1e-3 * math.sqrt(1.0 - 0.9**2) * lfilter([1.0], [1.0, -0.9], rng.normal(size=size + 500))[500:]


@pytest.mark.parametrize("drift", but_long([1e-4, -1e-3, 1e-2], -1e-3))
def test_a_sensor_that_drifts_is_fitted_with_its_drift(drift):
    time, rotation = trace()
    rng = np.random.default_rng(8)
    noisy = rotation + drift * time + 2e-4 * rng.normal(size=(number(2, 4), time.size))
    fits = [identify_free_rocking(time, measured) for measured in noisy]
    assert sum(map(holds, fits)) >= number(1, 3)
    assert all(fit["drift_lower"] < drift < fit["drift_upper"] for fit in fits)
    assert "the sensor drifts by" in fits[0].attrs["warnings"]


@pytest.mark.long
def test_errors_that_follow_each_other_widen_the_intervals():
    time, rotation = trace()
    rng = np.random.default_rng(9)
    fits = [identify_free_rocking(time, rotation + coloured(rng, time.size)) for _ in range(number(2, 6))]
    assert sum(map(holds, fits)) >= number(1, 5)
    assert all("errors follow each other" in fit.attrs["warnings"] for fit in fits)
    assert all(fit["noise"] > 2.0 * fit["sample_noise"] for fit in fits)
    independent = identify_free_rocking(time, rotation + 1e-3 * rng.normal(size=time.size))
    assert independent.attrs["warnings"] == ""
    assert independent["alpha_upper"] - independent["alpha_lower"] < fits[0]["alpha_upper"] - fits[0]["alpha_lower"]


SHAKEN = list(itertools.product([0.01, 0.05, 0.3], [0.7, 1.9, 4.1]))


@pytest.mark.long
@pytest.mark.parametrize("shaken", SHAKEN, ids=str)
def test_rocking_on_moving_ground_is_refused_or_has_wider_intervals(shaken):
    """The ground moves with a share of the acceleration of uplift."""
    share, hertz = shaken
    block = rocking.Block(0.5, 2.0)
    t = np.arange(0.0, 8.0, 0.005)
    pulse = np.where(t < 0.6, 1.6 * np.sin(2.0 * np.pi * t / 0.6), share * np.sin(2.0 * np.pi * hertz * t))
    ground = rocking.Record(block.uplift_acceleration * pulse, 0.005, "m/s2")
    motion = block.history(ground, restitution=0.9, samples=801, duration=8.0)
    free = motion.isel(time=motion["time"] > 0.6)
    assert motion.attrs["outcome"] == "RECOVERS"
    noise = 1e-4 * np.random.default_rng(1).normal(size=free.sizes["time"])
    try:
        fit = identify_free_rocking(free["time"], free["rotation"] + noise)
    except InvalidArgumentError as error:
        assert "ground at rest" in str(error) or "free rocking" in str(error)  # noqa: PT017
        return
    assert "wider" in fit.attrs["warnings"]
    assert holds(fit, block.alpha, block.frequency_parameter, 0.9)


@pytest.mark.parametrize("amplitude", but_long([0.1, 0.3], 0.3))
def test_an_oscillation_is_called_one(amplitude):
    time = np.arange(0.0, 6.0, 0.01)
    rotation = amplitude * np.exp(-0.4 * time) * np.cos(8.0 * time)
    with pytest.raises(InvalidArgumentError, match=r"an oscillation of 1.2[78] Hz"):
        identify_free_rocking(time, rotation + 1e-4 * np.random.default_rng(1).normal(size=time.size))


def test_a_vibration_that_is_no_rocking_is_refused():
    time = np.arange(0.0, 6.0, 0.01)
    with pytest.raises(InvalidArgumentError, match=r"free rocking|degrees"):
        identify_free_rocking(time, 0.1 * np.sin(5.0 * time) + 0.1 * np.sin(13.0 * time))
    assert rocking_assessment.identify_free_rocking is identify_free_rocking


def test_a_fit_ends_between_two_evaluations_after_its_flag_was_set():
    class SetLate(StopFlag):
        checks = 0

        def check(self):
            self.checks += 1
            if self.checks == 10:
                self.set()
            super().check()

    flag = SetLate()
    with pytest.raises(StoppedError):
        identify_free_rocking(*trace(), stop=flag)
    assert flag.checks == 10
