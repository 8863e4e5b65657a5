"""The record: checks, units, digest, measures of motions with known ones, processing."""

import hashlib
import math
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import resample_poly

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError

MOTIONS = Path(__file__).parents[2] / "workflow" / "motions"


def sine_record(step: float = 0.005, cycles: int = 10, period: float = 0.5, peak: float = 2.0) -> rocking.Record:
    times = np.arange(round(cycles * period / step) + 1) * step
    return rocking.Record(peak * np.sin(2 * np.pi * times / period), step, unit="m/s2", name="sine")


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ({"acceleration": [1.0]}, "acceleration"),
        ({"acceleration": [[1.0, 2.0]]}, "acceleration"),
        ({"acceleration": [0.0, 0.0, 0.0]}, "all samples 0"),
        ({"acceleration": [1.0, math.nan]}, "nan"),
        ({"acceleration": [1.0, 1e9]}, "acceleration"),
        ({"time_step": [0.01, 0.02]}, "one number"),
        ({"unit": "m/s"}, "unit"),
        ({"vertical": [0.0, 1.0, 2.0]}, r"shape \(3,\).* 2 samples"),
        ({"vertical": 0.5}, "one value for each"),
        ({"vertical": [0.0, math.inf]}, "vertical"),
        ({"vertical": [0.0, 1e9]}, "vertical"),
        ({"vertical": "up"}, "vertical"),
    ],
)
def test_invalid_arguments_are_named(arguments: dict, named: str) -> None:
    with pytest.raises(InvalidArgumentError, match=named):
        rocking.Record(**({"acceleration": [0.0, 1.0], "time_step": 0.01, "unit": "g"} | arguments))


