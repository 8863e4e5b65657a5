"""A block of given size and shape under a pulse of given strength and length, integrated in metres and seconds.

Equation (3.2) with its dimensions, step by step with SciPy's DOP853: slow, and independent of the solver of `rocking`,
which works in the groups (3.6). So figures 5 and 6 show self-similarity and do not assume it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rocking.block import STANDARD_GRAVITY, Block
from rocking.pulses import get_pulse

Array = NDArray[np.float64]

AT_REST = 1e-9
"""Angular velocity in units of p alpha below which free rocking counts as over [-]."""


@dataclass(frozen=True)
class Shaken:
    """A block and its pulse; `history` integrates."""

    block: Block
    pulse: str
    peak_acceleration: float  # a_g [m/s2]
    pulse_period: float  # T_p [s]
    restitution: float

    @classmethod
    def with_groups(
        cls, pulse: str, block: Block, slenderness: float, frequency_ratio: float, restitution: float
    ) -> Shaken:
        """The pulse that gives this block the groups 1/a = g alpha/a_g and omega = omega_g/p, (4.11)."""
        acceleration = STANDARD_GRAVITY * block.alpha / slenderness
        period = 2 * np.pi / (frequency_ratio * block.frequency_parameter)
        return cls(block, pulse, acceleration, period, restitution)

    def ground_acceleration(self, time: Array | float) -> Array:
        """a_g f(omega_g t) [m/s2]; time [s] since the start of the pulse."""
        shape = get_pulse(self.pulse)
        phi = shape.start + 2 * np.pi / self.pulse_period * np.asarray(time)
        return self.peak_acceleration * shape.acceleration(phi)

    def history(self, time: Array) -> tuple[Array, Array]:
        """Rotation theta [rad] and angular velocity [rad/s] at ascending times [s]."""
        shape = get_pulse(self.pulse)
        pulse_end = (shape.end - shape.start) / (2 * np.pi) * self.pulse_period
        start = self._uplift(pulse_end)
        theta, velocity = np.zeros(time.size), np.zeros(time.size)
        state, sign = np.zeros(2), -float(np.sign(self.ground_acceleration(start)))
        while start < time[-1]:
            # the ground acceleration may jump at the end of the pulse, so that no step may run across it
            stop = pulse_end if start < pulse_end < time[-1] else time[-1]
            arc = solve_ivp(
                self._rate, (start, stop), state, args=(sign,), method="DOP853", rtol=1e-11, atol=1e-14,
                max_step=self.pulse_period / 50, events=_impact(sign, start), dense_output=True,
            )  # fmt: skip
            inside = (time >= start) & (time <= arc.t[-1])
            if inside.any():
                theta[inside], velocity[inside] = arc.sol(time[inside])
            start, state = arc.t[-1], arc.y[:, -1].copy()
            if arc.status == 1:  # an impact: theta = 0, (2.3)
                state[0], sign = 0.0, -sign
                state[1] *= self.restitution
                if start >= pulse_end and abs(state[1]) < AT_REST * self.block.frequency_parameter * self.block.alpha:
                    break  # the impacts of free rocking accumulate, and it rests
            start = np.nextafter(start, np.inf)
        return theta, velocity

    def _uplift(self, pulse_end: float) -> float:
        needed = STANDARD_GRAVITY * self.block.alpha  # small angles: g alpha, (3.3)
        grid = np.linspace(0.0, pulse_end, 2001)
        excess = np.abs(self.ground_acceleration(grid)) - needed
        first = int(np.argmax(excess >= 0))
        if first == 0:
            return 0.0
        found = brentq(
            lambda t: float(np.abs(self.ground_acceleration(t)) - needed), grid[first - 1], grid[first], xtol=1e-15
        )
        return float(found)

    def _rate(self, time: float, state: Array, sign: float) -> list[float]:
        p = self.block.frequency_parameter
        pull = sign * self.block.alpha + float(self.ground_acceleration(time)) / STANDARD_GRAVITY
        return [state[1], p * p * (state[0] - pull)]  # (3.2)


def _impact(sign: float, start: float) -> Callable[[float, Array, float], float]:
    """theta = 0, approached from the side of `sign`; the start of the arc does not count."""

    def event(time: float, state: Array, _: float) -> float:
        return state[0] if time > start else sign

    event.terminal = True  # type: ignore[attr-defined]  # SciPy reads it there
    event.direction = -sign  # type: ignore[attr-defined]
    return event
