"""One block under a full sine (3.2) or a Ricker wavelet, from rest to its fate, with any integrator: a careful script.

Shared by all peers, and nothing of it comes from the package that they judge. A peer brings a function

    fly(setting, block, side, tau, v) -> (tau, z, v, highest, overturned)

that follows one flight from z = 0 at velocity v to its impact, to the end of the pulse, or to a growth that nothing can
stop. Here z = |theta|/alpha, `side` is the sign of theta, and `setting` is whatever the peer wants, such as its
tolerance. Nothing is integrated at rest nor after the pulse, where energy decides, and chatter is cut at a small
velocity. `rock` is compiled together with a compiled `fly`; `rock.py_func` is the same for plain Python.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

SMALLEST_VELOCITY = 1e-5
"""A block that strikes slower than this while |u| < 1 is taken to rest [-]: from 1e-8 to here no error changes, and the
impacts left out are more than a third of the time of some peers; 1e-3 would be seen."""

Block = tuple[float, float, float, float, float]
"""a = a_g/(g tan(alpha)) [-], omega [-], alpha [rad], tan(alpha)/alpha [-], pulse; alpha = 0 is the slender limit."""

SINE, RICKER = 0.0, 1.0
"""The pulses, as numbers among numbers."""

HALF_WINDOW = 4.0 * math.pi
"""The Ricker wavelet lasts from minus to plus this phase [rad]."""

Vector = NDArray[np.float64]


def compiled(function: Callable[..., Any]) -> Any:
    """Machine code as fast as the package's own."""
    return numba.njit(error_model="numpy", fastmath={"contract"})(function)


@compiled
def ground(block: Block, tau: float) -> float:
    """Acceleration of the ground over g tan(alpha)."""
    a, omega = block[0], block[1]
    if block[4] == SINE:
        return a * math.sin(omega * tau)
    square = (omega * tau - HALF_WINDOW) ** 2
    return a * (1.0 - 0.5 * square) * math.exp(-0.25 * square)


@compiled
def duration(block: Block) -> float:
    """Of the pulse [-]."""
    return (2.0 * math.pi if block[4] == SINE else 2.0 * HALF_WINDOW) / block[1]


@compiled
def uplift(block: Block, after: float) -> tuple[float, float]:
    """When the ground next reaches |u| = 1 from below, and the side to which the block then lifts; inf if never."""
    a, omega = block[0], block[1]
    if block[4] == SINE:
        first = math.asin(1.0 / a)
        if first / omega > after:
            return first / omega, -1.0
        return ((math.pi + first) / omega, 1.0) if (math.pi + first) / omega > after else (math.inf, 0.0)
    trough = math.sqrt(6.0)  # of the wavelet; it peaks at phase 0
    for low, high, side in ((-HALF_WINDOW, -trough, 1.0), (-trough, 0.0, -1.0), (math.sqrt(2.0), trough, 1.0)):
        if -side * ground(block, (high + HALF_WINDOW) / omega) > 1.0:
            tau = crossing_of_one(block, side, (low + HALF_WINDOW) / omega, (high + HALF_WINDOW) / omega)
            if tau > after:
                return tau, side
    return math.inf, 0.0


@compiled
def crossing_of_one(block: Block, side: float, low: float, high: float) -> float:
    """Time in a bracket, in which -side u rises through 1, by bisection."""
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
    """z'' from the acceleration u of the ground, slender (3.1) or rigid (2.2)."""
    alpha, lean = block[2], block[3]
    if alpha == 0.0:
        return z - 1.0 - side * u
    angle = alpha * (1.0 - z)
    return -math.sin(angle) / alpha - side * u * lean * math.cos(angle)


@compiled
def beyond_return(block: Block, z: float, v: float) -> float:
    """Positive where the ground cannot bring the block back: slender by its growing part, rigid at |theta| = pi/2."""
    return z + v - 1.0 - block[0] if block[2] == 0.0 else z - 0.5 * math.pi / block[2]


@compiled
def first_step(block: Block, side: float, tau: float, z: float, v: float) -> float:
    """A step well inside the fall or flight from z, v, so that no integrator walks past a short one."""
    step = min(0.05 / max(1.0, block[1]), duration(block) - tau)
    pull = -acceleration(block, side, ground(block, tau), z)
    if pull <= 0.0 or (z == 0.0 and v == 0.0):
        return step
    return min(step, 0.25 * (v + math.sqrt(v * v + 2.0 * pull * z)) / pull)


@compiled
def below_barrier(alpha: float, z: float) -> float:
    """X(z): free rocking conserves X^2 - z'^2, and X = 0 on the barrier."""
    return 1.0 - z if alpha == 0.0 else 2.0 / alpha * math.sin(0.5 * alpha * (1.0 - z))


@compiled
def turning_point(alpha: float, x: float) -> float:
    """The z of X(z) = x."""
    return 1.0 - x if alpha == 0.0 else 1.0 - 2.0 / alpha * math.asin(0.5 * alpha * x)


@compiled
def free_rocking(alpha: float, eta: float, z: float, v: float, peak: float) -> float:
    """Largest z after the pulse has left the block at z, v with `peak` behind it; nan if it overturns."""
    x, barrier = below_barrier(alpha, z), below_barrier(alpha, 0.0)
    if v >= x:
        return math.nan
    if v > 0.0:
        peak = max(peak, turning_point(alpha, math.sqrt(x * x - v * v)))
    squared = eta * eta * (v * v + barrier * barrier - x * x)  # of the velocity after the next impact
    if squared >= barrier * barrier:
        return math.nan
    return max(peak, turning_point(alpha, math.sqrt(barrier * barrier - squared)))


@compiled
def rock(fly: Any, setting: Any, slenderness: float, omega: float, eta: float, alpha: float, pulse: float) -> float:
    """Largest |theta|/alpha over the whole response, 0 without uplift, nan if the block overturns."""
    block = (1.0 / slenderness, omega, alpha, 1.0 if alpha == 0.0 else math.tan(alpha) / alpha, pulse)
    if block[0] <= 1.0:
        return 0.0
    end, v, peak = duration(block), 0.0, 0.0
    tau, side = uplift(block, 0.0)
    while True:
        tau, z, v, highest, overturned = fly(setting, block, side, tau, v)
        peak = max(peak, highest)
        if overturned:
            return math.nan
        if tau >= end:
            return free_rocking(alpha, eta, z, v, peak)
        v, side = -eta * v, -side
        if v < SMALLEST_VELOCITY and abs(ground(block, tau)) < 1.0:
            tau, side = uplift(block, tau)
            v = 0.0
            if side == 0.0:
                return peak


@compiled
def rock_many(
    fly: Any, setting: Any, slenderness: Vector, omega: Vector, eta: float, alpha: float, pulse: float, peaks: Vector
) -> None:
    """`rock` for each entry of slenderness and omega (cells,); fills peaks (cells,)."""
    for i in range(len(peaks)):
        peaks[i] = rock(fly, setting, slenderness[i], omega[i], eta, alpha, pulse)
