"""Response of one block under a full sine (3.2) or a Ricker wavelet with any integrator of one flight.

All baselines share this event loop; it uses nothing of the package. A baseline supplies a function

    integrate_flight(setting, block, side, tau, v) -> (tau, z, v, highest, overturned)

that integrates one flight from z = 0 at velocity v to its impact, to the end of the pulse, or to a state from which
the block cannot return. Here z = |theta|/alpha, `side` is the sign of theta, and `setting` is specific to the
baseline, for example a tolerance. Nothing is integrated at rest or after the pulse, where the energy decides, and
chatter ends at a small velocity. `respond` is compiled together with a compiled `integrate_flight`;
`respond.py_func` is the same function in Python.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

CHATTER_VELOCITY = 1e-5
"""Velocity after an impact below which the block is taken to be at rest while |u| < 1 [-].

No error changes between 1e-8 and this value, and the omitted impacts take more than a third of the time of some
baselines; with 1e-3 the errors change.
"""

Block = tuple[float, float, float, float, float]
"""a = a_g/(g tan(alpha)) [-], omega [-], alpha [rad], tan(alpha)/alpha [-], pulse; alpha = 0 is the slender limit."""

SINE, RICKER = 0.0, 1.0
"""Codes of the pulses."""

HALF_WINDOW = 4.0 * math.pi
"""The Ricker wavelet extends from minus to plus this phase [rad]."""

Vector = NDArray[np.float64]


def compiled(function: Callable[..., Any]) -> Any:
    """Compile a function with the same options as the kernels of the package."""
    return numba.njit(error_model="numpy", fastmath={"contract"})(function)


@compiled
def ground(block: Block, tau: float) -> float:
    """Return the ground acceleration over g tan(alpha) [-]."""
    a, omega = block[0], block[1]
    if block[4] == SINE:
        return a * math.sin(omega * tau)
    square = (omega * tau - HALF_WINDOW) ** 2
    return a * (1.0 - 0.5 * square) * math.exp(-0.25 * square)


@compiled
def duration(block: Block) -> float:
    """Return the duration of the pulse in tau [-]."""
    return (2.0 * math.pi if block[4] == SINE else 2.0 * HALF_WINDOW) / block[1]


@compiled
def next_uplift(block: Block, after: float) -> tuple[float, float]:
    """Return when |u| next rises through 1 and the side to which the block then uplifts; (inf, 0) if never."""
    a, omega = block[0], block[1]
    if block[4] == SINE:
        first = math.asin(1.0 / a)
        if first / omega > after:
            return first / omega, -1.0
        return ((math.pi + first) / omega, 1.0) if (math.pi + first) / omega > after else (math.inf, 0.0)
    trough = math.sqrt(6.0)  # phase of the minima of the wavelet; its maximum is at phase 0
    for low, high, side in ((-HALF_WINDOW, -trough, 1.0), (-trough, 0.0, -1.0), (math.sqrt(2.0), trough, 1.0)):
        if -side * ground(block, (high + HALF_WINDOW) / omega) > 1.0:
            tau = crossing_of_one(block, side, (low + HALF_WINDOW) / omega, (high + HALF_WINDOW) / omega)
            if tau > after:
                return tau, side
    return math.inf, 0.0


@compiled
def crossing_of_one(block: Block, side: float, low: float, high: float) -> float:
    """Return the time in a bracket at which -side u rises through 1, by bisection."""
    while high - low > 2e-16 * high:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if -side * ground(block, middle) < 1.0:
            low = middle
        else:
            high = middle
    return high


@compiled
def acceleration(block: Block, side: float, u: float, z: float) -> float:
    """Return z'' for the ground acceleration u, slender (3.1) or rigid (2.2)."""
    alpha, tan_ratio = block[2], block[3]
    if alpha == 0.0:
        return z - 1.0 - side * u
    angle = alpha * (1.0 - z)
    return -math.sin(angle) / alpha - side * u * tan_ratio * math.cos(angle)


@compiled
def beyond_return(block: Block, z: float, v: float) -> float:
    """Return a value that is positive where the block cannot return.

    Slender: its growing exponential outweighs the ground. Rigid: |theta| = pi/2.
    """
    return z + v - 1.0 - block[0] if block[2] == 0.0 else z - 0.5 * math.pi / block[2]


@compiled
def first_step(block: Block, side: float, tau: float, z: float, v: float) -> float:
    """Return a step well inside the coming flight, so that no integrator steps over a short one."""
    step = min(0.05 / max(1.0, block[1]), duration(block) - tau)
    restoring = -acceleration(block, side, ground(block, tau), z)
    if restoring <= 0.0 or (z == 0.0 and v == 0.0):
        return step
    return min(step, 0.25 * (v + math.sqrt(v * v + 2.0 * restoring * z)) / restoring)


@compiled
def below_barrier(alpha: float, z: float) -> float:
    """Return X(z): free rocking conserves X^2 - z'^2, and X = 0 at the potential barrier."""
    return 1.0 - z if alpha == 0.0 else 2.0 / alpha * math.sin(0.5 * alpha * (1.0 - z))


@compiled
def turning_point(alpha: float, x: float) -> float:
    """Return the z with X(z) = x."""
    return 1.0 - x if alpha == 0.0 else 1.0 - 2.0 / alpha * math.asin(0.5 * alpha * x)


@compiled
def free_rocking(alpha: float, eta: float, z: float, v: float, peak: float) -> float:
    """Return the largest z after a pulse that ends at state z, v, or `peak` if larger; nan if the block overturns."""
    x, barrier = below_barrier(alpha, z), below_barrier(alpha, 0.0)
    if v >= x:
        return math.nan
    if v > 0.0:
        peak = max(peak, turning_point(alpha, math.sqrt(x * x - v * v)))
    squared = eta * eta * (v * v + barrier * barrier - x * x)  # velocity after the next impact
    if squared >= barrier * barrier:
        return math.nan
    return max(peak, turning_point(alpha, math.sqrt(barrier * barrier - squared)))


@compiled
def respond(
    integrate_flight: Any, setting: Any, slenderness: float, omega: float, eta: float, alpha: float, pulse: float
) -> float:
    """Return the largest |theta|/alpha of the whole response: 0 without uplift, nan if the block overturns."""
    block = (1.0 / slenderness, omega, alpha, 1.0 if alpha == 0.0 else math.tan(alpha) / alpha, pulse)
    if block[0] <= 1.0:
        return 0.0
    end, v, peak = duration(block), 0.0, 0.0
    tau, side = next_uplift(block, 0.0)
    while True:
        tau, z, v, highest, overturned = integrate_flight(setting, block, side, tau, v)
        peak = max(peak, highest)
        if overturned:
            return math.nan
        if tau >= end:
            return free_rocking(alpha, eta, z, v, peak)
        v, side = -eta * v, -side
        if v < CHATTER_VELOCITY and abs(ground(block, tau)) < 1.0:
            tau, side = next_uplift(block, tau)
            v = 0.0
            if side == 0.0:
                return peak


@compiled
def respond_many(
    integrate_flight: Any,
    setting: Any,
    slenderness: Vector,
    omega: Vector,
    eta: float,
    alpha: float,
    pulse: float,
    peaks: Vector,
) -> None:
    """Call `respond` for each entry of slenderness and omega (cells,); fills peaks (cells,)."""
    for i in range(len(peaks)):
        peaks[i] = respond(integrate_flight, setting, slenderness[i], omega[i], eta, alpha, pulse)
