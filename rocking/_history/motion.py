"""The motion of one body as a function of time, sampled at given times by the flights of the solver."""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rocking._base.errors import number, positive
from rocking._base.quantities import FREQUENCY_RATIO, RESTITUTION, SLENDERNESS
from rocking._base.units import Scalar
from rocking._excitation.pulses import AbstractPulse, GroundMotion, as_pulse
from rocking._excitation.records.record import Record as RecordedMotion
from rocking._excitation.records.vertical import check_one_vertical_scale
from rocking._excitation.shapes import MAX_PIECES
from rocking._history.sampling import ROTATION, TAU, VELOCITY, sample_flights, sample_free_rocking, sample_record
from rocking._model.checks import check_one_alpha
from rocking._model.fields import END_ROTATION, END_VELOCITY, SOLVED_FIELDS
from rocking._model.reactions import INERTIA_RATIO, ContactGeometry
from rocking._model.response import Outcome
from rocking._numba.cancellation import StopFlag, check_stop, flag_array
from rocking._numba.compilation import Record
from rocking._numba.simd import LANES
from rocking._solver.bodies import outcome_margin_of
from rocking._solver.kernels.batch import solve_batch
from rocking._solver.peak_response import NO_EDGES, peak_response
from rocking._solver.records import state as samples_state
from rocking._solver.records.record_response import NO_RESTRAINT, pulse_rows
from rocking._solver.records.samples import SHAPE, TIME, VERTICAL, motion_samples
from rocking._solver.restrained import is_restrained, restrain
from rocking._solver.rules import IMPACT_LIMIT
from rocking._solver.state import (
    BODY_CELL,
    BODY_FIELDS,
    EDGE_COLUMNS,
    FOLLOWED_FLIGHT,
    RESPONSE_RECORD,
    block_cell,
    pulse_state,
    restraint_level,
    step_state,
)

Floats = NDArray[np.float64]

FREE_DURATION = 8.0  # default duration of free rocking after the pulse [tau]
MAX_FREE_IMPACTS = 10_000  # largest number of impacts of free rocking

MAX_FLIGHTS = IMPACT_LIMIT + 12 * (MAX_PIECES + 1)
"""Most flights under a pulse: three more impacts and one uplift in each of the three intervals of a piece."""

MAX_ROTATION = 4.0
"""|theta|/alpha up to which an overturning block is followed [-]; it lies on the ground at |theta| = pi/2."""


