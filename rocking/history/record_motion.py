"""The motion of one block under a recorded ground motion as a function of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking._numba.cancellation import StopFlag, check_stop, flag_array
from rocking._numba.compilation import Record as KernelRecord
from rocking.errors import number, positive
from rocking.excitation.pulses import get_pulse
from rocking.excitation.records.record import Record
from rocking.history.motion import (
    FREE_DURATION,
    MAX_FREE_IMPACTS,
    Floats,
    largest_rotation,
    overturned,
    shown_count,
)
from rocking.history.record_sampling import sample_record
from rocking.history.sampling import sample_free_rocking
from rocking.model.checks import check_number, check_one_alpha
from rocking.model.parameters import RESTITUTION, SLENDERNESS
from rocking.solver.kernels.event_loop import IMPACT_LIMIT
from rocking.solver.records.record_response import frequency_parameter_range
from rocking.solver.records.samples import motion_samples
from rocking.solver.records.state import BLOCK_STATE, step_state
from rocking.solver.state import pulse_state
from rocking.solver.state import step_state as free_step_state
from rocking.units import Scalar


@dataclass(frozen=True)
class RecordMotion:
    """One block under a recorded motion, from its first sample to a horizon; a `SampledMotion`.

    Parameters
    ----------
    record : Record
    frequency_parameter, slenderness, restitution, alpha : float
        p [rad/s], 1/a, eta [-]; alpha [rad], 0 for the slender limit; checked by `build_record_motion`.
    horizon : float
        tau at which to stop [-].
    stop : StopFlag, optional
        Cancels the work: the methods raise `StoppedError` soon after another thread sets the flag.
    """

    record: Record
    frequency_parameter: float
    slenderness: float
    restitution: float
    alpha: float
    horizon: float
    stop: StopFlag | None = None

    @property
    def interval(self) -> float:
        """Length of a sample interval [tau]."""
        return self.frequency_parameter * self.record.time_step

    @property
    def pulse_end(self) -> float:
        """tau of the last sample [-]."""
        return self.interval * (self.record.samples - 1)

    @property
    def max_rotation(self) -> float:
        """|theta|/alpha up to which a block that overturns is followed [-]."""
        return largest_rotation(self.alpha)

    @property
    def ground_rate(self) -> float:
        """1: the samples themselves are among the kinks."""
        return 1.0

    def jump_times(self, record: KernelRecord) -> Floats:
        """None: the ground acceleration is continuous from the first sample to the last."""
        del record
        return np.empty(0)

    @property
    def kink_times(self) -> Floats:
        """Times [tau] of the samples."""
        return self.interval * np.arange(self.record.samples, dtype=np.float64)

    def events(self) -> tuple[KernelRecord, Floats]:
        """The record of the solver with the response, and the times of the impacts [tau]."""
        nothing = np.empty(0)
        forced, free = np.empty(IMPACT_LIMIT), np.empty(MAX_FREE_IMPACTS)
        state, written = self._sample_forced(nothing, nothing, nothing, forced)
        then = self._sample_free(state, nothing, nothing, nothing, free)
        impact_times = np.concatenate([forced[:written], free[:then]])
        return state, impact_times[impact_times <= self.horizon]

    def sample(self, tau: Floats) -> tuple[Floats, Floats]:
        """theta/alpha and d(theta/alpha)/d tau [-] at ascending times `tau`; zero after overturning."""
        rotation, velocity = np.zeros(tau.size), np.zeros(tau.size)
        state, _ = self._sample_forced(tau, rotation, velocity, np.empty(0))
        self._sample_free(state, tau, rotation, velocity, np.empty(MAX_FREE_IMPACTS))
        return rotation, velocity

    def sample_count(self, tau: Floats, rotation: Floats, record: KernelRecord) -> int:
        """Number of samples `rotation` at `tau` up to the first beyond `max_rotation`; all unless it overturns."""
        return shown_count(tau, rotation, record, self.max_rotation) if overturned(record) else tau.size

    def ground_acceleration(self, tau: Floats) -> Floats:
        """Acceleration of the ground over g tan(alpha) [-]: linear between the samples, zero after the last."""
        times = self.interval * np.arange(self.record.samples)
        u = self.record.acceleration / (self.record.peak_acceleration * self.slenderness)
        return np.asarray(np.interp(tau, times, u, right=0.0))

    def _sample_forced(
        self, tau: Floats, rotation: Floats, velocity: Floats, impact_times: Floats
    ) -> tuple[KernelRecord, int]:
        state, start = np.zeros(1, BLOCK_STATE)[0], np.zeros(1, BLOCK_STATE)[0]
        groups = self.interval, self.slenderness, self.restitution, self.alpha
        steps = step_state(self.interval)
        written = sample_record(
            motion_samples(self.record),
            *groups,
            state,
            start,
            steps,
            self.max_rotation,
            tau,
            rotation,
            velocity,
            impact_times,
            flag_array(self.stop),
        )
        check_stop(self.stop)
        return state, int(written)

    def _sample_free(
        self, state: KernelRecord, tau: Floats, rotation: Floats, velocity: Floats, impact_times: Floats
    ) -> int:
        end = tuple(float(state[name]) for name in ("end_rotation", "end_velocity", "end_sign"))
        steps = free_step_state(pulse_state(get_pulse("sine")))  # without ground motion any pulse serves
        horizon = self.horizon * (1 + 1e-12)  # a step fills the samples before its end
        written = sample_free_rocking(
            *end,
            self.alpha,
            steps,
            self.restitution,
            self.pulse_end,
            horizon,
            self.max_rotation,
            tau,
            rotation,
            velocity,
            impact_times,
            flag_array(self.stop),
        )
        check_stop(self.stop)
        return int(written)


def build_record_motion(
    motion: Record,
    *,
    frequency_parameter: Scalar,
    slenderness: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    duration: Scalar | None = None,
    stop: StopFlag | None = None,
) -> RecordMotion:
    """The motion for given parameters; arguments and errors as for `rocking.record_history`."""
    p = number("frequency_parameter", frequency_parameter, *frequency_parameter_range(motion), unit="rad/s")
    s, eta = check_number(SLENDERNESS, slenderness), check_number(RESTITUTION, restitution)
    angle = check_one_alpha(alpha)
    horizon = p * motion.duration + FREE_DURATION if duration is None else p * positive("duration", duration, "s")
    return RecordMotion(motion, p, s, eta, angle, horizon, stop)
