"""The motion of one body under samples of a ground motion as a function of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking._numba.cancellation import StopFlag, check_stop, flag_array
from rocking._numba.compilation import Record as KernelRecord
from rocking.errors import in_range
from rocking.excitation.records.record import Record
from rocking.history.body_motion import FREE_DURATION, BodyMotion, Floats
from rocking.history.record_sampling import sample_record
from rocking.solver.records.record_response import check_record_groups
from rocking.solver.records.samples import SHAPE, TIME, VERTICAL, motion_samples
from rocking.solver.records.state import body_states, step_state
from rocking.solver.state import block_cells


@dataclass(frozen=True, eq=False)
class SamplesMotion(BodyMotion):
    """A `BodyMotion` under samples of a ground motion.

    Parameters
    ----------
    samples : float array (7, samples)
        Of `rocking.solver.records.samples.sample_rows`.
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
        """1: the samples themselves are among the events."""
        return 1.0

    def event_times(self, record: KernelRecord) -> Floats:
        """Times of the samples, where the ground acceleration has kinks; `record` is not needed."""
        del record
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
    frequency_parameter: float,
    slenderness: float,
    restitution: float,
    alpha: float | None = None,
    duration: float | None = None,
    stop: StopFlag | None = None,
) -> SamplesMotion:
    """The motion for given parameters; arguments and errors as for `rocking.record_history`."""
    checked = check_record_groups(motion, frequency_parameter, slenderness, restitution, alpha)
    p, s, eta, angle = (np.atleast_1d(group) for group in checked)
    if duration is not None:
        in_range("duration", duration, 0.0, np.inf, closed="neither", unit="s")
    horizon = float(p[0]) * (motion.duration if duration is None else float(duration))
    horizon += FREE_DURATION if duration is None else 0.0
    return SamplesMotion(block_cells(p * motion.time_step, s, eta, angle)[0], horizon, stop, motion_samples(motion))
