"""Wavelets f = (sum of polynomial[k] phi^k) exp(-phi^2/spread), `rocking._excitation.wavelets`."""

import math
from typing import Any

import numpy as np

from rocking._excitation.series import Family
from rocking._excitation.wavelets import MAX_POLYNOMIAL, WaveletSeries
from rocking._numba.compilation import Fields, Record, Series, SimdVector, kernel
from rocking._numba.simd import load, splat, store
from rocking._numba.simd_functions import exponential

WAVELET = int(Family.WAVELET)

WAVELET_SERIES_LENGTH = 23  # length of the series at the start of the slender arcs under wavelets

WAVELET_FIELDS: Fields = [("spread", np.float64), ("polynomial", np.float64, (MAX_POLYNOMIAL,))]

WAVELET_ARC_FIELDS: Fields = [
    ("derivatives", np.float64, (MAX_POLYNOMIAL,)),  # see `WaveletSeries`
    ("growth_rate", np.float64),  # bound of the growth of its derivatives [1/rad]
]


def fill_wavelet(record: Record, series: WaveletSeries) -> None:
    """Write a wavelet."""
    record["spread"], record["series_length"] = series.spread, WAVELET_SERIES_LENGTH
    record["polynomial"][: len(series.polynomial)] = series.polynomial
    record["derivatives"] = series.derivatives
    record["growth_rate"] = series.growth_rate(WAVELET_SERIES_LENGTH - 2)


@kernel
def polynomial_at(pulse: Record, phase: SimdVector) -> Any:
    """The polynomial of the wavelet, its first and half of its second derivative."""
    p = pulse.polynomial
    value = p[0] + phase * (p[1] + phase * (p[2] + phase * p[3]))
    slope = p[1] + phase * (2.0 * p[2] + phase * (3.0 * p[3]))
    return value, slope, p[2] + phase * (3.0 * p[3])


@kernel
def wavelet_at(phi: float, flight: Record) -> float:
    """f of the excitation."""
    f = 0.0
    for i in range(MAX_POLYNOMIAL):
        f = f * phi + flight.polynomial[MAX_POLYNOMIAL - 1 - i]
    return f * math.exp(-phi * phi / flight.spread)


@kernel
def wavelets_and_slopes(pulse: Record, phase: SimdVector) -> Any:
    """f [-] and df/dphi at phases."""
    value, first, _ = polynomial_at(pulse, phase)
    gaussian = exponential(phase * phase * (-1.0 / pulse.spread))
    return value * gaussian, (first + phase * (-2.0 / pulse.spread) * value) * gaussian


@kernel
def expand_wavelet(steps: Record) -> None:
    """Fill `f` with the coefficients of F in powers of tau about `phase`."""
    phase = load(steps.phase, 0)
    gaussian = exponential(phase * phase * (-1.0 / steps.spread))
    expand_gaussian_product(
        steps, steps.f, steps.gauss, phase, gaussian, load(steps.omega, 0), load(steps.strength, 0), steps.order
    )


@kernel
def expand_gaussian_product(
    wavelet: Record,
    f: Series,
    gauss: Series,
    phase: SimdVector,
    gaussian: SimdVector,
    omega: SimdVector,
    strength: SimdVector,
    order: int,
) -> None:
    """Fill `f` with the coefficients of `strength` f in powers of tau about `phase`, where the Gaussian is `gaussian`.

    `gauss` becomes the coefficients of the Gaussian in powers of phi.
    """
    p = wavelet.polynomial
    # g = exp(-phi^2/spread): g' = -(2 phi/spread) g, so (n + 1) g_{n+1} = -(2/spread)(phi g_n + g_{n-1})
    decay = -2.0 / wavelet.spread
    before, here = splat(0.0), gaussian
    for n in range(order + 1):
        store(gauss, n, here)
        before, here = here, (phase * here + before) * (decay / (n + 1.0))
    # the polynomial about the phase, of third degree, times the series of the Gaussian, in powers of tau
    constant = p[0] + phase * (p[1] + phase * (p[2] + phase * p[3]))
    linear = p[1] + phase * (2.0 * p[2] + phase * (3.0 * p[3]))
    square = p[2] + 3.0 * p[3] * phase
    power = strength
    for n in range(order + 1):
        total = constant * load(gauss, n)
        if n > 0:
            total += linear * load(gauss, n - 1)
        if n > 1:
            total += square * load(gauss, n - 2)
        if n > 2:
            total += p[MAX_POLYNOMIAL - 1] * load(gauss, n - 3)
        store(f, n, power * total)
        power = power * omega
