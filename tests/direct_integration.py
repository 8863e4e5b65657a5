"""The linearised equation of motion (3.2) with (2.3), integrated by scipy; uses no formula of the package."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp


@dataclass
class Motion:
    """State at the end of the pulse, and the impacts before it; times since uplift."""

    rotation: float
    velocity: float
    impact_times: list[float] = field(default_factory=list)
    impact_velocities: list[float] = field(default_factory=list)
    peak: float = 0.0

    @property
    def overturns_freely(self) -> bool:
        """Whether free rocking without a further impact overturns: the growing exponential points away from rest."""
        side = np.sign(self.rotation)
        return bool(side * (self.rotation + self.velocity) > 1)


def integrate(
    amplitude: float,
    frequency_ratio: float,
    restitution: float,
    shape=np.sin,
    start: float | None = None,
    end: float = 2 * np.pi,
    most_impacts: int = 3,
) -> Motion:
    """Integrate from uplift at phase `start` to phase `end`, through at most `most_impacts` impacts."""
    phase = np.arcsin(1 / amplitude) if start is None else start
    side = -np.sign(shape(phase))
    tau, stop = 0.0, (end - phase) / frequency_ratio
    state = np.zeros(2)
    motion = Motion(0.0, 0.0)

    def impact_event(_, y):
        return y[0] if armed else 1.0

    impact_event.terminal = True
    while tau < stop:

        def motion_law(t, y, side=side):
            return [y[1], y[0] - side - amplitude * shape(frequency_ratio * t + phase)]  # (3.2), scaled by (3.6)

        # a first short step leaves theta = 0, where the event function is zero
        after_start = min(tau + 1e-3 * (stop - tau), stop)
        armed = False
        first = solve_ivp(motion_law, (tau, after_start), state, method="DOP853", rtol=1e-13, atol=1e-16)
        armed = True
        run = solve_ivp(
            motion_law, (after_start, stop), first.y[:, -1], method="DOP853", rtol=1e-13, atol=1e-16,
            events=impact_event, max_step=(stop - after_start) / 40,
        )  # fmt: skip
        motion.peak = max(motion.peak, float(np.abs(run.y[0]).max()))
        tau, state = run.t[-1], run.y[:, -1]
        if run.status != 1:
            break
        motion.impact_times.append(tau)
        motion.impact_velocities.append(state[1])
        if len(motion.impact_times) > most_impacts:
            raise RuntimeError("more impacts than most_impacts")
        state = np.array([0.0, restitution * state[1]])  # (2.3)
        side = np.sign(state[1])
    motion.rotation, motion.velocity = state
    return motion


def peak_of_free_rocking(velocity: float) -> float:
    """Return the largest rotation after an impact with velocity `velocity` (< 1), no ground motion, by integration."""

    def turning_event(_, y):
        return y[1]

    turning_event.terminal = True
    run = solve_ivp(
        lambda _, y: [y[1], y[0] - 1],
        (0, 50),
        [0.0, velocity],
        method="DOP853",
        rtol=1e-13,
        atol=1e-16,
        events=turning_event,
    )
    return float(run.y[0, -1])
