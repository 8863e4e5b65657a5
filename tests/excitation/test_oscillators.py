"""Linear oscillators: motion of floors and elastic spectra, against other integrations, closed forms and limits."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import lsim

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._excitation.records.floor import floor_motion, isolated_motion

rng = np.random.default_rng(3)
NOISE = np.concatenate([np.zeros((2, 1)), rng.normal(size=(2, 299))], axis=1)
GROUND = rocking.Record(NOISE[0], 0.01, "m/s2", "noise", "made up", vertical=0.1 * NOISE[1])


def test_modes_agree_with_lsim():
    periods, damping, gamma = np.array([0.4, 0.09]), np.array([0.05, 0.9]), np.array([1.3, -0.4])
    floor = floor_motion(GROUND, periods=periods, damping=damping, participation=gamma)
    ground = np.where(floor.times <= GROUND.duration, np.interp(floor.times, GROUND.times, GROUND.acceleration), 0.0)
    expected = (1.0 - gamma.sum()) * ground
    for omega, zeta, factor in zip(2.0 * np.pi / periods, damping, gamma, strict=True):
        system = [2.0 * zeta * omega, omega**2], [1.0, 2.0 * zeta * omega, omega**2]
        expected += factor * lsim(system, ground, floor.times)[1]
    during = floor.times <= GROUND.duration + 1e-9  # lsim has a ramp where the ground stops at once
    np.testing.assert_allclose(floor.acceleration[during], expected[during], atol=1e-11)


def test_a_step_of_the_ground_gives_the_closed_form_and_rings_out_after_it():
    step = rocking.Record(np.ones(401), 0.005, "m/s2")
    omega, zeta = 2.0 * np.pi / 0.5, 0.1
    floor = isolated_motion(step, period=0.5, damping=zeta)
    damped = omega * np.sqrt(1.0 - zeta**2)

    # absolute acceleration q'' + 1 for q(0) = q'(0) = 0 (Chopra, section 4.3)
    def response(t):
        shape = np.cos(damped * t) - zeta / np.sqrt(1.0 - zeta**2) * np.sin(damped * t)
        return np.where(t < 0.0, 0.0, 1.0 - np.exp(-zeta * omega * t) * shape)

    expected = response(floor.times) - response(floor.times - step.duration)
    np.testing.assert_allclose(floor.acceleration, expected, atol=1e-12)
    assert floor.duration == pytest.approx(step.duration + 5.0)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_the_interpolation_error_is_within_the_tolerance(tolerance):
    floor = floor_motion(GROUND, periods=0.15, relative_tolerance=tolerance, tail=0.5)
    finest = floor_motion(GROUND, periods=0.15, relative_tolerance=1e-6, tail=0.5)
    between = np.interp(finest.times, floor.times, floor.acceleration)
    error = np.abs(between - finest.acceleration).max()
    assert error <= 1.05 * tolerance * floor.peak_acceleration
    assert float(floor.source.split(" to ")[-1].split()[0]) == pytest.approx(error, rel=0.15)


def test_a_stiff_structure_follows_the_ground_and_a_soft_one_does_not():
    stiff = floor_motion(GROUND, periods=1e-3, damping=0.7, relative_tolerance=0.1)
    at_samples = stiff.acceleration[:: round(GROUND.time_step / stiff.time_step)][: GROUND.samples]
    np.testing.assert_allclose(at_samples, GROUND.acceleration, atol=0.02)
    assert isolated_motion(GROUND, period=50.0, damping=0.05).peak_acceleration < 0.02 * GROUND.peak_acceleration


def test_the_vertical_component_is_passed_through_or_filtered():
    passed, filtered = (floor_motion(GROUND, periods=0.2, vertical=how) for how in ("pass", "filter"))
    parts = round(GROUND.time_step / passed.time_step)
    np.testing.assert_allclose(passed.vertical[::parts][: GROUND.samples], GROUND.vertical, rtol=1e-13)
    assert not passed.vertical[GROUND.samples * parts :].any()
    alone = floor_motion(rocking.Record(GROUND.vertical, 0.01, "m/s2"), periods=0.2, relative_tolerance=1e-4)
    ratio = round(filtered.time_step / alone.time_step)
    np.testing.assert_allclose(filtered.vertical, alone.acceleration[::ratio][: filtered.samples], atol=1e-12)


@pytest.mark.parametrize(
    "arguments",
    [{"periods": 0.0}, {"periods": []}, {"periods": [0.1, 0.2], "damping": [0.1] * 3}, {"periods": 1.0, "damping": 1.0},
     {"periods": 1.0, "vertical": "drop"}, {"periods": 1.0, "tail": 1e5}, {"periods": 0.1, "tail": 1e4}],
)  # fmt: skip
def test_refusals(arguments):
    with pytest.raises(InvalidArgumentError, match="relative_tolerance" if arguments.get("tail") == 1e4 else "allowed"):
        floor_motion(GROUND, **arguments)


TIMES = np.arange(0, 4, 0.01)
MOTION = rocking.Record(np.sin(7 * TIMES) * np.sin(2.1 * TIMES**2) * np.exp(-TIMES) * 3, 0.01, "m/s2", vertical=TIMES)

EQSIG = {
    0.02: [7.98787e-05, 0.003289669, 0.06115672, 0.1516137],
    0.2: [7.985389e-05, 0.003261166, 0.0377711, 0.09598325],
}
"""S_D [m] by eqsig 1.2.17 (MIT licence), `eqsig.sdof.pseudo_response_spectra` of the motion, interpolated to steps of
0.5 ms and followed by 10 s of rest, at periods of 0.05, 0.3, 1 and 3 s."""


def test_it_agrees_with_eqsig() -> None:
    """Seven digits."""
    spectrum = rocking.elastic_spectrum(MOTION, [0.05, 0.3, 1.0, 3.0], list(EQSIG))
    assert spectrum.displacement.values == pytest.approx(np.array(list(EQSIG.values())), rel=1e-5)
    omega = 2 * np.pi / spectrum.period
    np.testing.assert_allclose(spectrum.pseudo_acceleration, spectrum.displacement * omega**2)


@pytest.mark.parametrize(("period", "zeta"), [(0.02, 0.05), (0.07, 0.0), (0.7, 0.3), (5.0, 0.05)])
def test_it_is_exact_between_samples_and_after_the_record(period: float, zeta: float) -> None:
    """DOP853 over each step with the times of zero velocity; short periods and the free vibration included."""
    short = rocking.Record(MOTION.acceleration[:60], 0.01, "m/s2")
    omega, a, state, largest = 2 * np.pi / period, short.acceleration, np.zeros(2), 0.0
    for k in range(a.size):
        last = k == a.size - 1
        slope = 0.0 if last else (a[k + 1] - a[k]) / 0.01

        def rate(t, y, k=k, slope=slope, last=last):  # type: ignore[no-untyped-def]
            return [y[1], -2 * zeta * omega * y[1] - omega**2 * y[0] - (0.0 if last else a[k] + slope * t)]

        options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-16, "events": lambda _, y: y[1]}
        way = solve_ivp(rate, (0, period if last else 0.01), state, **options)
        state = way.y[:, -1]
        largest = max([largest, abs(state[0]), *(abs(y[0]) for y in way.y_events[0])])
    assert rocking.elastic_spectrum(short, period, zeta).displacement.item() == pytest.approx(largest, rel=1e-9)


def test_limits_and_errors() -> None:
    """A stiff oscillator follows either component of the ground; a component that is absent is refused."""
    for component, peak in (("horizontal", MOTION.peak_acceleration), ("vertical", TIMES[-1])):
        stiff = rocking.elastic_spectrum(MOTION, 1e-3, component=component).pseudo_acceleration.item()
        assert stiff == pytest.approx(peak, rel=1e-3)
    level = rocking.Record(MOTION.acceleration, 0.01, "m/s2")
    with pytest.raises(rocking.InvalidArgumentError, match="no vertical component"):
        rocking.elastic_spectrum(level, 1.0, component="vertical")
    for name, wrong in (("periods", {"periods": [[1.0]]}), ("damping", {"periods": 1.0, "damping": 1.0})):
        with pytest.raises(rocking.InvalidArgumentError, match=name):
            rocking.elastic_spectrum(level, **wrong)
