"""The excitation inside the solver: the one place that distinguishes families of f(phi).

`fill_excitation` writes an excitation into a record, `shapes_and_slopes` evaluates f and its derivative,
`expand_excitation` expands F in powers of tau for a Taylor step, and `has_exact_arcs` selects between exact arcs and
Taylor steps. A further family, such as a piecewise linear record, adds its coefficients to `excitation_fields` and a
case to each of these functions. The record has one layout for all families, so that each kernel is compiled once.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking._numba.compilation import Record, Series, SimdVector, kernel
from rocking._numba.simd import load, splat, store
from rocking._numba.simd_exponentials import exponential
from rocking._numba.simd_sines import sine_and_cosine
from rocking.excitation.series import ExcitationSeries, Family
from rocking.excitation.shapes import MAX_POLYNOMIAL, MAX_SINUSOIDS
from rocking.solver.families.polynomials import (
    POLYNOMIAL_FIELDS,
    POLYNOMIALS,
    expand_polynomials,
    fill_polynomials,
    polynomial_value,
    polynomial_values_and_slopes,
)

SINUSOIDS, WAVELET = int(Family.SINUSOIDS), int(Family.WAVELET)


def excitation_fields() -> list[tuple[str, type] | tuple[str, type, tuple[int, ...]]]:
    """Fields of a record that describe an excitation."""
    per_term = (MAX_SINUSOIDS,)
    return [
        ("family", np.int64),  # see `Family`
        ("terms", np.int64),  # number of sinusoids c cos(w phi + d); a wavelet has one of amplitude 0
        ("amplitude", np.float64, per_term),  # c
        ("multiple", np.float64, per_term),  # w
        ("shift", np.float64, per_term),  # d
        ("spread", np.float64),  # wavelet: f = (sum polynomial[k] phi^k) exp(-phi^2/spread)
        ("polynomial", np.float64, (MAX_POLYNOMIAL,)),
        *POLYNOMIAL_FIELDS,
    ]


EXCITATION_FIELDS = tuple(str(field[0]) for field in excitation_fields())
"""Names of these fields."""


def fill_excitation(record: Record, series: ExcitationSeries) -> None:
    """Write an excitation into a record with `excitation_fields`, which is zero on entry."""
    count = len(series.terms)
    amplitude, multiple, shift = (np.array(column) for column in zip(*series.terms, strict=True))
    record["family"], record["terms"] = series.family, count
    record["amplitude"][:count], record["multiple"][:count], record["shift"][:count] = amplitude, multiple, shift
    record["spread"] = series.spread
    record["polynomial"][: len(series.polynomial)] = series.polynomial
    fill_polynomials(record, series)


@kernel
def has_exact_arcs(flight: Record, alpha: float) -> bool:
    """Whether the motion consists of exact arcs (3.4): slender blocks under sums of sinusoids."""
    return alpha == 0.0 and flight.family == SINUSOIDS


@kernel
def is_unit_sinusoid(flight: Record) -> bool:
    """Whether f is one sinusoid of amplitude 1 and frequency 1, for which phases of |a f| = 1 have closed forms."""
    return (
        flight.family == SINUSOIDS
        and flight.terms == 1
        and flight.multiple[0] == 1.0
        and abs(flight.amplitude[0]) == 1.0
    )


@kernel
def shape_at(phi: float, flight: Record) -> float:
    """f of the excitation."""
    f = 0.0
    if flight.family == WAVELET:
        for i in range(MAX_POLYNOMIAL):
            f = f * phi + flight.polynomial[MAX_POLYNOMIAL - 1 - i]
        return f * math.exp(-phi * phi / flight.spread)
    if flight.family == POLYNOMIALS:
        return polynomial_value(flight, phi)
    for k in range(flight.terms):
        f += flight.amplitude[k] * math.cos(flight.multiple[k] * phi + flight.shift[k])
    return f


@kernel
def polynomial_at(pulse: Record, phase: SimdVector) -> Any:
    """The polynomial of the wavelet, its first and half of its second derivative."""
    p = pulse.polynomial
    value = p[0] + phase * (p[1] + phase * (p[2] + phase * p[3]))
    slope = p[1] + phase * (2.0 * p[2] + phase * (3.0 * p[3]))
    return value, slope, p[2] + phase * (3.0 * p[3])


@kernel
def shapes_and_slopes(pulse: Record, phase: SimdVector) -> Any:
    """f [-] and df/dphi at phases."""
    if pulse.family == WAVELET:
        value, first, _ = polynomial_at(pulse, phase)
        gaussian = exponential(phase * phase * (-1.0 / pulse.spread))
        return value * gaussian, (first + phase * (-2.0 / pulse.spread) * value) * gaussian
    if pulse.family == POLYNOMIALS:
        return polynomial_values_and_slopes(pulse, phase)
    f, slope = splat(0.0), splat(0.0)
    for k in range(pulse.terms):
        sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
        f += pulse.amplitude[k] * cosine
        slope -= pulse.amplitude[k] * pulse.multiple[k] * sine
    return f, slope


@kernel
def expand_excitation(steps: Record) -> None:
    """Fill `f` with the coefficients of F = sgn(theta) a f in powers of tau about `phase`."""
    if steps.family == WAVELET:
        expand_wavelet(steps)
    elif steps.family == POLYNOMIALS:
        expand_polynomials(steps)
    else:
        expand_sinusoids(steps)


@kernel
def expand_sinusoids(steps: Record) -> None:
    """Fill `f` with the coefficients of F in powers of tau about `phase`, for a sum of sinusoids."""
    f, phase, omega, strength = steps.f, load(steps.phase, 0), load(steps.omega, 0), load(steps.strength, 0)
    for k in range(steps.terms):
        sine, cosine = sine_and_cosine(phase * steps.multiple[k] + steps.shift[k])
        rate = omega * steps.multiple[k]
        scale, rate_squared = strength * steps.amplitude[k], rate * rate
        even, odd = scale * cosine, scale * rate * sine * -1.0
        for n in range(0, steps.order + 1, 2):
            store(f, n, even if k == 0 else load(f, n) + even)
            even = even * rate_squared * (-1.0 / ((n + 1.0) * (n + 2.0)))
        for n in range(1, steps.order + 1, 2):
            store(f, n, odd if k == 0 else load(f, n) + odd)
            odd = odd * rate_squared * (-1.0 / ((n + 1.0) * (n + 2.0)))


@kernel
def expand_wavelet(steps: Record) -> None:
    """The same for a wavelet f = (sum polynomial[k] phi^k) exp(-phi^2/spread)."""
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
