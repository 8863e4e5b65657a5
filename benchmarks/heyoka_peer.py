"""The rigid block under a sine by heyoka, which compiles Taylor series of the order that a tolerance asks for.

heyoka is no dependency of the project; where it cannot be imported the benchmark leaves this peer out. Its events are
roots of the step's own polynomial, isolated: none can be missed. Each tolerance is an integrator of its own, compiled
once; the loop over flights and the record of a peak are Python.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import heyoka

from benchmarks.one_sine import Block

FALLEN = heyoka.taylor_outcome(-2)
"""The second of the events that stop the integrator; the first is the impact."""

START = 1e-18
"""Height at which a flight begins: from 0 itself an impact within the first step would not be seen."""


def flight(
    tolerance: float, block: Block, side: float, tau: float, v: float
) -> tuple[float, float, float, float, bool]:
    """One flight, see `one_sine`; rigid blocks only."""
    a, omega, alpha, lean = block
    integrator, tops = _integrator(tolerance)
    tops.clear()
    end = 2.0 * math.pi / omega
    integrator.time = tau
    integrator.state[:] = START, v
    integrator.pars[:] = side * a * lean, omega, alpha
    integrator.reset_cooldowns()
    outcome = integrator.propagate_until(end)[0]
    tau, (z, v) = float(integrator.time), map(float, integrator.state)
    if outcome == heyoka.taylor_outcome.time_limit:
        return end, z, v, max([z, *tops]), False
    return tau, z, v, max([z, *tops]), outcome == FALLEN


@lru_cache
def _integrator(tolerance: float) -> tuple[Any, list[float]]:
    """(2.2) in z and z' with its events, and the list into which they write the peaks of z."""
    z, v = heyoka.make_vars("z", "v")
    push, omega, alpha = (heyoka.par[k] for k in range(3))
    angle = alpha * (1.0 - z)
    pull = heyoka.sin(angle) / alpha + push * heyoka.sin(omega * heyoka.time) * heyoka.cos(angle)
    tops: list[float] = []

    def note(integrator: Any, tau: float, _sign: int) -> None:
        tops.append(float(integrator.update_d_output(tau)[0]))

    falling, rising = heyoka.event_direction.negative, heyoka.event_direction.positive
    integrator = heyoka.taylor_adaptive(
        [(z, v), (v, -pull)],
        [0.0, 0.0],
        pars=[0.0, 1.0, 1.0],
        tol=tolerance,
        t_events=[
            heyoka.t_event(z, direction=falling),
            heyoka.t_event(alpha * z - 0.5 * math.pi, direction=rising),
        ],
        nt_events=[heyoka.nt_event(v, note, direction=falling)],
    )
    return integrator, tops
