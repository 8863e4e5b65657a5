"""Value and slope of a pulse in the kernels."""

import numpy as np
import pytest

import rocking
from rocking._excitation.pulses import PULSE_NAMES
from rocking._numba.compilation import kernel
from rocking._numba.simd import LANES, splat, store
from rocking._solver.excitation import shapes_and_slopes
from tests.kernels import cell

SIGNED = tuple(sign + name for name in PULSE_NAMES for sign in ("", "-"))


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