@dataclass(frozen=True, eq=False)
class BodyMotion(ABC):
    """The motion of one body as a function of tau, from the start of the ground motion to a horizon.

    `cell`: the body, and the rate of the ground motion. `horizon`: tau at which to stop [-]. `stop`: cancels the work:
    the methods raise `StoppedError` soon after another thread sets the flag. `inertia_ratio`: R p^2/g of the right and
    the left edge [-], for the contact forces; 3/4 for a rectangle. `tilt`: angle by which the base is inclined towards
    the right [rad].
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
    def ground_rate(self) -> float:
        """Largest of 1 and the rate of the phase of the ground motion with respect to tau [-]."""
        return 1.0

    @property
    def kink_times(self) -> Floats:
        """Times [tau] at which the reactions are continuous and may have a kink."""
        return np.empty(0)

    def jump_times(self, record: Record) -> Floats:
        """Times [tau] other than impacts at which the reactions may jump."""
        del record
        return np.empty(0)

    @abstractmethod
    def ground_acceleration(self, tau: Floats) -> Floats:
        """Acceleration of the ground over g tan(alpha), a f [-] (3.2); alpha of the right edge."""

    def vertical_acceleration(self, tau: Floats) -> Floats:
        """Vertical acceleration of the ground over g, upwards [-]."""
        return np.zeros(tau.size)

    @abstractmethod
    def _sample_forced(self, history: Floats, impact_times: Floats) -> tuple[Record, int]:
        """Sample the motion until the ground motion ends; the solver state, and the number of impacts written."""

    @cached_property
    def restitution(self) -> float:
        """Of impacts that leave the right edge [-]."""
        return float(self.cell["eta"][0])

    @cached_property
    def slenderness(self) -> float:
        """g tan(alpha) over the largest ground acceleration [-]; of the left edge if nothing lifts the right one."""
        right, left = self.cell["slenderness"].tolist()
        return float(right if right < math.inf else left)

    @cached_property
    def alpha(self) -> float:
        """Slenderness angle of the right edge [rad], 0 for the slender limit."""
        return float(self.cell["alpha"])

    @cached_property
    def contact_geometry(self) -> ContactGeometry:
        """What the contact forces need beside alpha."""
        ratio, speed = float(self.cell["ratio"]), math.sqrt(float(self.cell["stiffness"]))
        return ContactGeometry(ratio, speed, self.inertia_ratio, self.tilt)

    @cached_property
    def max_rotation(self) -> float:
        """|theta|/alpha up to which a body that overturns is followed [-]: `MAX_ROTATION`, or |theta| = pi/2."""
        most = MAX_ROTATION * max(1.0, float(self.cell["ratio"]))
        return min(most, 0.5 * math.pi / self.alpha) if self.alpha > 0.0 else most

    def events(self) -> tuple[Record, Floats]:
        """The record of the solver with the response, and the times of the impacts [tau]."""
        nothing = np.empty((3, 0))
        forced, free = np.empty(IMPACT_LIMIT), np.empty(MAX_FREE_IMPACTS)
        record, written = self._sample_forced(nothing, forced)
        then = self._sample_free(record, nothing, free)
        impact_times = np.concatenate([forced[:written], free[:then]])
        return record, impact_times[impact_times <= self.horizon]

    def sample(self, tau: Floats) -> tuple[Floats, Floats]:
        """theta/alpha and d(theta/alpha)/d tau [-] at ascending times `tau`; zero after overturning."""
        history = np.zeros((3, tau.size))
        history[TAU] = tau
        record, _ = self._sample_forced(history, np.empty(0))
        self._sample_free(record, history, np.empty(MAX_FREE_IMPACTS))
        return history[ROTATION], history[VELOCITY]

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

    def _sample_free(self, state: Record, history: Floats, impact_times: Floats) -> int:
        """Sample free rocking from the state at the end of the ground motion; the number of impacts written."""
        body: Record = np.zeros(1, samples_state.BLOCK_STATE)[0]
        for name, *_ in BODY_FIELDS:
            body[name] = state[name]
        written = sample_free_rocking(
            float(state["end_rotation"]),
            float(state["end_velocity"]),
            float(state["end_sign"]),
            body,
            self._free_steps,
            self.pulse_end,
            self.horizon * (1 + 1e-12),  # a step fills the samples before its end, so the last must lie inside
            self.max_rotation,
            history,
            impact_times,
            self._flag,
        )
        if self._flag[0]:
            check_stop(self.stop)
        return int(written)

    @cached_property
    def _free_steps(self) -> Record:
        """Taylor steps of free rocking: without ground motion any pulse serves."""
        return self._restrained(step_state(pulse_state(as_pulse("sine"))))

    def _restrained(self, steps: Record) -> Record:
        """The steps, set for tendon and damper of the body."""
        steps["restrained"] = restraint_level(self.cell)
        return steps

    @cached_property
    def _flag(self) -> NDArray[np.uint8]:
        return flag_array(self.stop)


def overturned(record: Record) -> bool:
    """Whether the body of this record overturns in the end."""
    return bool(record["outcome"] >= Outcome.OVERTURNED_DIRECTLY)


@dataclass(frozen=True, eq=False)
class PulseMotion(BodyMotion):
    """A `BodyMotion` under a pulse."""

    pulse: AbstractPulse

    @cached_property
    def frequency_ratio(self) -> float:
        """omega = omega_g/p [-]."""
        return float(self.cell["rate"])

    @cached_property
    def pulse_end(self) -> float:
        return (self.pulse.end - self.pulse.start) / self.frequency_ratio

    @property
    def ground_rate(self) -> float:
        return max(1.0, self.frequency_ratio)

    def jump_times(self, record: Record) -> Floats:
        """Ends of the intervals of the pulse: of possible uplift, and of extremes of the pulse."""
        cuts = record["interval_phase"][: int(record["interval_count"]) + 1]
        phases = np.concatenate([cuts, [self.pulse.start, *self.pulse.stationary]])
        return np.asarray((phases - self.pulse.start) / self.frequency_ratio)

    def ground_acceleration(self, tau: Floats) -> Floats:
        start, end = self.pulse.start, self.pulse.end
        phi = start + self.frequency_ratio * tau
        f = np.where((phi >= start) & (phi <= end), self.pulse.shape(np.clip(phi, start, end)), 0.0)
        return np.asarray(f / self.slenderness)

    def _sample_forced(self, history: Floats, impact_times: Floats) -> tuple[Record, int]:
        followed, solved = self._flights
        record = solved.copy()
        sample_flights(followed, record, self._steps, self.max_rotation, history, self._flag)
        impacts = followed if record["end_sign"] == 0.0 else followed[:-1]
        written = min(impacts.size, impact_times.size)
        impact_times[:written] = (impacts["next_phase"][:written] - self.pulse.start) / self.frequency_ratio
        if self.alpha == 0.0:
            self._set_response(record)
            at_rest = history[TAU] <= record["uplift_time"]  # the flights have another one by rounding
            history[ROTATION, at_rest] = history[VELOCITY, at_rest] = 0.0
        if self._flag[0]:
            check_stop(self.stop)
        return record, written

    @cached_property
    def _steps(self) -> Record:
        """Taylor steps under the pulse."""
        return self._restrained(step_state(pulse_state(self.pulse)))

    @cached_property
    def _flights(self) -> tuple[NDArray[np.void], Record]:
        """The flights under the pulse by Taylor steps, and the state of the solver after them."""
        cell, state = self.cell, np.repeat(pulse_state(self.pulse), LANES)
        followed, response = np.empty(MAX_FLIGHTS, FOLLOWED_FLIGHT), np.empty(1, RESPONSE_RECORD)
        equal = cell["ratio"] == cell["stiffness"] == 1.0 and cell["eta"][0] == cell["eta"][1]
        equal = equal and cell["slenderness"][0] == cell["slenderness"][1]
        edges = NO_EDGES if equal else np.empty((1, EDGE_COLUMNS))
        steps = self._restrained(step_state(state[0]))
        count = solve_batch(np.array([cell]), state, steps, self._flag, response, edges, followed)
        if self._flag[0]:
            check_stop(self.stop)
        return followed[:count].copy(), state[0]

    def _set_response(self, record: Record) -> None:
        """Set the response of `peak_response`, whose stages round differently; the state at the pulse's end stays."""
        found = peak_response(
            self.pulse,
            slenderness=self.cell["slenderness"][0],
            frequency_ratio=self.frequency_ratio,
            restitution=self.restitution,
            stiffness=self.cell["spring"],
            prestress=self.cell["prestress"],
            damping=self.cell["damping"],
            stop=self.stop,
        )
        for solved in SOLVED_FIELDS:
            if solved not in (END_ROTATION, END_VELOCITY):
                record[solved.name] = getattr(found, solved.name)


