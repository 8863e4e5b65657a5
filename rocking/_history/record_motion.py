"""The motion of one body under samples of a ground motion as a function of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking._base.errors import number, positive
from rocking._base.units import Scalar
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import check_one_vertical_scale
from rocking._history.body_motion import FREE_DURATION, BodyMotion, Floats
from rocking._history.record_sampling import sample_record
from rocking._model.checks import check_number, check_one_alpha
from rocking._model.parameters import RESTITUTION, SLENDERNESS
from rocking._numba.cancellation import StopFlag, check_stop, flag_array
from rocking._numba.compilation import Record as KernelRecord
from rocking._solver.records.record_response import frequency_parameter_range
from rocking._solver.records.samples import SHAPE, TIME, VERTICAL, motion_samples
from rocking._solver.records.state import body_states, step_state
from rocking._solver.state import block_cell


@dataclass(frozen=True, eq=False)
class SamplesMotion(BodyMotion):
    """A `BodyMotion` under samples of a ground motion.

    Parameters
    ----------
    samples : float array (7, samples)
        Of `rocking._solver.records.samples.sample_rows`.
    """

    samples: Floats

    @property
    def times(self) -> Floats:
        """Times of the samples [tau]."""
        return np.asarray(self.cell["rate"] * self.samples[TIME])

    @property
    def pulse_end(self) -> float:
        return float(self.times[-1])

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
        """Times of the samples."""
        return self.times

    def ground_acceleration(self, tau: Floats) -> Floats:
        u = self.samples[SHAPE] / self.cell["slenderness"][0]
        return np.asarray(np.interp(tau, self.times, u, right=0.0))

    def vertical_acceleration(self, tau: Floats) -> Floats:
        w = self.samples[VERTICAL] * self.cell["vertical"]
        return np.asarray(np.interp(tau, self.times, w, right=0.0))

    def _sample_forced(
        self, tau: Floats, rotation: Floats, velocity: Floats, impact_times: Floats
    ) -> tuple[KernelRecord, int]:
        state, start = body_states(self.samples, 2)
        steps = step_state(self.samples, self.cell)
        rest = self.max_rotation, tau, rotation, velocity, impact_times, flag_array(self.stop)
        written = sample_record(self.samples, self.cell, state, start, steps, *rest)
        check_stop(self.stop)
        return state, int(written)


def build_record_motion(
    motion: Record,
    *,
    frequency_parameter: Scalar,
    slenderness: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    vertical_scale: Scalar | None = 1.0,
    duration: Scalar | None = None,
    stop: StopFlag | None = None,
) -> SamplesMotion:
    """The motion for given parameters; arguments and errors as for `rocking.time_history`."""
    p = number("frequency_parameter", frequency_parameter, *frequency_parameter_range(motion), unit="rad/s")
    s, eta = check_number(SLENDERNESS, slenderness), check_number(RESTITUTION, restitution)
    angle = check_one_alpha(alpha)
    vertical = check_one_vertical_scale(motion, vertical_scale)
    horizon = p * motion.duration + FREE_DURATION if duration is None else p * positive("duration", duration, "s")
    cell = block_cell(p * motion.time_step, s, eta, angle, vertical)
    return SamplesMotion(cell, horizon, stop, motion_samples(motion))
