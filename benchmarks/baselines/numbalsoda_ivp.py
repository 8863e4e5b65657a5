"""The block under a pulse with numbalsoda 0.3, compiled: DOP853 with events, LSODA without.

numbalsoda is not a dependency of the project. It is built from source with a C++ and a Fortran compiler; the benchmark
omits these baselines where it cannot be imported.

Its DOP853 locates an event to 1e-8 only, so that two Newton steps on the local parabola complete the search. Its LSODA
has no events: it returns the states of a window of the pulse at equal times, and the events are zeros of the quintic
polynomial through z, z' and z'' at two neighbouring times, which is more accurate than the integration.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numbalsoda import lsoda, lsoda_sig, solve_ivp

from benchmarks.baselines.event_loop import (
    Block,
    Vector,
    acceleration,
    beyond_return,
    compiled,
    duration,
    first_step,
    ground,
)

WINDOW, TIMES = math.pi, 48
"""For LSODA: window in phase [rad] and number of times in it, the fastest of those tried with accurate events."""

MAX_STEP = math.pi / 8.0
"""For DOP853: maximum step in phase [rad]. A longer step may contain two events of one kind and miss both."""

RISING = 1e-6
"""Larger than the velocity at a peak that is located to 1e-8 in time [-]."""


@numba.cfunc(lsoda_sig)
def motion(tau, y, rate, parameters):  # type: ignore[no-untyped-def]  # typed by numba
    """Right-hand side of (2.2) or (3.1) in z, z'."""
    p = numba.carray(parameters, 6)
    block = (p[0], p[1], p[2], p[3], p[4])
    rate[0], rate[1] = y[1], acceleration(block, p[5], ground(block, tau), y[0])


@numba.cfunc(lsoda_sig)
def events(_tau, y, value, parameters):  # type: ignore[no-untyped-def]  # typed by numba
    """Event functions of peak, impact and no return.

    The first in this order is reported, so that a step cannot hide a peak behind its impact.
    """
    p = numba.carray(parameters, 6)
    value[0] = y[1] if y[0] >= 0.0 else -1.0  # a turning point after the impact is not a peak
    value[1], value[2] = y[0], beyond_return((p[0], p[1], p[2], p[3], p[4]), y[0], y[1])


MOTION, EVENTS = motion.address, events.address


@compiled
def dop853_flight(
    rtol: float, block: Block, side: float, tau: float, v: float
) -> tuple[float, float, float, float, bool]:
    """Integrate one flight, see `event_loop`."""
    parameters = np.array((*block, side))
    end = duration(block)
    z, highest, longest = 0.0, 0.0, MAX_STEP / block[1]
    while True:
        ended = solve_ivp(
            MOTION,
            np.array((tau, end)),
            np.array((z, v)),
            t_eval=np.array((end,)),
            n_events=3,
            event_fcn=EVENTS,
            data=parameters.ctypes.data,
            first_step=first_step(block, side, tau, z, v),
            max_step=longest,
            rtol=rtol,
            atol=1e-3 * rtol,
        )
        if not ended.event_found:
            z, v = ended.y[0]
            return end, z, v, max(highest, z), False
        if ended.ind_event == 2:
            return ended.t_event, ended.y_event[0], ended.y_event[1], highest, True
        if ended.y_event[1] > RISING:  # rises through z = 0: the impact was missed; repeat with shorter steps
            longest *= 0.25
            continue
        tau, z, v = ended.t_event, ended.y_event[0], ended.y_event[1]
        acceleration_there = acceleration(block, side, ground(block, tau), z)
        if ended.ind_event == 1:
            h = -z / v
            h -= (z + h * (v + 0.5 * h * acceleration_there)) / (v + h * acceleration_there)
            return tau + h, 0.0, v + h * acceleration_there, highest, False
        h = -v / acceleration_there
        tau, z, v = tau + h, z + 0.5 * h * v, 0.0
        highest = max(highest, z)
        if tau >= end:
            return end, z, v, highest, False


@compiled
def lsoda_flight(
    rtol: float, block: Block, side: float, tau: float, v: float
) -> tuple[float, float, float, float, bool]:
    """Integrate one flight, see `event_loop`."""
    parameters = np.array((*block, side))
    end = duration(block)
    state, highest = np.array((0.0, v)), 0.0
    while tau < end:
        last = min(tau + WINDOW / block[1], end)
        if end - last < 1e-6 * end:
            last = end
        times = np.linspace(tau, last, TIMES)
        states, _ = lsoda(MOTION, state, times, parameters, rtol, 1e-3 * rtol)
        h = times[1] - times[0]
        for k in range(TIMES - 1):
            if beyond_return(block, states[k, 0], states[k, 1]) > 0.0:
                return times[k], states[k, 0], states[k, 1], highest, True
            turns, impacts = states[k, 1] > 0.0 >= states[k + 1, 1], states[k + 1, 0] < 0.0
            if not turns and not impacts:
                continue
            here = acceleration(block, side, ground(block, times[k]), states[k, 0])
            there = acceleration(block, side, ground(block, times[k + 1]), states[k + 1, 0])
            z = quintic(states[k], states[k + 1], here, there, h)
            rate = np.array((z[1], 2.0 * z[2], 3.0 * z[3], 4.0 * z[4], 5.0 * z[5]))
            top = 0.0
            if turns:
                top = crossing(rate, 0.0)
                highest = max(highest, value(z, top))
            if impacts:
                x = crossing(z, top)
                return times[k] + x * h, 0.0, value(rate, x) / h, highest, False
        tau, state = last, states[TIMES - 1].copy()
    return end, state[0], state[1], max(highest, state[0]), False


@compiled
def quintic(before: Vector, after: Vector, here: float, there: float, h: float) -> Vector:
    """Return coefficients (6,) in x = time/h of the quintic through z, z' (2,) and z'' at both ends of a step h."""
    z0, z1, z2 = before[0], h * before[1], 0.5 * h * h * here
    dz, dv, da = after[0] - z0 - z1 - z2, h * after[1] - z1 - 2.0 * z2, 0.5 * h * h * there - z2
    return np.array((z0, z1, z2, 10.0 * dz - 4.0 * dv + da, -15.0 * dz + 7.0 * dv - 2.0 * da, 6.0 * dz - 3.0 * dv + da))


@compiled
def value(polynomial: Vector, x: float) -> float:
    """Evaluate a polynomial given with the lowest coefficient first."""
    total = 0.0
    for c in polynomial[::-1]:
        total = total * x + c
    return total


@compiled
def crossing(polynomial: Vector, low: float) -> float:
    """Return where the polynomial, positive after `low` and not positive at 1, is zero, by bisection."""
    high = 1.0
    while high - low > 1e-15:
        middle = 0.5 * (low + high)
        if value(polynomial, middle) > 0.0:
            low = middle
        else:
            high = middle
    return high
