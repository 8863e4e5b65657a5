"""The motion of one block as a function of time, sampled at given times by the flights of the solver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rocking._numba.cancellation import StopFlag, check_stop, flag_array
from rocking._numba.compilation import Record
from rocking.errors import positive
from rocking.excitation.pulses import AbstractPulse, as_pulse
from rocking.history.sampling import sample_arcs, sample_free_rocking, solve_and_sample
from rocking.model.checks import check_number, check_one_alpha
from rocking.model.fields import END_ROTATION, END_VELOCITY, EXCEEDED_ALPHA, RESPONSE_FIELDS
from rocking.model.parameters import FREQUENCY_RATIO, RESTITUTION, SLENDERNESS
from rocking.model.response import Outcome
from rocking.solver.kernels.event_loop import IMPACT_LIMIT
from rocking.solver.peak_response import peak_response
from rocking.solver.state import pulse_state, step_state
from rocking.units import Scalar

Floats = NDArray[np.float64]

FREE_DURATION = 8.0
"""Default duration of free rocking after the pulse [tau]."""

MAX_FREE_IMPACTS = 10_000
"""Largest number of impacts of free rocking."""

MAX_ROTATION = 4.0
"""|theta|/alpha up to which an overturning block is followed [-]; it lies on the ground at |theta| = pi/2."""


class SampledMotion(Protocol):
    """The motion of one block as a function of tau, under a pulse or a recorded motion."""

    @property
    def restitution(self) -> float: ...

    @property
    def alpha(self) -> float: ...

    @property
    def horizon(self) -> float: ...

    @property
    def pulse_end(self) -> float:
        """tau at which the ground motion ends [-]."""

    @property
    def max_rotation(self) -> float:
        """|theta|/alpha up to which a block that overturns is followed [-]."""

    @property
    def ground_rate(self) -> float:
        """Largest of 1 and the rate of the phase of the ground motion with respect to tau [-]."""

    def events(self) -> tuple[Record, Floats]:
        """The record of the solver with the response, and the times of the impacts [tau]."""

    @property
    def kink_times(self) -> Floats:
        """Times [tau] at which the reactions are continuous and may have a kink."""

    def jump_times(self, record: Record) -> Floats:
        """Times [tau] other than impacts at which the reactions may jump."""

    def sample(self, tau: Floats) -> tuple[Floats, Floats]:
        """theta/alpha and d(theta/alpha)/d tau [-] at ascending times `tau`; zero after overturning."""

    def sample_count(self, tau: Floats, rotation: Floats, record: Record) -> int:
        """Number of samples up to the first beyond `max_rotation`; all unless the block overturns."""

    def ground_acceleration(self, tau: Floats) -> Floats:
        """Acceleration of the ground over g tan(alpha) [-]."""


@dataclass(frozen=True)
class Motion:
    """One block under one pulse, from the start of the pulse to a horizon.

    Parameters
    ----------
    pulse : AbstractPulse
    slenderness, frequency_ratio, restitution, alpha : float
        1/a, omega, eta [-]; alpha [rad], 0 for the slender limit; checked by `build_motion`.
    horizon : float
        tau at which to stop [-].
    stop : StopFlag, optional
        Cancels the work: the methods raise `StoppedError` soon after another thread sets the flag.
    """

    pulse: AbstractPulse
    slenderness: float
    frequency_ratio: float
    restitution: float
    alpha: float
    horizon: float
    stop: StopFlag | None = None

    @property
    def pulse_end(self) -> float:
        """tau at which the pulse ends [-]."""
        return (self.pulse.end - self.pulse.start) / self.frequency_ratio

    @property
    def max_rotation(self) -> float:
        """|theta|/alpha up to which a block that overturns is followed [-]."""
        return largest_rotation(self.alpha)

    @property
    def ground_rate(self) -> float:
        """Largest of 1 and the rate of the phase with respect to tau [-]."""
        return max(1.0, self.frequency_ratio)

    @property
    def kink_times(self) -> Floats:
        """None: a pulse is smooth between its ends."""
        return np.empty(0)

    def jump_times(self, record: Record) -> Floats:
        """Times [tau] of the ends of the intervals of the pulse: of possible uplift, and of extremes of the pulse."""
        cuts = record["interval_phase"][: int(record["interval_count"]) + 1]
        phases = np.concatenate([cuts, [self.pulse.start, *self.pulse.stationary]])
        return np.asarray((phases - self.pulse.start) / self.frequency_ratio)

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
        rotation, velocity, nothing = np.zeros(tau.size), np.zeros(tau.size), np.empty(0)
        record, _ = self._sample_forced(tau, rotation, velocity, nothing)
        self._sample_free(record, tau, rotation, velocity, np.empty(MAX_FREE_IMPACTS))
        return rotation, velocity

    def sample_count(self, tau: Floats, rotation: Floats, record: Record) -> int:
        """Number of samples `rotation` at `tau` up to the first beyond `max_rotation`; all unless it overturns."""
        if not overturned(record):
            return tau.size
        return shown_count(tau, rotation, record, self.max_rotation)

    def ground_acceleration(self, tau: Floats) -> Floats:
        """Acceleration of the ground over g tan(alpha), a f [-] (3.2)."""
        return self.pulse.acceleration(self.pulse.start + self.frequency_ratio * tau) / self.slenderness

    def _sample_forced(
        self, tau: Floats, rotation: Floats, velocity: Floats, impact_times: Floats
    ) -> tuple[Record, int]:
        groups = (self.slenderness, self.frequency_ratio, self.restitution, self.alpha)
        rest = self.max_rotation, tau, rotation, velocity, impact_times, flag_array(self.stop)
        record = pulse_state(self.pulse).copy()
        if self.pulse.series.has_exact_arcs and self.alpha == 0.0:
            written = sample_arcs(*groups, record, *rest)
        else:
            written = solve_and_sample(*groups, record, step_state(record), *rest)
        if self.alpha == 0.0:
            self._set_response(record)
            at_rest = tau <= record["uplift_time"]  # which differs from that of the flights by rounding
            rotation[at_rest] = velocity[at_rest] = 0.0
        check_stop(self.stop)
        return record, int(written)

    def _set_response(self, record: Record) -> None:
        """Set the response of `peak_response`, whose stages round differently; the state at the pulse's end stays."""
        found = peak_response(
            self.pulse,
            slenderness=self.slenderness,
            frequency_ratio=self.frequency_ratio,
            restitution=self.restitution,
            stop=self.stop,
        )
        for field in RESPONSE_FIELDS:
            if field not in (END_ROTATION, END_VELOCITY, EXCEEDED_ALPHA):
                record[field.name] = getattr(found, field.name)

    def _sample_free(
        self, record: Record, tau: Floats, rotation: Floats, velocity: Floats, impact_times: Floats
    ) -> int:
        state = (*(float(record[name]) for name in ("end_rotation", "end_velocity", "end_sign")), self.alpha)
        steps = step_state(pulse_state(self.pulse))
        end = self.horizon * (1 + 1e-12)  # a step fills the samples before its end, so the last sample must lie inside
        samples = tau, rotation, velocity
        times = self.pulse_end, end
        written = sample_free_rocking(
            *state, steps, self.restitution, *times, self.max_rotation, *samples, impact_times, flag_array(self.stop)
        )
        check_stop(self.stop)
        return int(written)


