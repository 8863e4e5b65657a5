"""Wavelets f = (sum of c_k phi^k) g, g = exp(-phi^2/S), in the stages: the particular solution of the slender equation.

The bounded solution of z'' - z = -g is K = (A + B)/2, where with the decay c = sqrt(S)/(2 omega)

    B(phi) = integral of g(x) exp(-(x - phi)/omega) dx/omega from phi to infinity
           = sqrt(pi) c g erfcx(c + phi/sqrt(S)),    A(phi) = B(-phi),    erfcx(x) = exp(x^2) erfc(x)

and dK/dphi = K' = (B - A)/(2 omega), omega^2 K'' = K - g. A wavelet is a sum of derivatives of g, f = h_0 g + h_1 g' +
h_2 g'' + h_3 g''' (`WaveletSeries.derivatives`), so that the particular solution of z'' - z = -f is

    p = (h_0 + h_2/omega^2) K + (h_1 + h_3/omega^2) K' - (h_2 g + h_3 g')/omega^2

For a negative x, g erfcx(x) = 2 exp(c (c - 2 |phi|/sqrt(S))) - g erfcx(-x). For small omega the terms of p cancel:
a rounding error grows with c^2, for odd wavelets with c^3.
"""

import math
from typing import Any

from rocking._numba.compilation import Record, kernel
from rocking._numba.simd import absolute, any_lane, load, select
from rocking._numba.simd_functions import exponential, scaled_erfc
from rocking._solver.stages import columns as column

WAVELET_SERIES_RADIUS, MAX_WAVELET_REACH = 1.8, 0.9
"""Largest growth_rate omega h and h at which the series at the start is exact to rounding: 1.8^21/23! = 1e-17."""

HALF_ROOT_PI = 0.5 * math.sqrt(math.pi)  # sqrt(pi)/2 [-]


@kernel
def particular_solution(pulse: Record, group: Record) -> Any:
    """p and dp/dtau at the phase of the last `set_angles`; `arc` and `decay` must be set."""
    phase, g, omega, c = (
        load(group.phase, 0),
        load(group.gaussian, 0),
        load(group.columns, column.OMEGA),
        load(group.decay, 0),
    )
    inverse = load(group.reciprocal_omega, 0)
    # K is even in phi, its derivative odd: both from A and B at |phi|
    distance = absolute(phase) * (1.0 / math.sqrt(pulse.spread))
    near, far = g * scaled_erfc(c + distance), g * scaled_erfc(absolute(c - distance))
    beyond = c < distance
    if any_lane(beyond):  # a negative argument of erfcx, by the identity of the module
        far = select(beyond, 2.0 * exponential(c * (c - 2.0 * distance)) - far, far)
    scale = c * HALF_ROOT_PI
    even, odd = scale * (near + far), scale * inverse * (near - far)
    odd = select(phase < 0.0, odd * -1.0, odd)  # K and its derivative
    slope = phase * (-2.0 / pulse.spread)
    bend = slope * slope - 2.0 / pulse.spread
    # p and its derivative: g' = slope g, g'' = bend g, omega^2 K'' = K - g
    m0, m1, m2, m3 = load(group.arc, 0), load(group.arc, 1), load(group.arc, 2), load(group.arc, 3)
    z = m0 * even + m1 * odd - g * (m2 + m3 * slope)
    w = m0 * odd + m1 * ((even - g) * inverse * inverse) - g * (m2 * slope + m3 * bend)
    return z, omega * w
