"""The motion of one body as a function of time, sampled at given times by the flights of the solver."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rocking._excitation.pulses import as_pulse
from rocking._history.sampling import sample_free_rocking
from rocking._model.reactions import INERTIA_RATIO, ContactGeometry
from rocking._model.response import Outcome
from rocking._numba.cancellation import StopFlag, check_stop, flag_array
from rocking._numba.compilation import Record
from rocking._solver.records.state import BLOCK_STATE
from rocking._solver.rules import IMPACT_LIMIT
from rocking._solver.state import BODY_FIELDS, pulse_state, step_state

Floats = NDArray[np.float64]

FREE_DURATION = 8.0
"""Default duration of free rocking after the pulse [tau]."""

MAX_FREE_IMPACTS = 10_000
"""Largest number of impacts of free rocking."""

MAX_ROTATION = 4.0
"""|theta|/alpha up to which an overturning block is followed [-]; it lies on the ground at |theta| = pi/2."""


@dataclass(frozen=True, eq=False)
class BodyMotion(ABC):
    """The motion of one body as a function of tau, from the start of the ground motion to a horizon.

    Parameters
    ----------
    cell : record `BODY_CELL`
        The body, and the rate of the ground motion.
    horizon : float
        tau at which to stop [-].
    stop : StopFlag, optional
        Cancels the work: the methods raise `StoppedError` soon after another thread sets the flag.
    inertia_ratio : (float, float)
        R p^2/g of the right and the left edge [-], for the contact forces; 3/4 for a rectangle.
    tilt : float
        Angle by which the base is inclined towards the right [rad].
    """

    cell: Record
    horizon: float
    stop: StopFlag | None
    inertia_ratio: tuple[float, float] = field(default=(INERTIA_RATIO, INERTIA_RATIO), kw_only=True)
    tilt: float = field(default=0.0, kw_only=True)

    @property
    @abstractmethod
    def pulse_end(self) -> float:
        """tau at which the ground motion ends [-]."""

    @property
    @abstractmethod
    def ground_rate(self) -> float:
        """Largest of 1 and the rate of the phase of the ground motion with respect to tau [-]."""

    @property
    @abstractmethod
    def kink_times(self) -> Floats:
        """Times [tau] at which the reactions are continuous and may have a kink."""

    @abstractmethod
    def jump_times(self, record: Record) -> Floats:
        """Times [tau] other than impacts at which the reactions may jump."""

    @abstractmethod
    def ground_acceleration(self, tau: Floats) -> Floats:
        """Acceleration of the ground over g tan(alpha), a f [-] (3.2); alpha of the right edge."""

    def vertical_acceleration(self, tau: Floats) -> Floats:
        """Vertical acceleration of the ground over g, upwards [-]."""
        return np.zeros(tau.size)

    @abstractmethod
    def _sample_forced(
        self, tau: Floats, rotation: Floats, velocity: Floats, impact_times: Floats
    ) -> tuple[Record, int]:
        """Sample the motion until the ground motion ends; the solver state, and the number of impacts written."""

    @property
    def restitution(self) -> float:
        """Of impacts that leave the right edge [-]."""
        return float(self.cell["eta"][0])

    @property
    def alpha(self) -> float:
        """Slenderness angle of the right edge [rad], 0 for the slender limit."""
        return float(self.cell["alpha"])

    @property
    def contact_geometry(self) -> ContactGeometry:
        """What the contact forces need beside alpha."""
        ratio, speed = float(self.cell["ratio"]), math.sqrt(float(self.cell["stiffness"]))
        return ContactGeometry(ratio, speed, self.inertia_ratio, self.tilt)

    @property
    def max_rotation(self) -> float:
        """|theta|/alpha up to which a body that overturns is followed [-]: `MAX_ROTATION`, or |theta| = pi/2."""
        most = MAX_ROTATION * max(1.0, float(self.cell["ratio"]))
        return min(most, 0.5 * math.pi / self.alpha) if self.alpha > 0.0 else most

    def events(self) -> tuple[Record, Floats]:
        """The record of the solver with the response, and the times of the impacts [tau]."""
        nothing = np.empty(0)
        forced, free = np.empty(IMPACT_LIMIT), np.empty(MAX_FREE_IMPACTS)
        record, written = self._sample_forced(nothing, nothing, nothing, forced)
        then = self._sample_free(record, nothing, nothing, nothing, free)
        impact_times = np.concatenate([forced[:written], free[:then]])
        return record, impact_times[impact_times <= self.horizon]

    def sample(self, tau: Floats) -> tuple[Floats, Floats]:
        """theta/alpha and d(theta/alpha)/d tau [-] at ascending times `tau`; zero after overturning."""
        rotation, velocity = np.zeros(tau.size), np.zeros(tau.size)
        record, _ = self._sample_forced(tau, rotation, velocity, np.empty(0))
        self._sample_free(record, tau, rotation, velocity, np.empty(MAX_FREE_IMPACTS))
        return rotation, velocity

    def sample_count(self, tau: Floats, rotation: Floats, record: Record) -> int:
        """Number of samples up to the first beyond `max_rotation` or the last that moves; all unless it overturns."""
        if not overturned(record):
            return tau.size
        beyond = np.flatnonzero(np.abs(rotation) > self.max_rotation)
        if beyond.size:
            return int(beyond[0]) + 1
        shown = (rotation != 0.0) | (tau <= record["uplift_time"])
        return int(np.flatnonzero(shown).max(initial=0)) + 1

    def history(self, grid: Floats) -> tuple[Record, Floats, Floats, Floats, Floats]:
        """The record with the response, times, theta/alpha and its rate there, and the times of impacts.

        The times are those of `grid`, which is ascending, the uplift, the impacts and the end of the ground motion, up
        to the horizon or `sample_count` of them.
        """
        record, impact_times = self.events()
        events = [0.0, self.pulse_end, float(np.nan_to_num(record["uplift_time"]))]
        tau = np.concatenate([grid, impact_times, events])
        tau = np.unique(tau[tau <= self.horizon])
        rotation, velocity = self.sample(tau)
        last = self.sample_count(tau, rotation, record)
        tau = tau[:last]
        return record, tau, rotation[:last], velocity[:last], impact_times[impact_times <= tau[-1]]

    def _sample_free(self, state: Record, tau: Floats, rotation: Floats, velocity: Floats, impact_times: Floats) -> int:
        """Sample free rocking from the state at the end of the ground motion; the number of impacts written."""
        body: Record = np.zeros(1, BLOCK_STATE)[0]
        for name, *_ in BODY_FIELDS:
            body[name] = state[name]
        written = sample_free_rocking(
            *(float(state[name]) for name in ("end_rotation", "end_velocity", "end_sign")),
            body,
            step_state(pulse_state(as_pulse("sine"))),  # without ground motion any pulse serves
            self.pulse_end,
            self.horizon * (1 + 1e-12),  # a step fills the samples before its end, so the last must lie inside
            self.max_rotation,
            tau,
            rotation,
            velocity,
            impact_times,
            flag_array(self.stop),
        )
        check_stop(self.stop)
        return int(written)


def overturned(record: Record) -> bool:
    """Whether the body of this record overturns in the end."""
    return bool(record["outcome"] >= Outcome.OVERTURNED_DIRECTLY)
