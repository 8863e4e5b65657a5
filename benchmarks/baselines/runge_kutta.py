"""The block under a pulse with the classical Runge-Kutta method and fixed steps, compiled.

Impacts and peaks are found by shortening the step in which they occur, so that they are as accurate as the steps. The
search uses false position (Illinois): with few steps, plain bisection would take most of the time.
"""

from __future__ import annotations

from benchmarks.baselines.event_loop import Block, acceleration, beyond_return, compiled, duration, ground


@compiled
def integrate_flight(
    steps: int, block: Block, side: float, tau: float, v: float
) -> tuple[float, float, float, float, bool]:
    """Integrate one flight, see `event_loop`, with `steps` steps over the pulse."""
    end = duration(block)
    z, highest = 0.0, 0.0
    while tau < end:
        h = min(end / steps, end - tau)
        next_z, next_v = step(block, side, tau, z, v, h)
        top = 0.0
        if v > 0.0 >= next_v:
            top = crossing(block, side, tau, z, v, 0.0, h, 1)
            highest = max(highest, step(block, side, tau, z, v, top)[0])
        if next_z < 0.0:
            h = crossing(block, side, tau, z, v, top, h, 0)
            return tau + h, 0.0, step(block, side, tau, z, v, h)[1], highest, False
        tau, z, v = (tau + h if h < end - tau else end), next_z, next_v
        if beyond_return(block, z, v) > 0.0:
            return tau, z, v, highest, True
    return end, z, v, max(highest, z), False


@compiled
def crossing(block: Block, side: float, tau: float, z: float, v: float, low: float, high: float, which: int) -> float:
    """Return the step at which z (`which` = 0) or z' (1), positive after `low` but not after `high`, is zero."""
    above, below = step(block, side, tau, z, v, low)[which], step(block, side, tau, z, v, high)[which]
    retained_end = 0
    while above > 0.0 > below and high - low > 4e-16 * high:
        x = low + (high - low) * above / (above - below)
        value = step(block, side, tau, z, v, x)[which]
        if value > 0.0:
            low, above = x, value
            below *= 0.5 if retained_end == 1 else 1.0
            retained_end = 1
        else:
            high, below = x, value
            above *= 0.5 if retained_end == -1 else 1.0
            retained_end = -1
    return high


@compiled
def step(block: Block, side: float, tau: float, z: float, v: float, h: float) -> tuple[float, float]:
    """Return z and z' after a step h."""
    half = 0.5 * h
    u = ground(block, tau + half)
    k1 = acceleration(block, side, ground(block, tau), z)
    k2 = acceleration(block, side, u, z + half * v)
    k3 = acceleration(block, side, u, z + half * (v + half * k1))
    k4 = acceleration(block, side, ground(block, tau + h), z + h * (v + half * k2))
    return z + h * (v + h * (k1 + k2 + k3) / 6.0), v + h * (k1 + 2.0 * (k2 + k3) + k4) / 6.0
