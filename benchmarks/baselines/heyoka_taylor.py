"""The block under a pulse with heyoka, which compiles Taylor series of the order that a tolerance requires.

heyoka is not a dependency of the project; the benchmark omits this baseline where it cannot be imported. Its events
are isolated roots of the polynomial of a step, so that none can be missed. Each tolerance has its own integrator,
compiled once; the loop over flights and the record of peaks run in Python.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import heyoka

from benchmarks.baselines.event_loop import HALF_WINDOW, SINE, Block, acceleration, duration, ground

OVERTURNED = heyoka.taylor_outcome(-2)
"""The second of the terminal events; the first is the impact."""

START = 1e-18
"""Height at the start of a flight: from 0 itself an impact within the first step would not be found."""

LIFT = 1e-6
"""Phase [rad] bridged by a series at uplift.

There z, z' and z'' vanish together, and roots close to one of such multiplicity are not isolated.
"""


def integrate_flight(
    tolerance: float, block: Block, side: float, tau: float, v: float
) -> tuple[float, float, float, float, bool]:
    """Integrate one flight, see `event_loop`."""
    a, omega, alpha, tan_ratio, pulse = block
    integrator, peaks = _integrator(tolerance, pulse, alpha == 0.0)
    peaks.clear()
    end = duration(block)
    z = START
    if v == 0.0:
        h = LIFT / omega
        outward = acceleration(block, side, ground(block, tau + h), 0.0)
        tau, z, v = tau + h, outward * h * h / 6.0, 0.5 * outward * h
    integrator.time = tau
    integrator.state[:] = z, v
    integrator.pars[:] = side * a * tan_ratio, omega, 1.0 + a if alpha == 0.0 else alpha
    integrator.reset_cooldowns()
    outcome = integrator.propagate_until(end)[0]
    tau, (z, v) = float(integrator.time), map(float, integrator.state)
    if outcome == heyoka.taylor_outcome.time_limit:
        return end, z, v, max([z, *peaks]), False
    return tau, z, v, max([z, *peaks]), outcome == OVERTURNED


@lru_cache
def _integrator(tolerance: float, pulse: float, slender: bool) -> tuple[Any, list[float]]:
    """Return the integrator of (3.1) or (2.2) in z and z', and the list to which its events append peaks of z."""
    z, v = heyoka.make_vars("z", "v")
    forcing, omega = heyoka.par[0], heyoka.par[1]
    phase = omega * heyoka.time
    if pulse == SINE:
        ground = forcing * heyoka.sin(phase)
    else:
        square = (phase - HALF_WINDOW) ** 2
        ground = forcing * (1.0 - 0.5 * square) * heyoka.exp(-0.25 * square)
    if slender:
        rate, beyond_return = z - 1.0 - ground, z + v - heyoka.par[2]
    else:
        alpha = heyoka.par[2]
        angle = alpha * (1.0 - z)
        rate = -heyoka.sin(angle) / alpha - ground * heyoka.cos(angle)
        beyond_return = alpha * z - 0.5 * math.pi
    peaks: list[float] = []

    def append_peak(integrator: Any, tau: float, _sign: int) -> None:
        peaks.append(float(integrator.update_d_output(tau)[0]))

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
        nt_events=[heyoka.nt_event(v, append_peak, direction=falling)],
    )
    return integrator, peaks
