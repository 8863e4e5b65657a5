"""The block under a sine as a careful script with scipy would do it: `solve_ivp` with terminal impact events.

Written for a fair comparison: the event of z = |theta|/alpha has one direction, the first step lies inside the expected
flight so that no impact is skipped, and the right-hand sides are as lean as Python allows.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from scipy.integrate import solve_ivp

from benchmarks.one_sine import Block, beyond_return, first_step, rock


def peak_rotation(
    slenderness: float,
    frequency_ratio: float,
    restitution: float,
    rtol: float = 1e-9,
    *,
    alpha: float = 0.0,
    method: str = "DOP853",
) -> float:
    """Largest |theta|/alpha under one full sine (3.2), slender for alpha = 0 [rad]; nan if the block overturns."""
    return float(rock.py_func(_flight, (method, rtol), slenderness, frequency_ratio, restitution, alpha))


def _flight(
    setting: tuple[Any, float], block: Block, side: float, tau: float, v: float
) -> tuple[float, float, float, float, bool]:
    """One flight, see `one_sine`."""
    method, rtol = setting
    impact = _event(lambda _t, y: y[0], terminal=True)
    top = _event(lambda _t, y: y[1], terminal=False)
    lost = _event(lambda _t, y: beyond_return(block, y[0], y[1]), terminal=True, direction=1.0)
    end = 2.0 * math.pi / block[1]
    solution: Any = solve_ivp(
        _motion(block, side),
        (tau, end),
        (0.0, v),
        method=method,
        rtol=rtol,
        atol=1e-3 * rtol,
        events=(impact, top, lost),
        first_step=first_step(block, side, tau, 0.0, v),
    )
    z, v = solution.y[:, -1]
    tops = solution.y_events[1]
    highest = max(z, tops[:, 0].max() if len(tops) else 0.0)
    return solution.t[-1], z, v, highest, len(solution.t_events[2]) > 0


def _motion(block: Block, side: float) -> Callable[[float, Any], tuple[float, float]]:
    """Right-hand side in z, z'."""
    a, omega, alpha, lean = block
    sin, cos = math.sin, math.cos
    if alpha == 0.0:
        return lambda t, y: (y[1], y[0] - 1.0 - side * a * sin(omega * t))  # (3.1)
    push = side * a * lean

    def rigid(t: float, y: Any) -> tuple[float, float]:  # (2.2)
        angle = alpha * (1.0 - y[0])
        return y[1], -sin(angle) / alpha - push * sin(omega * t) * cos(angle)

    return rigid


def _event(function: Callable[[float, Any], float], *, terminal: bool, direction: float = -1.0) -> Any:
    function.terminal, function.direction = terminal, direction  # type: ignore[attr-defined]  # SciPy reads them there
    return function
