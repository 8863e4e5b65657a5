"""The block under a pulse by heyoka, which compiles Taylor series of the order that a tolerance asks for.

heyoka is no dependency of the project; where it cannot be imported the benchmark leaves this peer out. Its events are
roots of the step's own polynomial, isolated: none can be missed. Each tolerance is an integrator of its own, compiled
once; the loop over flights and the record of a peak are Python.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import heyoka

from benchmarks.baselines.event_loop import HALF_WINDOW, SINE, Block, acceleration, duration, ground

FALLEN = heyoka.taylor_outcome(-2)
"""The second of the events that stop the integrator; the first is the impact."""

START = 1e-18
"""Height at which a flight begins: from 0 itself an impact within the first step would not be seen."""

LIFT = 1e-6
"""Phase [rad] that a block lifting off is moved by hand: z, z' and z'' vanish together, and roots so close to one of
such multiplicity escape isolation."""


def flight(
    tolerance: float, block: Block, side: float, tau: float, v: float
) -> tuple[float, float, float, float, bool]:
    """One flight, see `one_pulse`."""
    a, omega, alpha, lean, pulse = block
    integrator, tops = _integrator(tolerance, pulse, alpha == 0.0)
    tops.clear()
    end = duration(block)
    z = START
    if v == 0.0:
        h = LIFT / omega
        pull = acceleration(block, side, ground(block, tau + h), 0.0)
        tau, z, v = tau + h, pull * h * h / 6.0, 0.5 * pull * h
    integrator.time = tau
    integrator.state[:] = z, v
    integrator.pars[:] = side * a * lean, omega, 1.0 + a if alpha == 0.0 else alpha
    integrator.reset_cooldowns()
    outcome = integrator.propagate_until(end)[0]
    tau, (z, v) = float(integrator.time), map(float, integrator.state)
    if outcome == heyoka.taylor_outcome.time_limit:
        return end, z, v, max([z, *tops]), False
    return tau, z, v, max([z, *tops]), outcome == FALLEN


@lru_cache
def _integrator(tolerance: float, pulse: float, slender: bool) -> tuple[Any, list[float]]:
    """(3.1) or (2.2) in z and z' with its events, and the list into which they write the peaks of z."""
    z, v = heyoka.make_vars("z", "v")
    push, omega = heyoka.par[0], heyoka.par[1]
    phase = omega * heyoka.time
    if pulse == SINE:
        ground = push * heyoka.sin(phase)
    else:
        square = (phase - HALF_WINDOW) ** 2
        ground = push * (1.0 - 0.5 * square) * heyoka.exp(-0.25 * square)
    if slender:
        rate, beyond_return = z - 1.0 - ground, z + v - heyoka.par[2]
    else:
        alpha = heyoka.par[2]
        angle = alpha * (1.0 - z)
        rate = -heyoka.sin(angle) / alpha - ground * heyoka.cos(angle)
        beyond_return = alpha * z - 0.5 * math.pi
    tops: list[float] = []

    def note(integrator: Any, tau: float, _sign: int) -> None:
        tops.append(float(integrator.update_d_output(tau)[0]))

    falling, rising = heyoka.event_direction.negative, heyoka.event_direction.positive
    integrator = heyoka.taylor_adaptive(
        [(z, v), (v, rate)],
        [0.0, 0.0],
        pars=[0.0, 1.0, 1.0],
        tol=tolerance,
        t_events=[
            heyoka.t_event(z, direction=falling),
            heyoka.t_event(beyond_return, direction=rising),
        ],
        nt_events=[heyoka.nt_event(v, note, direction=falling)],
    )
    return integrator, tops
