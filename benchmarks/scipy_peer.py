"""The slender block under a sine as a careful script with scipy would do it: DOP853, terminal impact events, energy.

Written for a fair comparison: z = |theta|/alpha so that the event has one direction, the first step inside the expected
flight so that no impact is skipped, no integration at rest, at growing exponentials or after the pulse, and chatter cut
at a small velocity.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from scipy.integrate import solve_ivp

SMALLEST_VELOCITY = 1e-8
"""A block that strikes slower than this while |u| < 1 is taken to rest [-]."""


def peak_rotation(slenderness: float, frequency_ratio: float, restitution: float, rtol: float = 1e-9) -> float:
    """Largest |theta|/alpha under one full sine (3.2); nan if the block overturns."""
    a, omega, eta = 1.0 / slenderness, frequency_ratio, restitution
    if a <= 1.0:
        return 0.0
    end = 2.0 * math.pi / omega
    first = math.asin(1.0 / a)
    starts = [first / omega, (math.pi + first) / omega]  # |a sin| reaches 1, rising
    tau, v, side, peak = starts[0], 0.0, -1, 0.0
    while True:
        flight = _flight(a, omega, side, tau, end, v, rtol)
        peak = max(peak, flight["peak"])
        if flight["overturned"]:
            return math.nan
        if flight["tau"] >= end:
            return _free_rocking(flight["z"], flight["v"], eta, peak)
        tau, v, side = flight["tau"], -eta * flight["v"], -side
        if v < SMALLEST_VELOCITY and abs(a * math.sin(omega * tau)) < 1.0:
            starts = [start for start in starts if start > tau]
            if not starts:
                return peak
            tau, v = starts[0], 0.0
            side = -1 if math.sin(omega * tau) > 0.0 else 1


def _flight(a: float, omega: float, side: int, tau: float, end: float, v: float, rtol: float) -> dict[str, Any]:
    """From z = 0, z' = v at tau to the next impact, the pulse's end, or a growth that nothing can stop."""

    def motion(t: float, y: Any) -> tuple[float, float]:
        return y[1], y[0] - 1.0 - side * a * math.sin(omega * t)  # (3.1) for z = side theta/alpha

    impact = _event(lambda _t, y: y[0], terminal=True)
    top = _event(lambda _t, y: y[1], terminal=False)
    lost = _event(lambda _t, y: y[0] + y[1] - 1.0 - a, terminal=True, direction=1.0)
    pull = 1.0 + side * a * math.sin(omega * tau)
    first_step = min(0.05 / max(1.0, omega), 0.5 * v / pull if pull > 0.0 and v > 0.0 else math.inf, end - tau)
    solution = solve_ivp(
        motion,
        (tau, end),
        (0.0, v),
        method="DOP853",
        rtol=rtol,
        atol=1e-3 * rtol,
        events=(impact, top, lost),
        first_step=first_step,
    )
    z, v = solution.y[0, -1], solution.y[1, -1]
    tops = solution.y_events[1]
    peak = max(z, tops[:, 0].max() if len(tops) else 0.0)
    overturned = len(solution.t_events[2]) > 0
    return {"tau": solution.t[-1], "z": z, "v": v, "peak": peak, "overturned": overturned}


def _event(function: Callable[[float, Any], float], *, terminal: bool, direction: float = -1.0) -> Any:
    function.terminal, function.direction = terminal, direction  # type: ignore[attr-defined]  # SciPy reads them there
    return function


def _free_rocking(z: float, v: float, eta: float, peak: float) -> float:
    """After the pulse, by energy: depth^2 = (1 - z)^2 - z'^2 is conserved."""
    if z + v > 1.0:
        return math.nan
    depth2 = (1.0 - z) ** 2 - v * v
    if v > 0.0:
        peak = max(peak, 1.0 - math.sqrt(depth2))
    energy = eta * eta * (1.0 - depth2)
    return math.nan if energy > 1.0 else max(peak, 1.0 - math.sqrt(1.0 - energy))
