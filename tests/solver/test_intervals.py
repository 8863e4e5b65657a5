"""Intervals of a pulse: their ends are all sign changes of 1 +- a f and of f', and the signs between them are right."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking
from rocking._excitation.pulses import PULSE_NAMES, AbstractPulse
from rocking._numba.compilation import kernel
from rocking._numba.simd import LANES, splat, store
from rocking._solver.excitation import shapes_and_slopes
from tests.kernels import cell
from tests.sampling import number

SIGNED = tuple(sign + name for name in PULSE_NAMES for sign in ("", "-"))
OTHERS = (
    rocking.pulse("mavroeidis_papageorgiou", cycles=1.1, phase=1.0),
    rocking.pulse("mavroeidis_papageorgiou", cycles=20.0, phase=-2.0),
    rocking.pulse("mavroeidis_papageorgiou", cycles=3.3, phase=0.4),
)
SLENDERNESS = st.one_of(st.floats(1e-4, 1 - 1e-6), st.floats(-12, -2).map(lambda x: 1 - 10**x))


def check_cuts(pulse: AbstractPulse, slenderness: float) -> None:
    flight = cell(pulse, slenderness, 1.0)
    count = int(flight["interval_count"])
    phase = flight["interval_phase"][: count + 1]
    level, rise = flight["interval_level"][:count], flight["interval_slope"][:count]
    assert phase[0] == pulse.start
    assert phase[-1] == pulse.end
    assert (np.diff(phase) >= 0).all()
    assert set(pulse.stationary) <= set(phase.tolist())
    # the other ends are where |a f| = 1; the accuracy of f is limited by the rounding of the angles
    own = set(pulse.stationary) | {pulse.start, pulse.end}
    for phi in phase:
        if phi not in own:
            miss = abs(abs(float(pulse.shape(phi))) - slenderness)
            assert miss <= 8e-16 * (3 + max(abs(phi), 6.0))
    wide = np.flatnonzero(np.diff(phase) > 1e-6)
    inside = phase[wide, None] + np.diff(phase)[wide, None] * np.linspace(0.01, 0.99, 33)
    f = pulse.shape(inside)
    margin = 1e-12
    np.testing.assert_array_equal(f > slenderness + margin, (level[wide, None] > 0) & (f > slenderness + margin))
    assert (f[level[wide] > 0] > slenderness - margin).all()
    assert (f[level[wide] < 0] < -slenderness + margin).all()
    assert (np.abs(f[level[wide] == 0]) < slenderness + margin).all()
    change = np.diff(f, axis=1) * rise[wide, None]
    assert (change > -1e-14).all()


@pytest.mark.parametrize("name", SIGNED)
def test_intervals_of_every_pulse(name):
    @given(slenderness=SLENDERNESS)
    @settings(max_examples=number(15, 40))
    def check(slenderness):
        check_cuts(rocking.pulse(name), slenderness)

    check()


@pytest.mark.parametrize("pulse", OTHERS)
def test_intervals_of_sums_of_sinusoids(pulse):
    for slenderness in (1e-3, 0.05, 0.3, 0.7, 0.99, 1 - 1e-9):
        check_cuts(pulse, slenderness)
        check_cuts(pulse.mirrored(), slenderness)


def test_intervals_of_a_sine():
    flight = cell("sine", 0.5, 1.0)
    assert int(flight["interval_count"]) == 7  # start, 4 crossings of |a f| = 1, 2 crests, end
    np.testing.assert_allclose(
        flight["interval_phase"][:8] / np.pi, [0, 1 / 6, 1 / 2, 5 / 6, 7 / 6, 3 / 2, 11 / 6, 2], rtol=1e-15, atol=1e-15
    )


def test_interval_near_onset_keeps_its_digits():
    for gap in 10.0 ** np.arange(-1.0, -15.0, -1.0):
        slenderness = 1 - gap
        exact_gap = 1 - slenderness  # as rounded
        flight = cell("sine", slenderness, 1.0)
        half = float(flight["interval_phase"][2] - flight["interval_phase"][1])
        # cos(half) = 1 - gap; a rounded phase near pi/2 keeps 1e-16 absolute
        assert half == pytest.approx(2 * np.arcsin(np.sqrt(exact_gap / 2)), rel=1e-15, abs=3e-16)


@kernel
def evaluate(flight, phi, found):
    f, slope = shapes_and_slopes(flight, splat(phi))
    store(found, 0, f)
    store(found, 1, slope)


def shape_and_slope(flight, phi):
    found = np.empty((2, LANES))
    evaluate(flight, phi, found)
    return found[:, 0]


def test_slope_is_the_derivative():
    for name in SIGNED:
        pulse, flight = rocking.pulse(name), cell(name, 0.5, 1.0)
        for phi in np.linspace(pulse.start, pulse.end, 41):
            f, slope = shape_and_slope(flight, float(phi))
            assert f == pytest.approx(float(pulse.shape(phi)), abs=4e-15)
            step = 1e-5
            difference = float(pulse.shape(phi + step) - pulse.shape(phi - step)) / (2 * step)
            assert slope == pytest.approx(difference, abs=2e-9)
