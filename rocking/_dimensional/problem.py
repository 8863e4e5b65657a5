"""Bodies under a pulse or a record in SI units; both components of a record have the same factor.

One block with numbers for its arguments is solved in groups, with a bound of the error under a pulse; arrays, and
bodies whose edges differ, are solved by their two edges. `Problem.of` checks what a user gives, once: below it there
are floats and arrays.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking._base.quantities as q
from rocking._base.arrays import Array
from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError, broadcast, in_range, needed, reject_given
from rocking._base.units import Scalar, Values
from rocking._boundary.search import Solve
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale, reject_flight
from rocking._history.motion import (
    FREE_DURATION,
    BodyMotion,
    PulseMotion,
    SamplesMotion,
    build_motion,
    build_record_motion,
)
from rocking._model.block import AbstractBlock
from rocking._model.body import AbstractBody
from rocking._model.checks import impact_share, spread_impact
from rocking._model.fields import SOLVED_FIELDS
from rocking._model.labelled import Index, index_of
from rocking._model.response import Response
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import Record as KernelRecord
from rocking._solver.bodies import outcome_margin_of, solve_motion
from rocking._solver.bounded_response import BoundedResponse, solve_checked
from rocking._solver.records.record_response import frequency_parameter_range, pulse_rows, record_response
from rocking._solver.records.samples import motion_samples
from rocking._solver.state import BODY_CELL

Motion = str | AbstractPulse | Record

STRENGTHS = {one.name: one for one in (q.PEAK_ACCELERATION, q.PERIOD, q.SCALE)}


@dataclass(frozen=True, eq=False)
class Problem(EqualByValue):
    """Bodies under a ground motion; floats for one block under one motion, otherwise arrays that broadcast."""

    body: AbstractBody  # one body or an array of them
    motion: AbstractPulse | Record  # the ground motion, a record without its factor
    peak_acceleration: Any  # largest horizontal acceleration, > 0; of a record times its factor [m/s2]
    period: Any  # T_p = 2 pi/omega_g of a pulse, > 0; 1 for a record. `duration` is how long the motion lasts [s]
    restitution: Any  # eta of every impact [-], [0, 1]; None: by angular momentum, 0 where that is negative
    scale: Any = 1.0  # factor of a record, of both its components [-]; 1 for a pulse
    # the arguments that were given, before broadcasting, for the coordinates of exports; nothing for one block
    arguments: Mapping[str, Array] = field(default_factory=dict, compare=False, repr=False)
    # index of the last axis if an argument was a series (pandas)
    index: Index | None = field(default=None, compare=False, repr=False)
    # whether the peak acceleration was no plain number
    unit_is_stated: bool = field(default=True, compare=False, repr=False)

    @classmethod
    def of(
        cls,
        body: AbstractBody,
        motion: Motion,
        peak_acceleration: Values | None = None,
        period: Values | None = None,
        restitution: Values = "momentum",
        *,
        scale: Values | None = None,
        flies: bool = False,
    ) -> Problem:
        """The checked problem; arguments as of `rocking.Block.response`.

        `flies`: the strength is not read, its vertical acceleration may reach -g.
        """
        if isinstance(restitution, str) and restitution != "momentum":
            restitution = spread_restitution(body, restitution)
        given: dict[str, Any]
        if isinstance(motion, Record):
            reject_given("a record: state `scale`", peak_acceleration=peak_acceleration, period=period)
            given = {"scale": 1.0 if scale is None else scale}
        else:
            motion = as_pulse(motion)
            if scale is not None:
                reject_given("a pulse: state `peak_acceleration`", scale=scale)
            given = {"peak_acceleration": peak_acceleration, "period": period}
            for name in given:
                if given[name] is None:
                    needed("a pulse", **{name: None})
        one = body.is_block and are_numbers(*given.values(), restitution)
        eta = None
        if not (isinstance(restitution, str) and restitution == "momentum"):
            eta = checked_restitution(restitution, q.RESTITUTION.number if one else q.RESTITUTION.convert)
        stated = not isinstance(peak_acceleration, Real)
        if one:
            values: dict[str, Any] = {name: STRENGTHS[name].number(value) for name, value in given.items()}
            made = cls(body, motion, *_strength(motion, values), eta, values.get("scale", 1.0), unit_is_stated=stated)
            if not flies:
                made.reject_flight()
            return made
        values = {name: STRENGTHS[name].convert(value) for name, value in given.items()}
        peak, times = _strength(motion, values)
        if eta is not None:
            given["restitution"], values["restitution"] = restitution, eta
        broadcast({**body.parameters, **given}, [*body.parameters.values(), *values.values()])
        arguments = {name: value for name, value in (body.parameters | values).items() if value.size}
        index = index_of(*given.values()) or body.index
        return cls(body, motion, peak, times, eta, values.get("scale", 1.0), arguments, index, stated)

    @cached_property
    def is_block(self) -> bool:
        """Whether it is one block with numbers for its arguments, which is solved in groups."""
        return self.body.is_block and isinstance(self.peak_acceleration, float)

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Broadcast shape of the bodies and the arguments; () for one body under one motion."""
        if self.is_block:
            return ()
        eta = np.shape(self.restitution)
        return np.broadcast_shapes(self.body.shape, np.shape(self.peak_acceleration), np.shape(self.period), eta)

    @cached_property
    def kinds(self) -> frozenset[str]:
        """The kinds of responses, as of `rocking._model.fields.KINDS`."""
        motion = "record" if isinstance(self.motion, Record) else "pulse"
        return frozenset((motion, "block" if self.is_block else "edges", *(["many"] if self.shape else [])))

    @property
    def block(self) -> AbstractBlock:
        """The body, where it is a block."""
        if not isinstance(self.body, AbstractBlock):
            raise InvalidArgumentError("body", self.body, "a block")
        return self.body

    @property
    def pulse(self) -> AbstractPulse:
        """The motion, where it is a pulse."""
        if isinstance(self.motion, Record):
            raise InvalidArgumentError("motion", self.motion, "a pulse")
        return self.motion

    @property
    def duration(self) -> Any:
        """Duration of the motion [s]; of the half sine and the rectangular pulse half a period, of the sine one."""
        motion = self.motion
        if isinstance(motion, Record):
            return motion.duration
        return (motion.end - motion.start) / (2.0 * math.pi) * self.period

    @property
    def warnings(self) -> list[str]:
        """Warnings: a peak acceleration without unit that was probably meant in g; remarks on the record."""
        if isinstance(self.motion, Record):
            return [*self.motion.remarks]
        a, uplift = float(self.peak_acceleration), float(self.body.uplift_acceleration)
        if self.unit_is_stated or not a < uplift < a * STANDARD_GRAVITY:
            return []
        text = f"peak_acceleration = {a:.4g} m/s2 is below the uplift acceleration {uplift:.4g} m/s2"
        return [f"{text}; if it was meant in g, write '{a:.4g} g'"]

    @cached_property
    def groups(self) -> dict[str, Any]:
        """Of one block: groups, restitution and alpha of the equation, keyword arguments of `peak_response`."""
        block = self.block
        eta = block.inelastic_restitution if self.restitution is None else self.restitution
        if isinstance(self.motion, Record):
            return record_groups(self.motion, block, self.scale, eta)
        return {
            "slenderness": block.uplift_acceleration / self.peak_acceleration,  # (5.3)
            "frequency_ratio": frequency_ratio_of(block, self.period),
            "restitution": eta,
            "alpha": block.equation_alpha,
        }

    @cached_property
    def cells(self) -> NDArray[np.void]:
        """The cells `BODY_CELL` of the solver (size,), not to be changed."""
        body, right, left = self.body, self.body.right, self.body.left
        if body.is_linear:
            allowed = "solved with numbers, not arrays: its equation of motion is linear"
            raise InvalidArgumentError("body", body.description, allowed)
        for name, edge in (("right", right), ("left", left)):
            in_range(f"alpha of the {name} edge", edge.alpha, q.SMALLEST_ALPHA, q.ALPHA.upper, unit="rad")
            in_range(f"restitution of the {name} edge", edge.restitution, -math.inf, 1.0, closed="right")
        p = right.frequency_parameter
        if isinstance(self.motion, Record):
            in_range("frequency_parameter", p, *frequency_parameter_range(self.motion), unit="rad/s")
        else:
            q.FREQUENCY_RATIO.convert(2.0 * math.pi / (self.period * p))
        etas = [edge.restitution if self.restitution is None else self.restitution for edge in (right, left)]
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
        for side, (name, edge) in enumerate((("right", right), ("left", left))):
            slenderness = body.gravity * edge.resistance / self.peak_acceleration  # (5.3); infinite against a wall
            in_range(f"slenderness of the {name} edge", np.minimum(slenderness, 1.0), q.SLENDERNESS.lower, math.inf)
            cells["slenderness"][..., side] = slenderness
            cells["eta"][..., side] = np.maximum(etas[side], 0.0)  # departs from (2.4) where that is negative
        for name, value in body.restraint.items():
            cells[name] = value
        return cells.ravel()

    @property
    def vertical_scale(self) -> Array:
        """Factor of the vertical component of a record, over the standard gravity [-]; 0 without one."""
        if not isinstance(self.motion, Record) or self.motion.vertical is None:
            return np.zeros(())
        scale = self.peak_acceleration / self.motion.peak_acceleration
        return np.asarray(scale * (STANDARD_GRAVITY / self.body.gravity))

    def solve(
        self, threads: int | None = None, stop: StopFlag | None = None
    ) -> tuple[Response | BoundedResponse, Array | None]:
        """The response in groups, and what differs from edge to edge, as of `rocking._solver.bodies.solve_motion`.

        Of one block under a pulse with a bound of its error, and nothing for each edge; refused where the vertical
        acceleration reaches -g.
        """
        motion, body = self.motion, self.body
        if not self.is_block:
            records, edges = self.solve_edges(threads, stop)
            fields: dict[str, Any] = {one.name: records[one.name].reshape(self.shape) for one in SOLVED_FIELDS}
            return Response(**fields, pulse=motion.name, motion=motion, body=body), edges
        if isinstance(motion, Record):
            return record_response(motion, **self.groups, stop=stop, body=body), None
        return self.solve_with_bound(threads, stop), None

    def solve_with_bound(self, threads: int | None = None, stop: StopFlag | None = None) -> BoundedResponse:
        """The response of one block to a pulse in groups, with a bound of its error."""
        groups = self.groups
        s, w, alpha = groups["slenderness"], groups["frequency_ratio"], groups["alpha"]
        low, high = q.SLENDERNESS.lower, q.FREQUENCY_RATIO.upper
        if not (low < s < math.inf and q.FREQUENCY_RATIO.lower < w < high and not 0.0 < alpha < q.SMALLEST_ALPHA):
            q.SLENDERNESS.convert(s)
            q.FREQUENCY_RATIO.convert(w)
            in_range("alpha", alpha or q.ALPHA.upper, q.SMALLEST_ALPHA, q.ALPHA.upper, unit="rad")
        return solve_checked(self.pulse, s, w, groups["restitution"], alpha, self.body, threads, stop)

    def solve_edges(self, threads: int | None = None, stop: StopFlag | None = None) -> tuple[NDArray[np.void], Array]:
        """`rocking._solver.bodies.solve_motion` of `cells`; refused where the vertical acceleration reaches -g."""
        self.reject_flight()
        return solve_motion(self.motion, self.cells, threads, stop)

    def solver(self, index: int = 0, stop: StopFlag | None = None) -> Solve:
        """One of the bodies as a `Solve`: slenderness over that of uplift, `rate` of the cell; the rest is not read."""
        cell: KernelRecord = self.cells[index]
        level = cell["slenderness"].min() * (1.0 + cell["prestress"])
        uplift, vertical = cell["slenderness"] / level, cell["vertical"] * level  # at uplift

        def solve(slenderness: Array, omega: Array, eta: Array, _alpha: Array) -> tuple[NDArray[np.void], Array]:
            cells = np.repeat(cell, eta.size)
            cells["rate"], cells["slenderness"] = omega, slenderness[:, None] * uplift
            cells["vertical"] = vertical / slenderness
            records, edges = solve_motion(self.motion, cells, None, stop)
            return records, outcome_margin_of(records, edges, cells)

        return solve

    def body_motion(
        self, duration: float | None = None, stop: StopFlag | None = None, index: int = 0, **changed: float
    ) -> BodyMotion:
        """The motion of one of the bodies over time, up to a duration [s] or 8/p after the ground motion.

        Of one block with other groups where some are `changed`, and without a duration.
        """
        motion = self.motion
        if self.is_block:
            build: Callable[..., BodyMotion] = build_record_motion if isinstance(motion, Record) else build_motion
            return build(motion, **self.groups | changed, stop=stop)
        self.reject_flight()
        cell: KernelRecord = self.cells[index : index + 1].copy()[0]
        edges, place = (self.body.right, self.body.left), np.unravel_index(index, self.shape)

        def own(values: Array) -> float:
            return float(np.broadcast_to(values, self.shape)[place])

        inertia = own(edges[0].inertia_ratio), own(edges[1].inertia_ratio)
        tilt, p = own(self.body.tilt), own(edges[0].frequency_parameter)
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

    def reject_flight(self) -> None:
        """Refuse a factor of a record at which its vertical acceleration reaches -g."""
        motion, gravity = self.motion, self.body.gravity
        if not isinstance(motion, Record) or motion.vertical is None:
            return
        if self.is_block:
            reject_flight("scale", motion, self.scale, float(gravity))
            return
        scale = np.asarray(self.peak_acceleration / motion.peak_acceleration)
        for g in np.unique(gravity).tolist():
            reject_flight("scale", motion, float(np.max(scale, where=np.asarray(gravity == g), initial=0.0)), g)


