"""Exact arcs of the slender block, mainly under wavelets, against integrals by quadrature and against Taylor steps."""

import math

import mpmath
import numpy as np
import pytest

import rocking
from rocking._excitation.pulses import WaveletPulse
from rocking._solver.families.wavelets import WAVELET_SERIES_LENGTH
from rocking._solver.peak_response import solve_cells
from rocking._solver.stages.batch import LEFT
from rocking._solver.state import FULL_PRECISION
from tests.solver.test_stages import assert_agree, assert_equal, by_event_loop, by_stages_alone, cells

NAMES = ["ricker", "-ricker", "ricker_antisymmetric", "-ricker_antisymmetric"]


def cubic_wavelet():
    """A wavelet without symmetry, with all four coefficients and another spread, on a window that cuts its flanks."""
    shape, start, end, spread = np.polynomial.Polynomial([0.4, -1.0, -0.7, 0.5]), -4.0, 6.0, 5.3
    turns = (shape.deriv() - shape * np.polynomial.Polynomial([0.0, 2.0 / spread])).roots().real
    phases = np.array([start, *turns, end])
    peak = np.abs(shape(phases) * np.exp(-phases * phases / spread)).max()
    return WaveletPulse("cubic", start, end, (), tuple(shape.coef / peak), spread)


PULSES = {name: rocking.pulse(name) for name in NAMES} | {"cubic": cubic_wavelet()}


def frequencies(pulse, s, w):
    return s, np.maximum(w, pulse.series.least_arc_frequency)


def exact_shape(pulse, phi):
    if isinstance(pulse, WaveletPulse):
        return mpmath.polyval(pulse.polynomial, phi, asc=True) * mpmath.exp(-phi * phi / mpmath.mpf(pulse.spread))
    return sum(c * mpmath.cos(w * phi + d) for c, w, d in pulse.terms)


@pytest.mark.parametrize("name", [*PULSES, "sine", "-cosine", "c2", "mavroeidis_papageorgiou"])
def test_first_impact_satisfies_the_equation_of_motion(name):
    """z = -integral of sinh(h - t) (1 + F(t)) dt vanishes at the first impact, and its velocity is that with cosh."""
    pulse = PULSES.get(name) or rocking.pulse(name)
    s, w, _ = cells(60, 1)
    s = np.where(s < 0.97, s, 0.3)
    s, w = frequencies(pulse, s, w)
    found = solve_cells(pulse, [s, w, np.zeros(s.size), np.zeros(s.size)], FULL_PRECISION, 1, None)
    hit = np.flatnonzero(np.isfinite(found["first_impact_time"]))[:8]
    assert hit.size == 8
    with mpmath.workdps(25):
        for i in hit:
            start, h = float(found["uplift_time"][i]), mpmath.mpf(float(found["first_impact_time"][i]))
            first = mpmath.mpf(pulse.start) + mpmath.mpf(w[i]) * start
            sign = -np.sign(pulse.shape(float(first) + 1e-12))

            def q(tau, first=first, sign=sign, i=i):
                phi = first + mpmath.mpf(w[i]) * tau
                return 1 + sign / mpmath.mpf(s[i]) * exact_shape(pulse, phi)

            nodes = mpmath.linspace(0, h, 2 + int(w[i] * h))
            z = -mpmath.quad(lambda tau: mpmath.sinh(h - tau) * q(tau), nodes)  # noqa: B023
            velocity = -mpmath.quad(lambda tau: mpmath.cosh(h - tau) * q(tau), nodes)  # noqa: B023
            # the uplift time is rounded, which the growing exponential amplifies
            slack = 3e-14 * math.exp(float(h)) * (1.0 + w[i])
            impact = abs(float(found["first_impact_velocity"][i]))
            assert abs(float(z)) < slack * impact
            assert abs(float(velocity) + impact) < slack * (1.0 + impact)


@pytest.mark.parametrize("name", PULSES)
def test_arcs_and_taylor_steps_agree(name):
    pulse = PULSES[name]
    s, w, eta = cells(1000, list(PULSES).index(name))
    s, w = frequencies(pulse, s, w)
    arcs = solve_cells(pulse, [s, w, eta, np.zeros(s.size)], FULL_PRECISION, 1, None)
    steps = by_event_loop(pulse, s, w, eta)
    assert_agree(arcs, steps, s, eta)


@pytest.mark.parametrize("name", PULSES)
def test_few_cells_are_left_to_taylor_steps(name):
    """The tangents decide on nearly all cells; what they leave has the bits of the Taylor steps."""
    pulse = PULSES[name]
    s, w, eta = cells(3000, 3)
    s, w = frequencies(pulse, s, w)
    eta = np.minimum(eta, 0.95)  # above, many impacts are left to the Taylor steps
    left = by_stages_alone(pulse, s, w, eta)["outcome"] == LEFT
    assert np.count_nonzero(left) < 0.02 * s.size
    found = solve_cells(pulse, [s, w, eta, np.zeros(s.size)], FULL_PRECISION, 1, None)
    assert (found["outcome"] >= 0).all()
    assert_equal(found[left], by_event_loop(pulse, s[left], w[left], eta[left]))


@pytest.mark.parametrize("name", PULSES)
def test_derivatives_and_their_bound(name):
    """f is the sum of h_k times the derivatives of the Gaussian; its n-th derivative is at most growth_rate^n."""
    pulse = PULSES[name]
    series = pulse.series
    phi = np.linspace(-8.0, 8.0, 2001)
    factor = np.polynomial.Polynomial([0.0, -2.0 / pulse.spread])
    gaussian = np.exp(-phi * phi / pulse.spread)
    term, total = np.polynomial.Polynomial([1.0]), np.zeros(phi.size)
    for h in series.derivatives:
        total += h * term(phi) * gaussian
        term = term.deriv() + factor * term
    np.testing.assert_allclose(total, pulse.shape(phi), atol=1e-14)
    order = WAVELET_SERIES_LENGTH - 2
    shape = np.polynomial.Polynomial(pulse.polynomial)
    for _ in range(order):
        shape = shape.deriv() + factor * shape
    largest = np.abs(shape(phi) * gaussian).max()
    rate = series.growth_rate(order)
    assert 0.7 * rate < largest ** (1.0 / order) <= rate
