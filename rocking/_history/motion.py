"""The motion of one body under a pulse as a function of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking._base.errors import positive
from rocking._base.units import Scalar
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._history.body_motion import FREE_DURATION, BodyMotion, Floats
from rocking._history.record_motion import SamplesMotion
from rocking._history.sampling import sample_arcs, solve_and_sample
from rocking._model.checks import check_number, check_one_alpha
from rocking._model.fields import END_ROTATION, END_VELOCITY, SOLVED_FIELDS
from rocking._model.parameters import FREQUENCY_RATIO, RESTITUTION, SLENDERNESS
from rocking._numba.cancellation import StopFlag, check_stop, flag_array
from rocking._numba.compilation import Record
from rocking._solver.peak_response import peak_response
from rocking._solver.records.record_response import pulse_rows
from rocking._solver.state import block_cell, pulse_state, step_state


@dataclass(frozen=True, eq=False)
class PulseMotion(BodyMotion):
    """A `BodyMotion` under a pulse.

    Parameters
    ----------
    pulse : AbstractPulse
    """

    pulse: AbstractPulse

    @property
    def frequency_ratio(self) -> float:
        """omega = omega_g/p [-]."""
        return float(self.cell["rate"])

    @property
    def pulse_end(self) -> float:
        return (self.pulse.end - self.pulse.start) / self.frequency_ratio

    @property
    def ground_rate(self) -> float:
        return max(1.0, self.frequency_ratio)

    @property
    def kink_times(self) -> Floats:
        """None: a pulse is smooth between its ends."""
        return np.empty(0)

    def jump_times(self, record: Record) -> Floats:
        """Ends of the intervals of the pulse: of possible uplift, and of extremes of the pulse."""
        cuts = record["interval_phase"][: int(record["interval_count"]) + 1]
        phases = np.concatenate([cuts, [self.pulse.start, *self.pulse.stationary]])
        return np.asarray((phases - self.pulse.start) / self.frequency_ratio)

    def ground_acceleration(self, tau: Floats) -> Floats:
        f = self.pulse.acceleration(self.pulse.start + self.frequency_ratio * tau)
        return np.asarray(f / self.cell["slenderness"][0])

    def _sample_forced(
        self, tau: Floats, rotation: Floats, velocity: Floats, impact_times: Floats
    ) -> tuple[Record, int]:
        rest = self.max_rotation, tau, rotation, velocity, impact_times, flag_array(self.stop)
        record = pulse_state(self.pulse).copy()
        if self.pulse.series.has_exact_arcs and self.alpha == 0.0:
            written = sample_arcs(self.cell, record, *rest)
        else:
            written = solve_and_sample(self.cell, record, step_state(record), *rest)
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
            slenderness=self.cell["slenderness"][0],
            frequency_ratio=self.frequency_ratio,
            restitution=self.restitution,
            stop=self.stop,
        )
        for field in SOLVED_FIELDS:
            if field not in (END_ROTATION, END_VELOCITY):
                record[field.name] = getattr(found, field.name)


def build_motion(
    pulse: str | AbstractPulse,
    *,
    slenderness: Scalar,
    frequency_ratio: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    duration: Scalar | None = None,
    stop: StopFlag | None = None,
) -> BodyMotion:
    """The motion for given groups; arguments and errors as for `rocking.time_history`."""
    made = as_pulse(pulse)
    s, eta = check_number(SLENDERNESS, slenderness), check_number(RESTITUTION, restitution)
    omega, angle = check_number(FREQUENCY_RATIO, frequency_ratio), check_one_alpha(alpha)
    if duration is None:
        horizon = (made.end - made.start) / omega + FREE_DURATION
    else:
        horizon = positive("duration", duration, "-")
    if made.samples is not None:
        rows = pulse_rows(made, omega)
        return SamplesMotion(block_cell(1.0 / omega, s, eta, angle), horizon, stop, rows)
    return PulseMotion(block_cell(omega, s, eta, angle), horizon, stop, made)
