"""Wavelets f = (sum of c_k phi^k) g, g = exp(-phi^2/S), in the stages: exact arcs of the slender block.

The bounded solution of z'' - z = -g is K = (A + B)/2, where with the decay c = sqrt(S)/(2 omega)

    B(phi) = integral of g(x) exp(-(x - phi)/omega) dx/omega from phi to infinity
           = sqrt(pi) c g erfcx(c + phi/sqrt(S)),    A(phi) = B(-phi),    erfcx(x) = exp(x^2) erfc(x)

and dK/dphi = K' = (B - A)/(2 omega), omega^2 K'' = K - g. A wavelet is a sum of derivatives of g, f = h_0 g + h_1 g' +
h_2 g'' + h_3 g''' (`ExcitationSeries.derivatives`), so that the particular solution of z'' - z = -f is

    p = (h_0 + h_2/omega^2) K + (h_1 + h_3/omega^2) K' - (h_2 g + h_3 g')/omega^2

For a negative x, g erfcx(x) = 2 exp(c (c - 2 |phi|/sqrt(S))) - g erfcx(-x). For small omega the terms of p cancel:
a rounding error grows with c^2, for odd wavelets with c^3.
"""

from __future__ import annotations

import math
from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import absolute, any_lane, load, maximum, minimum, select, splat, store
from rocking._numba.simd_error_function import scaled_erfc
from rocking._numba.simd_exponentials import exponential
from rocking.solver.excitation import expand_gaussian_product
from rocking.solver.stages.state import OMEGA, PHASE, W0
from rocking.solver.state import WAVELET_SERIES_LENGTH

SERIES_RADIUS, MAX_REACH = 1.8, 0.9
"""Largest growth_rate omega h and h at which the series at the start is exact to rounding: 1.8^21/23! = 1e-17."""

HALF_ROOT_PI = 0.5 * math.sqrt(math.pi)
"""sqrt(pi)/2 [-]."""


@kernel
def gaussian_at(pulse: Record, phase: SimdVector) -> Any:
    """exp(-phi^2/spread)."""
    return exponential(phase * phase * (-1.0 / pulse.spread))


@kernel
def polynomial_at(pulse: Record, phase: SimdVector) -> Any:
    """The polynomial of the wavelet, its first and half of its second derivative."""
    p = pulse.polynomial
    value = p[0] + phase * (p[1] + phase * (p[2] + phase * p[3]))
    slope = p[1] + phase * (2.0 * p[2] + phase * (3.0 * p[3]))
    return value, slope, p[2] + phase * (3.0 * p[3])


@kernel
def set_wavelet_phase(pulse: Record, group: Record, phase: SimdVector) -> None:
    """Set the phase and the Gaussian there."""
    store(group.phase, 0, phase)
    store(group.gaussian, 0, gaussian_at(pulse, phase))


@kernel
def wavelet_at_phase(pulse: Record, group: Record) -> Any:
    """f [-] at the phase."""
    return polynomial_at(pulse, load(group.phase, 0))[0] * load(group.gaussian, 0)


@kernel
def wavelet_and_slope(pulse: Record, phase: SimdVector) -> Any:
    """f [-] and df/dphi at phases."""
    value, slope, _ = polynomial_at(pulse, phase)
    gaussian = gaussian_at(pulse, phase)
    return value * gaussian, (slope + phase * (-2.0 / pulse.spread) * value) * gaussian


