"""Bodies with two edges under a pulse or a record, in the units of the solver."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.errors import InvalidArgumentError, in_range
from rocking._boundary.search import Solve
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import reject_flight
from rocking._history.motion import FREE_DURATION, BodyMotion, PulseMotion, SamplesMotion
from rocking._model.body import AbstractBody
from rocking._model.checks import check
from rocking._model.labelled import Index
from rocking._model.parameters import ALPHA, FREQUENCY_RATIO, SMALLEST_ALPHA
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import Record as KernelRecord
from rocking._solver.bodies import outcome_margin_of, solve_motion
from rocking._solver.records.record_response import frequency_parameter_range, pulse_rows
from rocking._solver.records.samples import motion_samples
from rocking._solver.state import BODY_CELL

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BodyProblem:
    """Bodies under a ground motion.

    Attributes
    ----------
    body : AbstractBody
        One body or an array of them.
    motion : AbstractPulse or Record
        The ground motion.
    acceleration : float array [m/s2]
        Largest horizontal acceleration, > 0.
    period : float array [s]
        Of a pulse, > 0; 1 for a record.
    restitution : float array or None
        Of every impact [-]; None: by angular momentum, 0 where that is negative.
    index : (name, labels) or None
        Index of the last axis if an argument was a series (pandas).

    Raises
    ------
    InvalidArgumentError
        If an edge or a ratio of frequencies is out of range, or the equation of motion is linear.
    """

    body: AbstractBody
    motion: AbstractPulse | Record
    acceleration: Array
    period: Array
    restitution: Array | None
    index: Index | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        if self.body.is_linear:
            about = self.body.description
            raise InvalidArgumentError(
                "body", about, "solved with numbers, not arrays: its equation of motion is linear"
            )
        for name, edge in (("right", self.body.right), ("left", self.body.left)):
            in_range(f"alpha of the {name} edge", edge.alpha, SMALLEST_ALPHA, ALPHA.upper, unit="rad")
            in_range(f"restitution of the {name} edge", edge.restitution, -math.inf, 1.0, closed="right")
        p = self.body.right.frequency_parameter
        if isinstance(self.motion, Record):
            in_range("frequency_parameter", p, *frequency_parameter_range(self.motion), unit="rad/s")
        else:
            check(FREQUENCY_RATIO, 2.0 * math.pi / (self.period * p))

    @property
    def shape(self) -> tuple[int, ...]:
        """Broadcast shape of the body and the arguments."""
        eta = () if self.restitution is None else self.restitution.shape
        return np.broadcast_shapes(self.body.shape, self.acceleration.shape, self.period.shape, eta)

    @property
    def vertical_scale(self) -> Array:
        """Factor of the vertical component of a record, over the standard gravity [-]; 0 without one."""
        if not isinstance(self.motion, Record) or self.motion.vertical is None:
            return np.zeros(())
        return np.asarray(self.acceleration / self.motion.peak_acceleration * (STANDARD_GRAVITY / self.body.gravity))

    @cached_property
    def cells(self) -> NDArray[np.void]:
        """The cells `BODY_CELL` of the solver (size,), not to be changed."""
        body, right, left = self.body, self.body.right, self.body.left
        etas = [edge.restitution if self.restitution is None else self.restitution for edge in (right, left)]
        p = right.frequency_parameter
        unit = self.motion.time_step * p if isinstance(self.motion, Record) else 2.0 * math.pi / (self.period * p)
        columns = {
            "rate": unit,
            "vertical": self.vertical_scale,
            "alpha": right.alpha,
            "ratio": left.alpha / right.alpha,
            "stiffness": (left.frequency_parameter / p) ** 2,
        }
        cells = np.zeros(self.shape, BODY_CELL)
        for name, value in columns.items():
            cells[name] = value
        for side, edge in enumerate((right, left)):
            cells["slenderness"][..., side] = body.gravity * np.tan(edge.alpha) / self.acceleration  # (5.3)
            cells["eta"][..., side] = np.maximum(etas[side], 0.0)  # departs from (2.4) where that is negative
        return cells.ravel()

    def solve(self, threads: int | None = None, stop: StopFlag | None = None) -> tuple[NDArray[np.void], Array]:
        """`rocking._solver.bodies.solve_motion` of `cells`; refused where the vertical acceleration reaches -g."""
        self._reject_flight()
        return solve_motion(self.motion, self.cells, threads, stop)

    def solver(self, index: int = 0, stop: StopFlag | None = None) -> Solve:
        """One of the bodies as a `Solve`: slenderness over that of uplift, `rate` of the cell; eta is not read."""
        cell: KernelRecord = self.cells[index]
        uplift = cell["slenderness"] / cell["slenderness"].min()
        vertical = cell["vertical"] * cell["slenderness"].min()  # at uplift

        def solve(slenderness: Array, omega: Array, eta: Array) -> tuple[NDArray[np.void], Array]:
            cells = np.repeat(cell, eta.size)
            cells["rate"], cells["slenderness"] = omega, slenderness[:, None] * uplift
            cells["vertical"] = vertical / slenderness
            records, edges = solve_motion(self.motion, cells, None, stop)
            return records, outcome_margin_of(records, edges, cells)

        return solve

    def body_motion(self, duration: float | None = None, stop: StopFlag | None = None, index: int = 0) -> BodyMotion:
        """The motion of one of the bodies over time, up to a duration [s] or 8/p after the ground motion."""
        self._reject_flight()
        cell: KernelRecord = self.cells[index : index + 1].copy()[0]
        edges, place = (self.body.right, self.body.left), np.unravel_index(index, self.shape)

        def own(values: Array) -> float:
            return float(np.broadcast_to(values, self.shape)[place])

        inertia = own(edges[0].inertia_ratio), own(edges[1].inertia_ratio)
        tilt, p = own(self.body.tilt), own(edges[0].frequency_parameter)
        motion = self.motion
        if isinstance(motion, Record):
            end, rows = p * motion.duration, motion_samples(motion)
        else:
            end = (motion.end - motion.start) / float(cell["rate"])
        horizon = end + FREE_DURATION if duration is None else p * duration
        if not isinstance(motion, Record):
            if motion.samples is None:
                return PulseMotion(cell, horizon, stop, motion, inertia_ratio=inertia, tilt=tilt)
            rows = pulse_rows(motion, float(cell["rate"]))
            cell["rate"] = 1.0 / cell["rate"]
        return SamplesMotion(cell, horizon, stop, rows, inertia_ratio=inertia, tilt=tilt)

    def _reject_flight(self) -> None:
        if isinstance(self.motion, Record) and self.motion.vertical is not None:
            scale = self.acceleration / self.motion.peak_acceleration
            for g in np.unique(self.body.gravity).tolist():
                reject_flight("scale", self.motion, float(np.max(scale, where=self.body.gravity == g, initial=0.0)), g)