@dataclass(frozen=True, eq=False)
class SamplesMotion(BodyMotion):
    """A `BodyMotion` under samples of a ground motion.

    `samples` (7, samples): of `rocking._solver.records.samples.sample_rows`.
    """

    samples: Floats

    @property
    def times(self) -> Floats:
        """Times of the samples [tau]."""
        return np.asarray(self.cell["rate"] * self.samples[TIME])

    @cached_property
    def pulse_end(self) -> float:
        return float(self.times[-1])

    @property
    def kink_times(self) -> Floats:
        """Times of the samples; between them the ground acceleration is linear."""
        return self.times

    def ground_acceleration(self, tau: Floats) -> Floats:
        u = self.samples[SHAPE] / self.slenderness
        return np.asarray(np.interp(tau, self.times, u, right=0.0))

    def vertical_acceleration(self, tau: Floats) -> Floats:
        w = self.samples[VERTICAL] * self.cell["vertical"]
        return np.asarray(np.interp(tau, self.times, w, right=0.0))

    def _sample_forced(self, history: Floats, impact_times: Floats) -> tuple[Record, int]:
        state, start = samples_state.body_states(self.samples, 2)
        steps = samples_state.step_state(self.samples, self.cell)
        rest = self.max_rotation, history, impact_times, self._flag
        written = sample_record(self.samples, self.cell, state, start, steps, *rest)
        if self._flag[0]:
            check_stop(self.stop)
        return state, int(written)


