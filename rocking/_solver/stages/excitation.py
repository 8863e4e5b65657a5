"""The excitation inside the stages: the one place that distinguishes the families with exact arcs, for `LANES` cells.

`set_angles` sets what the other functions use at a phase: cosines and sines of the angles w_k phi + d_k of a sum of
sinusoids, or the phase and the Gaussian of a wavelet (`rocking._solver.stages.wavelets`). Each function has a case for
either family, because every further kernel takes a tenth of a second to compile.
"""

import math
from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import load, maximum, minimum, select, splat, square_root, store
from rocking._numba.simd_functions import exponential, sine_and_cosine
from rocking._solver.families.sinusoids import SERIES_LENGTH, SERIES_RADIUS, is_unit_sinusoid
from rocking._solver.families.wavelets import WAVELET, WAVELET_SERIES_LENGTH, expand_gaussian_product, polynomial_at
from rocking._solver.stages import columns as column
from rocking._solver.stages.wavelets import MAX_WAVELET_REACH, WAVELET_SERIES_RADIUS, particular_solution


@kernel
def set_angles(pulse: Record, group: Record, phase: SimdVector) -> None:
    """Set the angles at phases of each flight."""
    if pulse.family == WAVELET:
        store(group.phase, 0, phase)
        store(group.gaussian, 0, exponential(phase * phase * (-1.0 / pulse.spread)))
        return
    for k in range(pulse.terms):
        sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
        store(group.cosine, k, cosine)
        store(group.sine, k, sine)


@kernel
def set_end_angles(pulse: Record, group: Record, piece: int) -> None:
    """Set the angles at the left end of a piece of the pulse."""
    if pulse.family == WAVELET:
        set_angles(pulse, group, splat(pulse.end_phase[piece]))
        return
    for k in range(pulse.terms):
        store(group.cosine, k, splat(pulse.end_cosine[piece, k]))
        store(group.sine, k, splat(pulse.end_sine[piece, k]))


@kernel
def excitation_at_angles(pulse: Record, group: Record) -> Any:
    """f [-] at the angles."""
    if pulse.family == WAVELET:
        return polynomial_at(pulse, load(group.phase, 0))[0] * load(group.gaussian, 0)
    f = splat(0.0)
    for k in range(pulse.terms):
        f += pulse.amplitude[k] * load(group.cosine, k)
    return f


@kernel
def start_particular_solution(pulse: Record, group: Record, sign: float, a: SimdVector) -> None:
    """Set the coefficients of the flights from z = 0, see `rocking._solver.stages.arcs`."""
    omega, phase, w0 = (
        load(group.columns, column.OMEGA),
        load(group.columns, column.PHASE),
        load(group.columns, column.W0),
    )
    if pulse.family == WAVELET:
        strength, inverse = a * sign, 1.0 / omega
        squared, h = inverse * inverse, pulse.derivatives
        store(group.strength, 0, strength)
        store(group.decay, 0, inverse * (0.5 * math.sqrt(pulse.spread)))
        # the coefficients of p by K, K', g and g', see `rocking._solver.stages.wavelets`
        store(group.arc, 0, strength * (h[0] + h[2] * squared))
        store(group.arc, 1, strength * (h[1] + h[3] * squared))
        store(group.arc, 2, strength * (h[2] * squared))
        store(group.arc, 3, strength * (h[3] * squared))
        max_rate = maximum(splat(1.0), omega * pulse.growth_rate)
        reach = minimum(WAVELET_SERIES_RADIUS / (omega * pulse.growth_rate), splat(MAX_WAVELET_REACH))
        set_angles(pulse, group, phase)
        store(group.gaussian0, 0, load(group.gaussian, 0))
        z, w = particular_solution(pulse, group)
        q0 = restoring_acceleration(pulse, group)
        x0, y0, offset_z, offset_w = -1.0 - z, w0 - w, z * -1.0, w0 - w
    else:
        slenderness, at_uplift = load(group.columns, column.SLENDERNESS), load(group.columns, column.AT_UPLIFT) > 0.0
        unit = is_unit_sinusoid(pulse)
        max_rate, q0 = splat(1.0), splat(1.0)
        x0, y0 = splat(-1.0), w0
        offset_z, offset_w = splat(0.0), w0
        for k in range(pulse.terms):
            sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
            if unit:  # at uplift |f| = 1/a, and |f| increases; near a = 1 the phase would lose digits of the sine
                root = square_root(maximum((1.0 - slenderness) * (1.0 + slenderness), splat(0.0)))
                cosine = select(at_uplift, slenderness * (-sign * pulse.amplitude[0]), cosine)
                sine = select(at_uplift, root * (sign * pulse.amplitude[0]), sine)
            # force cos(rate tau + ...) is a term of F; the particular solution of z'' - z = -F divides it by rate^2 + 1
            rate, force = omega * pulse.multiple[k], a * (sign * pulse.amplitude[k])
            particular = force / (rate * rate + 1.0)
            store(group.rate, k, rate)
            store(group.force, k, force)
            store(group.particular, k, particular)
            store(group.cosine0, k, cosine)
            store(group.sine0, k, sine)
            max_rate = maximum(max_rate, rate)
            q0 += force * cosine
            offset_z -= particular * cosine
            x0 -= particular * cosine
            y0 += particular * (rate * sine)
            offset_w += particular * (rate * sine)
        reach = SERIES_RADIUS / max_rate
    store(group.max_rate, 0, max_rate)
    store(group.reach, 0, reach)
    store(group.q0, 0, q0)
    store(group.x0, 0, x0)
    store(group.y0, 0, y0)
    store(group.offset_z, 0, offset_z)
    store(group.offset_w, 0, offset_w)