@kernel
def start_wavelet_arcs(pulse: Record, group: Record, sign: float, a: SimdVector) -> None:
    """Set the coefficients of the flights from z = 0; see `rocking.solver.stages.arcs.start_arcs`."""
    omega, phase, w0 = load(group.columns, OMEGA), load(group.columns, PHASE), load(group.columns, W0)
    strength, inverse = a * sign, 1.0 / omega
    squared, h = inverse * inverse, pulse.derivatives
    store(group.strength, 0, strength)
    store(group.decay, 0, inverse * (0.5 * math.sqrt(pulse.spread)))
    store(group.arc, 0, strength * (h[0] + h[2] * squared))
    store(group.arc, 1, strength * (h[1] + h[3] * squared))
    store(group.arc, 2, strength * (h[2] * squared))
    store(group.arc, 3, strength * (h[3] * squared))
    rate = omega * pulse.growth_rate
    store(group.max_rate, 0, maximum(splat(1.0), rate))
    store(group.reach, 0, minimum(SERIES_RADIUS / rate, splat(MAX_REACH)))
    set_wavelet_phase(pulse, group, phase)
    store(group.gaussian0, 0, load(group.gaussian, 0))
    store(group.q0, 0, wavelet_restoring_acceleration(pulse, group))
    store(group.offset_z, 0, splat(0.0))
    store(group.offset_w, 0, splat(0.0))
    z, w = wavelet_increments(pulse, group)
    store(group.x0, 0, -1.0 - z)
    store(group.y0, 0, w0 - w)
    store(group.offset_z, 0, z * -1.0)
    store(group.offset_w, 0, w0 - w)


@kernel
def wavelet_increments(pulse: Record, group: Record) -> Any:
    """Change of the particular solution of z, and that of w plus w0, from the start of the flight to the phase."""
    phase, g, omega, c = load(group.phase, 0), load(group.gaussian, 0), load(group.columns, OMEGA), load(group.decay, 0)
    inverse = load(group.reciprocal_omega, 0)
    distance = absolute(phase) * (1.0 / math.sqrt(pulse.spread))
    near, far = g * scaled_erfc(c + distance), g * scaled_erfc(absolute(c - distance))
    beyond = c < distance
    if any_lane(beyond):
        far = select(beyond, 2.0 * exponential(c * (c - 2.0 * distance)) - far, far)
    scale = c * HALF_ROOT_PI
    even, odd = scale * (near + far), scale * inverse * (near - far)
    odd = select(phase < 0.0, odd * -1.0, odd)  # K and its derivative
    slope = phase * (-2.0 / pulse.spread)
    bend = slope * slope - 2.0 / pulse.spread
    m0, m1, m2, m3 = load(group.arc, 0), load(group.arc, 1), load(group.arc, 2), load(group.arc, 3)
    z = m0 * even + m1 * odd - g * (m2 + m3 * slope)
    w = m0 * odd + m1 * ((even - g) * inverse * inverse) - g * (m2 * slope + m3 * bend)
    return load(group.offset_z, 0) + z, load(group.offset_w, 0) + omega * w


@kernel
def wavelet_restoring_acceleration(pulse: Record, group: Record) -> Any:
    """q = 1 + F [-] at the phase."""
    return 1.0 + load(group.strength, 0) * wavelet_at_phase(pulse, group)


@kernel
def wavelet_restoring_derivatives(pulse: Record, group: Record) -> Any:
    """q, dq/dtau and its second derivative at the phase."""
    phase, omega = load(group.phase, 0), load(group.columns, OMEGA)
    value, first, half_second = polynomial_at(pulse, phase)
    slope = phase * (-2.0 / pulse.spread)
    bend = slope * slope - 2.0 / pulse.spread
    scaled = load(group.strength, 0) * load(group.gaussian, 0)
    q1 = scaled * omega * (first + slope * value)
    q2 = scaled * (omega * omega) * (2.0 * (half_second + slope * first) + bend * value)
    return 1.0 + scaled * value, q1, q2


@kernel
def expand_wavelet_at_start(pulse: Record, group: Record) -> None:
    """Set row n + 2 of `series` to the coefficient F_n of F about the start of the flight, n >= 1."""
    columns, excitation = group.columns, group.excitation
    expand_gaussian_product(
        pulse,
        excitation,
        group.gauss,
        load(columns, PHASE),
        load(group.gaussian0, 0),
        load(columns, OMEGA),
        load(group.strength, 0),
        WAVELET_SERIES_LENGTH - 3,
    )
    for n in range(1, WAVELET_SERIES_LENGTH - 2):
        store(group.series, n + 2, load(excitation, n))