@dataclass(frozen=True, eq=False)
class FreeMotion(BodyMotion):
    """A `BodyMotion` without ground motion: released at rest from a rotation.

    `start`: theta over alpha of the right edge [-], not 0; about an edge that no wall blocks.
    """

    start: float

    @property
    def pulse_end(self) -> float:
        return 0.0

    def ground_acceleration(self, tau: Floats) -> Floats:
        return np.zeros(tau.size)

    def _sample_forced(self, history: Floats, impact_times: Floats) -> tuple[Record, int]:
        del history, impact_times
        cells = np.array([self.cell], BODY_CELL)
        state: Record = np.zeros(1, samples_state.BLOCK_STATE)[0]
        for name in ("alpha", "eta", "slenderness"):
            state[name] = self.cell[name]
        state["a"] = 1.0 / self.cell["slenderness"]
        for name in ("ratio", "stiffness"):
            state[name] = 1.0, self.cell[name]
        for name in ("spring", "damping"):
            state[name] = self.cell[name]
        state["level"], state["restrained"] = 1.0 + self.cell["prestress"], int(is_restrained(cells)[0])
        state["speed"] = state["ratio"] * np.sqrt(state["stiffness"])
        state["turn"] = 1.0 if np.isinf(self.cell["slenderness"]).any() else -1.0
        state["end_rotation"], state["end_sign"] = abs(self.start), math.copysign(1.0, self.start)
        response, edges = np.zeros(1, RESPONSE_RECORD), np.zeros((1, EDGE_COLUMNS))
        response["end_rotation"], edges[:, 2] = state["end_rotation"], state["end_sign"]
        at_once = state["end_rotation"] >= state["ratio"][0 if self.start > 0.0 else 1]
        if state["restrained"] == 1:  # whether it escapes without an impact: after one of restitution 0 it does not
            without = cells.copy()
            without["eta"] = 0.0
            at_once = outcome_margin_of(response, edges, without)[0] >= 0.0
        later = outcome_margin_of(response, edges, cells)[0] >= 0.0
        outcome = Outcome.OVERTURNED_AFTER_IMPACT if later else Outcome.RECOVERS
        state["outcome"] = Outcome.OVERTURNED_DIRECTLY if at_once else outcome
        return state, 0


def motion_of_body(
    motion: GroundMotion,
    cell: Record,
    horizon: float,
    stop: StopFlag | None = None,
    inertia_ratio: tuple[float, float] = (INERTIA_RATIO, INERTIA_RATIO),
    tilt: float = 0.0,
) -> BodyMotion:
    """The motion of a body `BODY_CELL` under a ground motion; `rate` of the cell as `rocking._solver.bodies.solve`."""
    if isinstance(motion, RecordedMotion):
        rows = motion_samples(motion)
    elif motion.samples is None:
        return PulseMotion(cell, horizon, stop, motion, inertia_ratio=inertia_ratio, tilt=tilt)
    else:
        rows = pulse_rows(motion, float(cell["rate"]))
        cell["rate"] = 1.0 / cell["rate"]
    return SamplesMotion(cell, horizon, stop, rows, inertia_ratio=inertia_ratio, tilt=tilt)


def build_motion(
    pulse: str | AbstractPulse,
    *,
    slenderness: Scalar,
    frequency_ratio: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    restraint: Mapping[str, Floats] = NO_RESTRAINT,
    duration: Scalar | None = None,
    stop: StopFlag | None = None,
) -> BodyMotion:
    """The motion for given groups; arguments and errors as for `rocking.time_history`."""
    made = as_pulse(pulse)
    s, eta = SLENDERNESS.number(slenderness), RESTITUTION.number(restitution)
    omega, angle = FREQUENCY_RATIO.number(frequency_ratio), check_one_alpha(alpha)
    if duration is None:
        horizon = (made.end - made.start) / omega + FREE_DURATION
    else:
        horizon = positive("duration", duration, "-")
    cell = block_cell(omega, s, eta, angle)
    restrain(cell, restraint)
    return motion_of_body(made, cell, horizon, stop)


def build_record_motion(
    motion: RecordedMotion,
    *,
    frequency_parameter: Scalar,
    slenderness: Scalar,
    restitution: Scalar,
    alpha: Scalar | None = None,
    vertical_scale: Scalar | None = 1.0,
    restraint: Mapping[str, Floats] = NO_RESTRAINT,
    duration: Scalar | None = None,
    stop: StopFlag | None = None,
) -> BodyMotion:
    """The motion for given parameters; arguments and errors as for `rocking.time_history`."""
    p = number("frequency_parameter", frequency_parameter, *motion.frequency_parameters, unit="rad/s")
    s, eta = SLENDERNESS.number(slenderness), RESTITUTION.number(restitution)
    angle = check_one_alpha(alpha)
    vertical = check_one_vertical_scale(motion, vertical_scale)
    horizon = p * motion.duration + FREE_DURATION if duration is None else p * positive("duration", duration, "s")
    cell = block_cell(p * motion.time_step, s, eta, angle, vertical)
    restrain(cell, restraint)
    return motion_of_body(motion, cell, horizon, stop)
