"""Smooth pulses of one's own: their polynomials and extremes, equality, and what is refused."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from rocking._base.errors import InvalidArgumentError
from rocking._excitation.polynomials import DEGREE, MAX_POLYNOMIALS
from rocking._excitation.shapes import MAX_PIECES
from rocking._excitation.smooth import SmoothPulse

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Chirp(SmoothPulse):
    """A decaying sine whose frequency grows."""

    decay: float
    growth: float

    def curve(self, phi):
        return np.exp(-self.decay * phi) * np.sin(phi + self.growth * phi**2)


@dataclass(frozen=True)
class Given(SmoothPulse):
    """A function given when the pulse is made."""

    function: object

    def curve(self, phi):
        return self.function(phi)


CHIRP = Chirp("chirp", 0.0, 8.0 * math.pi, decay=0.1, growth=0.05)


@pytest.mark.parametrize(
    ("function", "start", "end"),
    [
        (np.sin, 0.0, 40.0 * math.pi),
        (lambda phi: 1e-30 * np.cos(phi), 1e3, 1e3 + 7.0),
        (lambda phi: (1.0 - phi * phi / 2.0) * np.exp(-phi * phi / 4.0), -4.0 * math.pi, 4.0 * math.pi),
        (lambda phi: np.tanh(4.0 * (phi - 1.5)) - np.tanh(4.0 * (phi - 8.0)), 0.0, 10.0),
        (lambda phi: 1.0 / (1.0 + 25.0 * phi * phi), -1.0, 1.0),
        (lambda phi: 1.0 + np.maximum(phi - 1.3, 0.0) ** 2, 0.0, 3.0),
        (lambda phi: 3.0 + 0.0 * phi, 0.0, 1.0),
        (lambda phi: phi - 0.3, 0.0, 1.0),
        (CHIRP.curve, CHIRP.start, CHIRP.end),
    ],
)
def test_polynomials_equal_the_function_to_rounding(function, start, end):
    pulse = Given("given", start, end, function)
    phi = np.random.default_rng(1).uniform(start, end, 20_000)
    slope = np.abs(np.gradient(function(np.linspace(start, end, 20_001)), (end - start) / 20_000)).max()
    allowed = 4.0 * EPS * (1.0 + slope / abs(pulse.peak) * max(abs(start), abs(end)))
    assert np.abs(pulse.polynomials(phi) - function(phi) / pulse.peak).max() <= allowed
    assert pulse.polynomials.coefficients.shape[1] == DEGREE + 1
    assert len(pulse.polynomials.coefficients) <= MAX_POLYNOMIALS


def test_extremes_are_those_of_the_function():
    sine = Given("sine", 0.0, 2.0 * math.pi, np.sin)
    np.testing.assert_allclose(sine.stationary, [0.5 * math.pi, 1.5 * math.pi], rtol=0.0, atol=1e-13)
    ricker = Given("r", -12.0, 12.0, lambda phi: (1.0 - phi * phi / 2.0) * np.exp(-phi * phi / 4.0))
    np.testing.assert_allclose(ricker.stationary, [-math.sqrt(6.0), 0.0, math.sqrt(6.0)], rtol=0.0, atol=1e-12)
    assert Given("line", 0.0, 1.0, lambda phi: phi - 0.3).stationary == ()
    # a plateau counts as one extreme, and rounding on it as none
    plateau = Given("plateau", 0.0, 10.0, lambda phi: np.tanh(4.0 * (phi - 1.5)) - np.tanh(4.0 * (phi - 8.0)))
    assert len(plateau.stationary) == 1
    # between two neighbouring extremes the chirp is monotone, and all of them are there
    phi = np.linspace(CHIRP.start, CHIRP.end, 200_001)
    turns = np.flatnonzero(np.diff(np.sign(np.diff(CHIRP.shape(phi))))) + 1
    np.testing.assert_allclose(CHIRP.stationary, phi[turns], rtol=0.0, atol=2e-4)
    assert float(np.abs(CHIRP.acceleration(CHIRP.stationary)).max()) == 1.0


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda phi: np.where(phi < 1.3, 1.0, -0.5), "not resolved near phi = 1.3 rad.*SampledPulse"),
        (lambda phi: np.abs(phi - 1.3), "not resolved near phi = 1.3 rad"),
        (np.sqrt, "not resolved near phi = 0 rad"),
        (lambda phi: np.sin(400.0 * phi), "at most 128 polynomials"),
        (lambda phi: np.random.default_rng(int(1e6 * phi[0])).normal(size=phi.size), "not resolved"),
        (lambda phi: 0.0 * phi, "0 on the whole window"),
        (lambda phi: np.log(phi - 1.0 + 0j).real - np.where(phi < 1.0, np.inf, 0.0), "finite numbers"),
        (lambda phi: phi[:-1], "one number for each"),
        (lambda _: "one", "a number"),
        (lambda phi: phi + 1j, "real numbers"),
    ],
)
def test_what_is_not_a_smooth_function_is_refused(function, message):
    with pytest.raises(InvalidArgumentError, match=message) as caught:
        Given("given", 0.0, 3.0, function)
    assert caught.value.parameter == "curve"


@pytest.mark.parametrize(
    ("name", "start", "end", "message"),
    [
        ("", 0.0, 1.0, "`name`"),
        ("given", 1.0, 1.0, "`end`"),
        ("given", "now", 1.0, "`start`"),
        ("given", 0.0, 2e6, "`end`"),
        ("given", 0.0, 90.0 * math.pi, f"90 extremes.*fewer than {MAX_PIECES}"),
    ],
)
def test_names_and_windows_are_checked(name, start, end, message):
    with pytest.raises(InvalidArgumentError, match=message):
        Given(name, start, end, np.sin)


def test_equality_and_mirror_image():
    again = Chirp("chirp", 0.0, 8.0 * math.pi, decay=0.1, growth=0.05)
    assert (again, hash(again)) == (CHIRP, hash(CHIRP))
    assert Chirp("chirp", 0.0, 8.0 * math.pi, decay=0.1, growth=0.06) != CHIRP
    mirrored = CHIRP.mirrored()
    assert (type(mirrored), mirrored.name, mirrored.mirrored()) == (Chirp, "-chirp", CHIRP)
    phi = np.linspace(CHIRP.start, CHIRP.end, 101)
    np.testing.assert_array_equal(mirrored.shape(phi), -CHIRP.shape(phi))
    np.testing.assert_array_equal(mirrored.polynomials(phi), -CHIRP.polynomials(phi))
    # curves that differ in what is no field of the pulse are different pulses
    assert Given("given", 0.0, 1.0, np.sin).digest != Given("given", 0.0, 1.0, np.cos).digest
