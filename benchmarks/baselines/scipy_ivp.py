"""The block under a pulse with scipy's `solve_ivp` and terminal impact events.

The event of z = |theta|/alpha has one direction, the first step lies inside the expected flight so that no impact is
missed, and the right-hand sides avoid needless work.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from scipy.integrate import solve_ivp

from benchmarks.baselines.event_loop import HALF_WINDOW, SINE, Block, beyond_return, duration, first_step


def integrate_flight(
    setting: tuple[Any, float], block: Block, side: float, tau: float, v: float
) -> tuple[float, float, float, float, bool]:
    """Integrate one flight, see `event_loop`."""
    method, rtol = setting
    impact = event(lambda _t, y: y[0], terminal=True)
    top = event(lambda _t, y: y[1], terminal=False)
    no_return = event(lambda _t, y: beyond_return(block, y[0], y[1]), terminal=True, direction=1.0)
    end = duration(block)
    solution: Any = solve_ivp(
        _motion(block, side),
        (tau, end),
        (0.0, v),
        method=method,
        rtol=rtol,
        atol=1e-3 * rtol,
        events=(impact, top, no_return),
        first_step=first_step(block, side, tau, 0.0, v),
    )
    z, v = solution.y[:, -1]
    peaks = solution.y_events[1]
    highest = max(z, peaks[:, 0].max() if len(peaks) else 0.0)
    return solution.t[-1], z, v, highest, len(solution.t_events[2]) > 0


def _motion(block: Block, side: float) -> Callable[[float, Any], tuple[float, float]]:
    """Return the right-hand side in z, z'."""
    a, omega, alpha, tan_ratio, _ = block
    ground = _sine if block[4] == SINE else _ricker
    sin, cos = math.sin, math.cos
    if alpha == 0.0:
        return lambda t, y: (y[1], y[0] - 1.0 - side * a * ground(omega * t))  # (3.1)
    forcing = side * a * tan_ratio

    def rigid(t: float, y: Any) -> tuple[float, float]:  # (2.2)
        angle = alpha * (1.0 - y[0])
        return y[1], -sin(angle) / alpha - forcing * ground(omega * t) * cos(angle)

    return rigid


_sine = math.sin


def _ricker(phase: float) -> float:
    square = (phase - HALF_WINDOW) ** 2
    return (1.0 - 0.5 * square) * math.exp(-0.25 * square)


def event(function: Callable[[float, Any], float], *, terminal: bool, direction: float = -1.0) -> Any:
    """Return a function as `solve_ivp` takes an event."""
    function.terminal, function.direction = terminal, direction  # type: ignore[attr-defined]  # read by scipy
    return function
