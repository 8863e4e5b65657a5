"""Sums of sinusoids in the stages. `cosine` and `sine` of the group are those of the angles w_k phi + d_k."""

from __future__ import annotations

from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import load, maximum, select, splat, square_root, store
from rocking._numba.simd_sines import sine_and_cosine
from rocking.solver.arcs.arc import SERIES_RADIUS
from rocking.solver.excitation import is_unit_sinusoid
from rocking.solver.stages.state import AT_UPLIFT, OMEGA, PHASE, SLENDERNESS, W0
from rocking.solver.state import SERIES_LENGTH


@kernel
def set_sinusoid_angles(pulse: Record, group: Record, phase: SimdVector) -> None:
    """Set the cosines and sines of the angles at phases of each flight."""
    for k in range(pulse.terms):
        sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
        store(group.cosine, k, cosine)
        store(group.sine, k, sine)


@kernel
def set_sinusoid_end_angles(pulse: Record, group: Record, piece: int) -> None:
    """Set the cosines and sines at the left end of a piece of the pulse."""
    for k in range(pulse.terms):
        store(group.cosine, k, splat(pulse.end_cosine[piece, k]))
        store(group.sine, k, splat(pulse.end_sine[piece, k]))


@kernel
def sum_at_angles(pulse: Record, group: Record) -> Any:
    """f [-] at the angles."""
    f = splat(0.0)
    for k in range(pulse.terms):
        f += pulse.amplitude[k] * load(group.cosine, k)
    return f


@kernel
def sum_and_slope(pulse: Record, phase: SimdVector) -> Any:
    """f [-] and df/dphi at phases."""
    f, slope = splat(0.0), splat(0.0)
    for k in range(pulse.terms):
        sine, cosine = sine_and_cosine(phase * pulse.multiple[k] + pulse.shift[k])
        f += pulse.amplitude[k] * cosine
        slope -= pulse.amplitude[k] * pulse.multiple[k] * sine
    return f, slope


@kernel
def start_sinusoid_arcs(pulse: Record, group: Record, sign: float, a: SimdVector) -> None:
    """Set the coefficients of the flights from z = 0, (3.4); see `rocking.solver.stages.arcs.start_arcs`."""
    omega, phase, w0 = load(group.columns, OMEGA), load(group.columns, PHASE), load(group.columns, W0)
    slenderness, at_uplift = load(group.columns, SLENDERNESS), load(group.columns, AT_UPLIFT) > 0.0
    unit = is_unit_sinusoid(pulse)
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
    store(group.max_rate, 0, max_rate)
    store(group.reach, 0, SERIES_RADIUS / max_rate)
    store(group.q0, 0, q0)
    store(group.x0, 0, x0)
    store(group.y0, 0, y0)
    store(group.offset_z, 0, offset_z)
    store(group.offset_w, 0, offset_w)


@kernel
def sinusoid_increments(pulse: Record, group: Record) -> Any:
    """Change of the particular solution of z, and that of w plus w0, from the start of the flight to the angles."""
    z, w = load(group.offset_z, 0), load(group.offset_w, 0)
    for k in range(pulse.terms):
        particular = load(group.particular, k)
        z += particular * load(group.cosine, k)
        w -= particular * (load(group.rate, k) * load(group.sine, k))
    return z, w


@kernel
def sinusoid_restoring_acceleration(pulse: Record, group: Record) -> Any:
    """q = 1 + F [-] at the angles."""
    q = splat(1.0)
    for k in range(pulse.terms):
        q += load(group.force, k) * load(group.cosine, k)
    return q


@kernel
def sinusoid_restoring_derivatives(pulse: Record, group: Record) -> Any:
    """q, dq/dtau and its second derivative at the angles."""
    q, q1, q2 = splat(1.0), splat(0.0), splat(0.0)
    for k in range(pulse.terms):
        force, rate = load(group.force, k), load(group.rate, k)
        scaled = force * load(group.cosine, k)
        q += scaled
        q1 -= force * (rate * load(group.sine, k))
        q2 -= scaled * (rate * rate)
    return q, q1, q2


@kernel
def expand_sinusoids_at_start(pulse: Record, group: Record) -> None:
    """Set row n + 2 of `series` to the coefficient F_n of F about the start of the flight, n >= 1."""
    series = group.series
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