@kernel
def particular_increments(pulse: Record, group: Record) -> Any:
    """Changes of the particular solution from the start of the flight to the angles: of z, and of w with w0 added."""
    z, w = load(group.offset_z, 0), load(group.offset_w, 0)
    if pulse.family == WAVELET:
        at_phase, rate = particular_solution(pulse, group)
        return z + at_phase, w + rate
    for k in range(pulse.terms):
        particular = load(group.particular, k)
        z += particular * load(group.cosine, k)
        w -= particular * (load(group.rate, k) * load(group.sine, k))
    return z, w


@kernel
def restoring_acceleration(pulse: Record, group: Record) -> Any:
    """Restoring acceleration q = 1 + F [-] at the angles."""
    if pulse.family == WAVELET:
        return 1.0 + load(group.strength, 0) * excitation_at_angles(pulse, group)
    q = splat(1.0)
    for k in range(pulse.terms):
        q += load(group.force, k) * load(group.cosine, k)
    return q


@kernel
def restoring_derivatives(pulse: Record, group: Record) -> Any:
    """q, dq/dtau and its second derivative at the angles."""
    if pulse.family == WAVELET:
        phase, omega = load(group.phase, 0), load(group.columns, column.OMEGA)
        value, first, half_second = polynomial_at(pulse, phase)
        slope = phase * (-2.0 / pulse.spread)  # of log g, and g''/g
        bend = slope * slope - 2.0 / pulse.spread
        scaled = load(group.strength, 0) * load(group.gaussian, 0)
        rate = scaled * omega * (first + slope * value)
        return (
            1.0 + scaled * value,
            rate,
            scaled * (omega * omega) * (2.0 * (half_second + slope * first) + bend * value),
        )
    q, q1, q2 = splat(1.0), splat(0.0), splat(0.0)
    for k in range(pulse.terms):
        force, rate = load(group.force, k), load(group.rate, k)
        scaled = force * load(group.cosine, k)
        q += scaled
        q1 -= force * (rate * load(group.sine, k))
        q2 -= scaled * (rate * rate)
    return q, q1, q2


@kernel
def expand_at_start(pulse: Record, group: Record) -> None:
    """Set row n + 2 of `series` to the coefficient F_n of F about the start of the flight, n >= 1."""
    series = group.series
    if pulse.family == WAVELET:
        phase, omega = load(group.columns, column.PHASE), load(group.columns, column.OMEGA)
        gaussian, strength, f = load(group.gaussian0, 0), load(group.strength, 0), group.excitation
        expand_gaussian_product(pulse, f, group.gauss, phase, gaussian, omega, strength, WAVELET_SERIES_LENGTH - 3)
        for n in range(1, WAVELET_SERIES_LENGTH - 2):
            store(series, n + 2, load(f, n))
        return
    for n in range(3, SERIES_LENGTH):
        store(series, n, splat(0.0))
    for k in range(pulse.terms):
        rate = load(group.rate, k)
        square = rate * rate * -1.0
        force = load(group.force, k)
        odd, even = force * rate * load(group.sine0, k) * -1.0, force * load(group.cosine0, k)
        for n in range(1, SERIES_LENGTH - 2, 2):
            store(series, n + 2, load(series, n + 2) + odd)
            odd = odd * square * (1.0 / ((n + 1.0) * (n + 2.0)))
            if n + 3 < SERIES_LENGTH:
                even = even * square * (1.0 / (n * (n + 1.0)))
                store(series, n + 3, load(series, n + 3) + even)