def build_motion(
    pulse: str | AbstractPulse,
    *,
    slenderness: Scalar,
    frequency_ratio: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    duration: Scalar | None = None,
    stop: StopFlag | None = None,
) -> Motion:
    """The motion for given groups; arguments and errors as for `rocking.time_history`."""
    made = as_pulse(pulse)
    s, eta = check_number(SLENDERNESS, slenderness), check_number(RESTITUTION, restitution)
    omega, angle = check_number(FREQUENCY_RATIO, frequency_ratio), check_one_alpha(alpha)
    if duration is None:
        horizon = (made.end - made.start) / omega + FREE_DURATION
    else:
        horizon = positive("duration", duration, "-")
    return Motion(made, s, omega, eta, angle, horizon, stop)


def largest_rotation(alpha: float) -> float:
    """|theta|/alpha up to which a block of this slenderness angle [rad] that overturns is followed [-]."""
    return min(MAX_ROTATION, 0.5 * np.pi / alpha) if alpha > 0.0 else MAX_ROTATION


def shown_count(tau: Floats, rotation: Floats, record: Record, max_rotation: float) -> int:
    """Number of samples of a block that overturns, up to the first beyond `max_rotation` or the last that moves."""
    beyond = np.flatnonzero(np.abs(rotation) > max_rotation)
    if beyond.size:
        return int(beyond[0]) + 1
    shown = (rotation != 0.0) | (tau <= record["uplift_time"])
    return int(np.flatnonzero(shown).max(initial=0)) + 1


def overturned(record: Record) -> bool:
    """Whether the block of this record overturns in the end."""
    return bool(record["outcome"] >= Outcome.OVERTURNED_DIRECTLY)