def _strength(motion: AbstractPulse | Record, values: Mapping[str, Any]) -> tuple[Any, Any]:
    """Peak acceleration [m/s2] and period [s] of checked arguments."""
    if not isinstance(motion, Record):
        return values["peak_acceleration"], values["period"]
    scale = values["scale"]
    if isinstance(scale, float):
        return scale * motion.peak_acceleration, 1.0
    return np.asarray(scale * motion.peak_acceleration), np.ones(())  # the product of an array () is a float


def are_numbers(*arguments: Any) -> bool:
    """Whether each argument is one number or text or None."""
    for value in arguments:
        if type(value) not in (float, int, str) and np.ndim(getattr(value, "magnitude", value)):
            return False
    return True


def checked_restitution(restitution: Values, checked: Callable[..., Any] = q.RESTITUTION.convert) -> Any:
    """The coefficient of restitution: None for "momentum", else an array; or one number by `RESTITUTION.number`."""
    if isinstance(restitution, str) and restitution == "momentum":
        return None
    try:
        return checked(restitution)
    except InvalidArgumentError as error:
        raise InvalidArgumentError("restitution", error.value, f"momentum, or {error.allowed}") from None


def spread_restitution(body: AbstractBody, restitution: Any) -> Any:
    """The restitution as it is; of "kalliontzis(k=...)" the numbers of a body with two equal edges."""
    share = impact_share(restitution) if isinstance(restitution, str) and restitution != "momentum" else None
    if share is None:
        return restitution
    right, left = body.right, body.left
    if np.any(right.blocked | left.blocked) or not np.all(right.restitution == left.restitution):
        raise InvalidArgumentError(
            "restitution", restitution, "momentum or a number for a body with two different edges"
        )
    return spread_impact(right.restitution, share)


