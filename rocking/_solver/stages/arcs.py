"""Exact arcs (3.4) of `LANES` flights, each from z = 0 with velocity w0, without overflow and cancellation.

A flight is described by z = sgn(theta) theta/alpha >= 0 and w = dz/dtau. By (3.1), z'' = z - q with q = 1 + F and
F = sgn(theta) a f. From its start the solution is written as an increment with cosh h - 1 and sinh h: the coefficients
A, B of (3.4) would lose all digits on short flights. Of a particular solution p of z'' - z = -F the motion is

    z = p(h) - p(0) + x0 (cosh h - 1) + y0 sinh h,    x0 = -1 - p(0),    y0 = w0 - dp/dtau(0)

`rocking._solver.stages.excitation` gives F, p and their derivatives at the phase of the last `set_angles`.
"""

from typing import Any

from rocking._numba.compilation import Record, SimdVector, kernel
from rocking._numba.simd import any_lane, load, select, splat, store, store_where
from rocking._numba.simd_functions import cosh_minus_one_and_sinh
from rocking._solver.stages import columns as column
from rocking._solver.stages.excitation import (
    expand_at_start,
    particular_increments,
    restoring_derivatives,
    start_particular_solution,
)


@kernel
def start_arcs(pulse: Record, group: Record, sign: float) -> None:
    """Set the coefficients of the flights, all with sgn(theta) = `sign`, from the columns of the group."""
    a = 1.0 / load(group.columns, column.SLENDERNESS)
    store(group.a, 0, a)
    group.expanded = 0
    store(group.reciprocal_omega, 0, 1.0 / load(group.columns, column.OMEGA))
    start_particular_solution(pulse, group, sign, a)
    at_uplift = load(group.columns, column.AT_UPLIFT) > 0.0
    # q = 0 at an uplift: what rounding leaves there would be an acceleration of its own
    store_where(group.q0, 0, at_uplift, 0.0)


@kernel
def states_at(pulse: Record, group: Record, h: SimdVector) -> Any:
    """States (z, w) a time h >= 0 after the start of each flight, with the angles there.

    Near the start, where the arc would lose digits by cancellation, the Taylor series about it is used.
    """
    z, w = particular_increments(pulse, group)
    cosh1, sinh = cosh_minus_one_and_sinh(h)
    x0, y0 = load(group.x0, 0), load(group.y0, 0)
    z += x0 * cosh1 + y0 * sinh
    w += x0 * sinh + y0 * cosh1
    near = h <= load(group.reach, 0)
    if any_lane(near):
        if not group.expanded:  # once for a flight, and only if a time near its start is asked for
            expand_start(pulse, group)
        near_z, near_w = series_states(pulse, group, h)
        z, w = select(near, near_z, z), select(near, near_w, w)
    return z, w


@kernel
def motions_at(pulse: Record, group: Record, h: SimdVector) -> Any:
    """z, w and the second to fourth derivatives of z a time h >= 0 after the start, with the angles there."""
    z, w = states_at(pulse, group, h)
    q, q1, q2 = restoring_derivatives(pulse, group)
    second, third = z - q, w - q1
    fourth = second - q2
    near = h <= load(group.reach, 0)
    if any_lane(near):
        near_second, near_third, near_fourth = series_derivatives(pulse, group, h)
        second = select(near, near_second, second)
        third, fourth = select(near, near_third, third), select(near, near_fourth, fourth)
    return z, w, second, third, fourth


@kernel
def expand_start(pulse: Record, group: Record) -> None:
    """Fill `series` with the Taylor coefficients of z about the start: (n + 1)(n + 2) z_{n+2} = z_n - F_n."""
    series, q0 = group.series, load(group.q0, 0)
    store(series, 0, splat(0.0))
    store(series, 1, load(group.columns, column.W0))
    store(series, 2, q0 * -0.5)
    expand_at_start(pulse, group)  # row n + 2 becomes F_n
    for n in range(1, pulse.series_length - 2):
        store(series, n + 2, (load(series, n) - load(series, n + 2)) * (1.0 / ((n + 1.0) * (n + 2.0))))
    group.expanded = 1


@kernel
def series_states(pulse: Record, group: Record, h: SimdVector) -> Any:
    """z and w a time h after the start, by the series."""
    series, last = group.series, pulse.series_length - 1
    z, w = splat(0.0), splat(0.0)
    for i in range(last):
        n = last - i
        coefficient = load(series, n)
        z = z * h + coefficient
        w = w * h + coefficient * float(n)
    return z * h, w


@kernel
def series_derivatives(pulse: Record, group: Record, h: SimdVector) -> Any:
    """Second to fourth derivatives of z a time h after the start, by the series of `expand_start`."""
    series, last = group.series, pulse.series_length - 1
    second, third, fourth = splat(0.0), splat(0.0), splat(0.0)
    for i in range(last - 3):
        n = last - i
        coefficient = load(series, n) * (n * (n - 1.0))
        second = second * h + coefficient
        third = third * h + coefficient * (n - 2.0)
        fourth = fourth * h + coefficient * ((n - 2.0) * (n - 3.0))
    cubic = load(series, 3) * 6.0
    third = third * h + cubic
    second = (second * h + cubic) * h + load(series, 2) * 2.0
    return second, third, fourth
