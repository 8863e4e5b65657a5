"""Motion of a block of given size and shape under a pulse of given amplitude and period, integrated in SI units.

Equation (3.2), or (2.2) for a block that is not slender, is integrated in dimensional form with SciPy's DOP853. This is
slow and independent of the solver of `rocking`, which uses the groups (3.6): figures 5, 6 and 9 thus show
self-similarity without assuming it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rocking._base.arrays import Array
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._model.block import STANDARD_GRAVITY, RectangularBlock

AT_REST = 1e-9  # angular velocity in units of p alpha below which free rocking is considered to have ended [-]
MAX_DURATION = 60.0  # time p t after the pulse within which a block that overturns reaches the ground [-]


@dataclass(frozen=True)
class DimensionalProblem:
    """A block and its pulse in SI units; `history` and `overturns` integrate the motion."""

    block: RectangularBlock
    pulse: str
    peak_acceleration: float  # a_g [m/s2]
    period: float  # T_p [s]
    restitution: float
    rigid: bool = False  # (2.2), else its small-angle form (3.2)

    @classmethod
    def with_groups(
        cls, pulse: str, block: RectangularBlock, slenderness: float, frequency_ratio: float, restitution: float
    ) -> DimensionalProblem:
        """The pulse that gives this slender block the groups 1/a = g alpha/a_g and omega = omega_g/p, (4.11)."""
        acceleration = STANDARD_GRAVITY * block.alpha / slenderness
        period = 2 * np.pi / (frequency_ratio * block.frequency_parameter)
        return cls(block, pulse, acceleration, period, restitution)

    @cached_property
    def shape(self) -> AbstractPulse:
        """The pulse."""
        return as_pulse(self.pulse)

    @property
    def pulse_end(self) -> float:
        """Duration of the pulse [s]."""
        return (self.shape.end - self.shape.start) / (2 * np.pi) * self.period

    def ground_acceleration(self, time: Array | float) -> Array:
        """a_g f(omega_g t) [m/s2]; time [s] since the start of the pulse."""
        phi = self.shape.start + 2 * np.pi / self.period * np.asarray(time)
        return self.peak_acceleration * self.shape.acceleration(phi)

    def history(self, time: Array) -> tuple[Array, Array]:
        """Rotation theta [rad] and angular velocity [rad/s] at ascending times [s]."""
        theta, velocity = np.zeros(time.size), np.zeros(time.size)
        for arc in self._arcs(time[-1], dense_output=True):
            inside = (time >= arc.t[0]) & (time <= arc.t[-1])
            if inside.any():
                theta[inside], velocity[inside] = arc.sol(time[inside])
        return theta, velocity

    def overturns(self) -> bool:
        """Whether a rigid block reaches |theta| = pi/2; it survives if it rocks freely from one impact to the next."""
        free = 0
        for arc in self._arcs(self.pulse_end + MAX_DURATION / self.block.frequency_parameter):
            if abs(arc.y[0, -1]) > 0.5 * np.pi - 1e-6:
                return True
            free += arc.t[0] >= self.pulse_end
            if free > 1 and arc.status == 1:
                return False
        return False

    def _arcs(self, until: float, **options: Any) -> Iterator[Any]:
        """The motion from uplift on, in pieces that end with an impact, with the pulse, or with overturning."""
        start, at_rest = self._uplift(), AT_REST * self.block.frequency_parameter * self.block.alpha
        state, sign = np.zeros(2), -float(np.sign(self.ground_acceleration(start)))
        while start < until:
            # the ground acceleration may jump at the end of the pulse: no step may cross it
            stop = self.pulse_end if start < self.pulse_end < until else until
            events = [_impact(sign, start), *([_overturned] if self.rigid else [])]
            arc = solve_ivp(
                self._rate, (start, stop), state, args=(sign,), method="DOP853", rtol=1e-11, atol=1e-14,
                max_step=self.period / 50 if start < self.pulse_end else np.inf, events=events, **options,
            )  # fmt: skip
            yield arc
            start, state = arc.t[-1], arc.y[:, -1].copy()
            if arc.t_events[0].size:  # an impact: theta = 0, (2.3)
                state[0], sign = 0.0, -sign
                state[1] *= self.restitution
                if start >= self.pulse_end and abs(state[1]) < at_rest:
                    return  # the impacts of free rocking accumulate: the block comes to rest
            elif arc.status == 1:
                return  # overturned
            start = np.nextafter(start, np.inf)

    def _uplift(self) -> float:
        # g tan(alpha), (2.1); small angles: g alpha, (3.3)
        needed = self.block.uplift_acceleration if self.rigid else STANDARD_GRAVITY * self.block.alpha
        grid = np.linspace(0.0, self.pulse_end, 2001)
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
        lean = sign * self.block.alpha - state[0]
        ground = float(self.ground_acceleration(np.array([time]))[0]) / STANDARD_GRAVITY  # an array needs no checks
        if self.rigid:
            return [state[1], -p * p * (np.sin(lean) + ground * np.cos(lean))]  # (2.2)
        return [state[1], -p * p * (lean + ground)]  # (3.2)


def _impact(sign: float, start: float) -> Callable[[float, Array, float], float]:
    """theta = 0, approached from the side of `sign`; the start of the arc is excluded."""

    def event(time: float, state: Array, _: float) -> float:
        return state[0] if time > start else sign

    event.terminal = True  # type: ignore[attr-defined]  # SciPy reads it there
    event.direction = -sign  # type: ignore[attr-defined]
    return event


def _overturned(_time: float, state: Array, _sign: float) -> float:
    """|theta| = pi/2: the block has overturned."""
    return float(np.abs(state[0])) - 0.5 * np.pi


_overturned.terminal = True  # type: ignore[attr-defined]  # SciPy reads it there