def restitution_of(block: AbstractBlock, restitution: Scalar) -> float:
    """The coefficient of restitution [-]: the number, or for "momentum" the value (2.4) of the geometry."""
    eta = checked_restitution(spread_restitution(block, restitution), q.RESTITUTION.number)
    return float(block.inelastic_restitution if eta is None else eta)


def frequency_ratio_of(block: AbstractBlock, period: float) -> float:
    """omega = omega_g/p [-] of a period T_p [s]."""
    return float(2.0 * math.pi / period / block.frequency_parameter)


def period_of(block: AbstractBlock, frequency_ratio: float) -> float:
    """T_p [s] of a frequency ratio omega [-]."""
    return float(2.0 * math.pi / frequency_ratio / block.frequency_parameter)


def record_groups(record: Record, block: AbstractBlock, scale: float | Array, restitution: float) -> dict[str, Any]:
    """Keyword arguments of `record_response` for a block with the restitution eta under a record times `scale`, > 0."""
    return {
        "frequency_parameter": block.frequency_parameter,
        "slenderness": block.uplift_acceleration / (scale * record.peak_acceleration),
        "restitution": restitution,
        "alpha": block.equation_alpha,
        # w is over the standard gravity there
        "vertical_scale": None if record.vertical is None else STANDARD_GRAVITY / block.gravity * scale,
    }


def uplift_scale(record: Record, block: AbstractBlock) -> float:
    """Smallest factor of a record at which a block uplifts [-]; 1e6 where the vertical component prevents it longer.

    Uplift is where |a|/(g tan alpha) reaches 1 + w/g: at a sample, since both are linear between samples.
    """
    if record.vertical is None:
        return float(block.uplift_acceleration / record.peak_acceleration)
    excess = np.abs(record.acceleration) / block.uplift_acceleration - record.vertical / block.gravity
    largest = float(excess.max())
    return 1.0 / max(largest, 1.0 / q.HIGHEST_SCALE)


def search_range(record: Record, block: AbstractBlock, highest: float | None) -> tuple[float, float, bool]:
    """Factors of a record among which its outcomes are searched: uplift, the highest (ten times that without one).

    And whether the latter is that at which the vertical acceleration reaches -g.
    """
    lowest = uplift_scale(record, block)
    top = min(10.0 * lowest, q.HIGHEST_SCALE) if highest is None else highest
    limit = highest_vertical_scale(record, block.gravity)
    return lowest, min(top, limit), limit < top