def test_records_cannot_be_changed() -> None:
    samples = np.array([0.0, 1.0, 2.0])
    record = rocking.Record(samples, 0.01, unit="m/s2")
    samples[0] = 5.0
    assert record.acceleration[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        record.acceleration[0] = 1.0
    with pytest.raises(AttributeError):
        record.time_step = 2.0  # type: ignore[misc]


def test_digest_and_equality_depend_on_samples_and_step_only() -> None:
    record = rocking.Record([0.0, 1.0, 0.5], 0.01, unit="m/s2", name="a")
    same = rocking.Record([0.0, 100.0, 50.0], 0.01, unit="gal", name="b", source="other")
    assert record == same
    assert hash(record) == hash(same)
    assert record.digest == hashlib.sha256(np.array([0.01, 0.0, 1.0, 0.5], "<f8").tobytes()).hexdigest()
    assert record != rocking.Record([0.0, 1.0, 0.5], 0.02, unit="m/s2")


def test_a_vertical_component_belongs_to_the_record() -> None:
    upwards = np.array([0.1, -0.2, 0.0])
    arguments = {"acceleration": [0.0, 1.0, 0.5], "time_step": 0.01, "unit": "g"}
    record, plain = rocking.Record(**arguments, vertical=upwards), rocking.Record(**arguments)
    upwards[0] = 5.0
    np.testing.assert_allclose(record.vertical, np.array([0.1, -0.2, 0.0]) * STANDARD_GRAVITY, rtol=1e-15)
    with pytest.raises(ValueError, match="read-only"):
        record.vertical[0] = 1.0  # type: ignore[index]
    assert record.peak_vertical_acceleration == pytest.approx(0.2 * STANDARD_GRAVITY)
    assert repr(record) == "<rocking.Record: 3 samples at 0.01 s, PGA 1 g, with vertical, 0.2 g>"
    assert (plain.vertical, plain.peak_vertical_acceleration) == (None, 0.0)
    with_vertical = [rocking.Record(**arguments, vertical=other) for other in (np.zeros(3), [0.1, -0.2, 0.01])]
    with_vertical.append(rocking.Record([0.0, 1.0, 0.5, 0.1, -0.2, 0.0], 0.01, unit="g"))
    assert len({record.digest, plain.digest, *(other.digest for other in with_vertical)}) == 5
    assert record == rocking.Record(**arguments, vertical=[0.1, -0.2, 0.0], name="other") != plain
    assert record.arias_intensity == plain.arias_intensity


def test_processing_treats_both_components_alike() -> None:
    horizontal = sine_record()
    a = horizontal.acceleration
    record = rocking.Record(a, horizontal.time_step, "m/s2", vertical=-2.0 * a + 0.1)
    alone = rocking.Record(-2.0 * a + 0.1, horizontal.time_step, "m/s2")
    for process in (lambda motion: motion.resampled(0.002), lambda motion: motion.baseline_corrected(order=2)):
        processed = process(record)
        np.testing.assert_array_equal(processed.acceleration, process(horizontal).acceleration)
        np.testing.assert_array_equal(processed.vertical, process(alone).acceleration)
        assert process(horizontal).vertical is None


def test_measures_of_a_sine() -> None:
    record = sine_record()
    omega, peak, duration = 2 * np.pi / 0.5, 2.0, 5.0
    assert record.duration == pytest.approx(duration)
    assert record.peak_acceleration == pytest.approx(peak, rel=1e-12)
    assert record.peak_velocity == pytest.approx(2 * peak / omega, rel=1e-3)
    assert record.peak_displacement == pytest.approx(peak / omega * duration, rel=1e-3)
    assert record.arias_intensity == pytest.approx(math.pi / (2 * STANDARD_GRAVITY) * peak**2 * duration / 2, rel=1e-3)
    assert record.significant_duration == pytest.approx(0.9 * duration, rel=0.02)
    assert record.mean_period == pytest.approx(0.5, rel=0.05)
    assert record.final_velocity == pytest.approx(0.0, abs=1e-12)


def test_a_record_that_leaves_the_ground_moving_is_named() -> None:
    complete = sine_record()
    half = rocking.Record(
        complete.acceleration[: round(0.25 / complete.time_step) + 1], complete.time_step, unit="m/s2"
    )
    for motion, moves in ((complete, False), (half, True)):
        response = rocking.Block(0.4, 1.6).response(motion, thresholds=False)
        assert any("velocity of the record ends at 100 %" in text for text in response.warnings) == moves


def padded_mean_period(a: np.ndarray, dt: float) -> float:
    """The definition: a whole transform of the record with zeros until the frequencies are 0.05 Hz apart."""
    size = max(a.size, math.ceil(20.0 / dt))
    frequency, power = np.fft.rfftfreq(size, dt), np.abs(np.fft.rfft(a, size)) ** 2
    band = (frequency >= 0.25) & (frequency <= 20.0)
    return float((power[band] / frequency[band]).sum() / power[band].sum())


def test_the_mean_period_is_that_of_the_padded_record() -> None:
    for path in sorted(MOTIONS.glob("*.csv")):
        motion = rocking.read_record(path)
        assert motion.mean_period == padded_mean_period(motion.acceleration, motion.time_step)
    random = np.random.default_rng(1)
    for count, step in ((3, 0.02), (50, 0.01), (200, 1e-3), (40, 1e-4), (3000, 1e-4)):  # shorter than a 16th of 20 s
        short = rocking.Record(random.normal(size=count), step, "m/s2")
        assert short.mean_period == pytest.approx(padded_mean_period(short.acceleration, step), rel=1e-12)


def test_the_mean_period_needs_no_more_memory_than_the_record() -> None:
    record = rocking.Record([0.0, 1.0, -2.0], 1e-6, "m/s2")
    assert math.isfinite(record.mean_period)
    tracemalloc.start()
    try:
        assert math.isfinite(record.mean_period)
        assert tracemalloc.get_traced_memory()[1] < 1_000_000  # a transform of 20 s takes 320 MB
    finally:
        tracemalloc.stop()


def test_records_that_are_too_long_are_rejected() -> None:
    assert rocking.Record(np.ones(10_001), 10.0, "g").duration == 1e5
    with pytest.raises(InvalidArgumentError, match="at most 100000 s, with 10002 samples"):
        rocking.Record(np.ones(10_002), 10.0, "g")
    with pytest.raises(InvalidArgumentError, match="at most 10000000 samples, not 10999001"):
        rocking.Record(np.ones(11_000), 0.01, "g").resampled(1e-5)


@pytest.mark.parametrize("order", [0, 1, 2, 4])
def test_baseline_correction_removes_a_polynomial_of_its_order(order: int) -> None:
    clean = sine_record(cycles=40).acceleration
    time = np.linspace(0.0, 1.0, clean.size)
    drift = sum(1.0 * (k + 1) * time**k for k in range(order + 1))
    record = rocking.Record(clean + drift, 0.005, unit="m/s2")
    corrected = record.baseline_corrected(order=order)
    left = rocking.Record(clean, 0.005, unit="m/s2").baseline_corrected(order=order)
    # the drift is linear between samples
    np.testing.assert_allclose(corrected.acceleration, left.acceleration, atol=1e-6)
    assert abs(corrected.final_velocity) < 0.2 * abs(record.final_velocity)
    assert record.mean_acceleration == pytest.approx(record.final_velocity / record.duration)


@pytest.mark.parametrize(
    ("up", "down", "samples"), [(8, 1, 400), (1, 2, 401), (7, 3, 60), (3, 7, 300), (999, 1000, 90), (1, 1000, 2001)]
)
def test_resampling_is_the_polyphase_filter_of_scipy(up: int, down: int, samples: int) -> None:
    record = rocking.Record(np.random.default_rng(up).standard_normal(samples), 0.01, unit="m/s2")
    resampled = record.resampled(0.01 * down / up).acceleration
    expected = resample_poly(record.acceleration, up, down, window=("kaiser", 8.0))[: resampled.size]
    np.testing.assert_allclose(resampled, expected, rtol=0.0, atol=1e-14 * record.peak_acceleration)


def test_what_a_record_cannot_become_is_rejected() -> None:
    with pytest.raises(InvalidArgumentError, match="fraction"):
        sine_record().resampled(0.005 * math.pi)
    with pytest.raises(InvalidArgumentError, match="duration"):
        sine_record(cycles=1).resampled(2.0)
    for order in (-1, 7, 1.5):
        with pytest.raises(InvalidArgumentError, match="order"):
            sine_record().baseline_corrected(order=order)  # type: ignore[arg-type]
