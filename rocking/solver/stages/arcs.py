"""Exact arcs (3.4) of `LANES` flights, each from z = 0 with velocity w0: the vector form of `rocking.solver.arcs`.

With F = sgn(theta) a f, z'' = z - q and q = 1 + F. Vectors `cosine`, `sine` of the group are those of the angles
w_k phi + d_k at the phase of the last `set_angles`.
"""

from __future__ import annotations

from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import any_lane, load, maximum, select, splat, square_root, store
from rocking._numba.simd_exponentials import cosh_minus_one_and_sinh
from rocking._numba.simd_sines import sine_and_cosine
from rocking.solver.arcs.arc import SERIES_RADIUS
from rocking.solver.excitation import is_unit_sinusoid
from rocking.solver.stages.state import AT_UPLIFT, OMEGA, PHASE, SLENDERNESS, W0
from rocking.solver.state import SERIES_LENGTH


@kernel
def set_angles(pulse: Record, group: Record, phase: SimdVector) -> None:
    """Set the cosines and sines of the angles at phases of each flight."""
    for k in range(pulse.terms):
        sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
        store(group.cosine, k, cosine)
        store(group.sine, k, sine)


@kernel
def set_end_angles(pulse: Record, group: Record, piece: int) -> None:
    """Set the cosines and sines at the left end of a piece of the pulse."""
    for k in range(pulse.terms):
        store(group.cosine, k, splat(pulse.end_cosine[piece, k]))
        store(group.sine, k, splat(pulse.end_sine[piece, k]))


@kernel
def excitation_at_angles(pulse: Record, group: Record) -> Any:
    """f [-] at the angles."""
    f = splat(0.0)
    for k in range(pulse.terms):
        f += pulse.amplitude[k] * load(group.cosine, k)
    return f


@kernel
def start_arcs(pulse: Record, group: Record, sign: float) -> None:
    """Set the coefficients of the flights, all with sgn(theta) = `sign`, from the columns of `flight`."""
    omega, phase, w0 = load(group.columns, OMEGA), load(group.columns, PHASE), load(group.columns, W0)
    slenderness, at_uplift = load(group.columns, SLENDERNESS), load(group.columns, AT_UPLIFT) > 0.0
    a, unit = 1.0 / slenderness, is_unit_sinusoid(pulse)
    max_rate, q0 = splat(1.0), splat(1.0)
    x0, y0 = splat(-1.0), w0
    offset_z, offset_w = splat(0.0), w0
    for k in range(pulse.terms):
        sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
        if unit:  # at uplift |f| = 1/a, and |f| increases; the phase would lose the digits of the sine close to 1/a = 1
            root = square_root(maximum((1.0 - slenderness) * (1.0 + slenderness), splat(0.0)))
            cosine = select(at_uplift, slenderness * (-sign * pulse.amplitude[0]), cosine)
            sine = select(at_uplift, root * (sign * pulse.amplitude[0]), sine)
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
    store(group.a, 0, a)
    store(group.reciprocal_omega, 0, 1.0 / omega)
    store(group.max_rate, 0, max_rate)
    store(group.q0, 0, select(at_uplift, splat(0.0), q0))
    store(group.x0, 0, x0)
    store(group.y0, 0, y0)
    store(group.offset_z, 0, offset_z)
    store(group.offset_w, 0, offset_w)


@kernel
def restoring_acceleration(pulse: Record, group: Record) -> Any:
    """Restoring acceleration q = 1 + F [-] at the angles."""
    q = splat(1.0)
    for k in range(pulse.terms):
        q += load(group.force, k) * load(group.cosine, k)
    return q


@kernel
def states_at(pulse: Record, group: Record, h: SimdVector) -> Any:
    """States (z, w) a time h >= 0 after the start of each flight, with the angles there.

    Near the start, where the arc would lose digits by cancellation, the Taylor series about it is used.
    """
    z, w = load(group.offset_z, 0), load(group.offset_w, 0)
    for k in range(pulse.terms):
        particular = load(group.particular, k)
        z += particular * load(group.cosine, k)
        w -= particular * (load(group.rate, k) * load(group.sine, k))
    cosh1, sinh = cosh_minus_one_and_sinh(h)
    x0, y0 = load(group.x0, 0), load(group.y0, 0)
    z += x0 * cosh1 + y0 * sinh
    w += x0 * sinh + y0 * cosh1
    near = load(group.max_rate, 0) * h <= SERIES_RADIUS
    if any_lane(near):
        expand_start(pulse, group)
        near_z, near_w = series_states(group, h)
        z, w = select(near, near_z, z), select(near, near_w, w)
    return z, w


@kernel
def motions_at(pulse: Record, group: Record, h: SimdVector) -> Any:
    """z, w and the second to fourth derivatives of z a time h >= 0 after the start, with the angles there."""
    z, w = states_at(pulse, group, h)
    q, q1, q2 = splat(1.0), splat(0.0), splat(0.0)
    for k in range(pulse.terms):
        force, rate = load(group.force, k), load(group.rate, k)
        scaled = force * load(group.cosine, k)
        q += scaled
        q1 -= force * (rate * load(group.sine, k))
        q2 -= scaled * (rate * rate)
    second, third = z - q, w - q1
    fourth = second - q2
    near = load(group.max_rate, 0) * h <= SERIES_RADIUS
    if any_lane(near):
        near_second, near_third, near_fourth = series_derivatives(group, h)
        second = select(near, near_second, second)
        third, fourth = select(near, near_third, third), select(near, near_fourth, fourth)
    return z, w, second, third, fourth


@kernel
def expand_start(pulse: Record, group: Record) -> None:
    """Fill `series` with the Taylor coefficients of z about the start: (n + 1)(n + 2) z_{n+2} = z_n - F_n."""
    series, q0 = group.series, load(group.q0, 0)
    store(series, 0, splat(0.0))
    store(series, 1, load(group.columns, W0))
    store(series, 2, q0 * -0.5)
    for n in range(3, SERIES_LENGTH):
        store(series, n, splat(0.0))
    for k in range(pulse.terms):  # the coefficient n + 2 becomes F_n
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
    for n in range(1, SERIES_LENGTH - 2):
        store(series, n + 2, (load(series, n) - load(series, n + 2)) * (1.0 / ((n + 1.0) * (n + 2.0))))


@kernel
def series_states(group: Record, h: SimdVector) -> Any:
    """z and w a time h after the start, by the series."""
    series = group.series
    z = load(series, SERIES_LENGTH - 1)
    w = z * (SERIES_LENGTH - 1.0)
    for i in range(1, SERIES_LENGTH - 1):
        n = SERIES_LENGTH - 1 - i
        coefficient = load(series, n)
        z = z * h + coefficient
        w = w * h + coefficient * float(n)
    return z * h, w


@kernel
def series_derivatives(group: Record, h: SimdVector) -> Any:
    """Second to fourth derivatives of z a time h after the start, by the series of `expand_start`."""
    series = group.series
    second, third, fourth = splat(0.0), splat(0.0), splat(0.0)
    for i in range(SERIES_LENGTH - 4):
        n = SERIES_LENGTH - 1 - i
        coefficient = load(series, n) * (n * (n - 1.0))
        second = second * h + coefficient
        third = third * h + coefficient * (n - 2.0)
        fourth = fourth * h + coefficient * ((n - 2.0) * (n - 3.0))
    cubic = load(series, 3) * 6.0
    third = third * h + cubic
    second = (second * h + cubic) * h + load(series, 2) * 2.0
    return second, third, fourth
