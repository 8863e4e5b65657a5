"""Bodies under a pulse or a record in SI units; both components of a record have the same factor.

One body is an array of one: all are solved by their two edges. `Problem.of` checks what a user gives, once: below it
there are arrays.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
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
from rocking._base.errors import InvalidArgumentError, broadcast, in_range
from rocking._base.units import Scalar, Values
from rocking._boundary.search import Solve
from rocking._excitation.motion import stated_values
from rocking._excitation.pulses import AbstractPulse, GroundMotion, Motion, as_motion
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale, reject_flight
from rocking._history.motion import FREE_DURATION, BodyMotion, motion_of_body
from rocking._model.block import AbstractBlock
from rocking._model.body import AbstractBody
from rocking._model.checks import impact_share, spread_impact
from rocking._model.labelled import Index, index_of
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import Record as KernelRecord
from rocking._solver.bodies import outcome_margin_of, solve, solve_with_bound
from rocking._solver.state import BODY_CELL

STRENGTHS = {one.name: one for one in (q.PEAK_ACCELERATION, q.PERIOD, q.SCALE)}


ONE, ZERO = np.ones(()), np.zeros(())


@dataclass(frozen=True, eq=False)
class Problem(EqualByValue):
    """Bodies under a ground motion; arrays that broadcast, of one body under one motion of shape ()."""

    body: AbstractBody  # one body or an array of them
    motion: GroundMotion  # the ground motion, a record without its factor
    strength: Array  # peak acceleration of a pulse [m/s2], factor of a record, of both its components [-], > 0
    period: Array  # T_p = 2 pi/omega_g of a pulse, > 0; 1 for a record. `duration` is how long the motion lasts [s]
    restitution: Array | None  # eta of every impact [-], [0, 1]; None: by momentum, 0 where that is negative
    # the arguments that were given, before broadcasting, for the coordinates of exports
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
    ) -> Problem:
        """The checked problem; arguments as of `rocking.Block.response`."""
        motion = as_motion(motion)
        stated = {"peak_acceleration": peak_acceleration, "period": period, "scale": scale}
        given = stated_values(motion, motion.arguments, **stated)
        values = {name: STRENGTHS[name].convert(value) for name, value in given.items()}
        eta = checked_restitution(spread_restitution(body, restitution))
        if eta is not None:
            given["restitution"], values["restitution"] = restitution, eta
        sizes = body.parameters
        broadcast({**sizes, **given}, [*sizes.values(), *values.values()])
        return cls(
            body,
            motion,
            strength=values[motion.strength.name],
            period=values.get("period", ONE),
            restitution=eta,
            arguments={name: value for name, value in (sizes | values).items() if value.size},
            index=index_of(*given.values()) or body.index,
            unit_is_stated=not isinstance(peak_acceleration, Real),
        )

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Broadcast shape of the bodies and the arguments; () for one body under one motion."""
        given = [self.strength, self.period, *([] if self.restitution is None else [self.restitution])]
        return np.broadcast_shapes(self.body.shape, *map(np.shape, given))

    @cached_property
    def kinds(self) -> frozenset[str]:
        """The kinds of responses, as of `rocking._model.fields.KINDS`."""
        return frozenset((self.motion.kind, "block" if self.body.moves_as_block else "edges"))

    @cached_property
    def peak_acceleration(self) -> Array:
        """Largest horizontal acceleration [m/s2]."""
        return np.asarray(self.strength * self.motion.unit_acceleration)

    @property
    def block(self) -> AbstractBlock:
        """The body, where it moves as a block."""
        if not isinstance(self.body, AbstractBlock):
            raise InvalidArgumentError("body", self.body, "a block")
        return self.body

    @property
    def pulse(self) -> AbstractPulse:
        """The motion, where it is a pulse."""
        if not isinstance(self.motion, AbstractPulse):
            raise InvalidArgumentError("motion", self.motion, "a pulse")
        return self.motion

    @property
    def duration(self) -> Any:
        """Duration of the motion [s]; of the half sine and the rectangular pulse half a period, of the sine one."""
        return self.motion.duration_at(self.period)

    @property
    def warnings(self) -> list[str]:
        """Warnings: a peak acceleration without unit that was probably meant in g; remarks on the motion."""
        texts = [*self.motion.remarks]
        a, uplift = float(self.peak_acceleration), float(self.body.uplift_acceleration)
        if not self.unit_is_stated and a < uplift < a * STANDARD_GRAVITY:
            low = f"peak_acceleration = {a:.4g} m/s2 is below the uplift acceleration {uplift:.4g} m/s2"
            texts.append(f"{low}; if it was meant in g, write '{a:.4g} g'")
        return texts

    @cached_property
    def groups(self) -> dict[str, Any]:
        """Of one block: groups, restitution and alpha of the equation, keyword arguments of `peak_response`."""
        block = self.block
        groups = {
            "slenderness": block.uplift_acceleration / float(self.peak_acceleration),  # (5.3)
            "restitution": float(self.restitutions[0]),
            "alpha": block.equation_alpha,
        }
        if self.motion.rate is q.FREQUENCY_RATIO:
            return groups | {"frequency_ratio": frequency_ratio_of(block, float(self.period))}
        vertical = None if self.motion.vertical is None else float(self.vertical_scale)
        return groups | {"frequency_parameter": block.frequency_parameter, "vertical_scale": vertical}

    @property
    def restitutions(self) -> tuple[Array, Array]:
        """Restitution eta of impacts that leave the right and the left edge [-]."""
        if self.restitution is not None:
            return self.restitution, self.restitution
        right, left = self.body.right, self.body.left
        return np.maximum(right.restitution, 0.0), np.maximum(left.restitution, 0.0)  # departs from (2.4) below 0

    @cached_property
    def cells(self) -> NDArray[np.void]:
        """The cells `BODY_CELL` of the solver (size,), not to be changed."""
        body, right, left = self.body, self.body.right, self.body.left
        edges = {"": right} if left is right else {" of the right edge": right, " of the left edge": left}
        for name, edge in edges.items():
            in_range(f"alpha{name}", edge.alpha, q.SMALLEST_ALPHA, q.ALPHA.upper, unit="rad")
            in_range(f"restitution{name}", edge.restitution, -math.inf, 1.0, closed="right")
        p = right.frequency_parameter
        cells = np.zeros(self.shape, BODY_CELL)
        cells["rate"] = self.motion.rate_at(p, self.period)
        cells["vertical"] = self.vertical_scale
        cells["alpha"] = 0.0 if body.is_linear else right.alpha
        cells["ratio"] = left.alpha / right.alpha
        cells["stiffness"] = (left.frequency_parameter / p) ** 2
        for side, name in enumerate(edges):
            slenderness = body.uplift_accelerations[side] / self.peak_acceleration  # (5.3); infinite against a wall
            in_range(f"slenderness{name}", np.minimum(slenderness, 1.0), q.SLENDERNESS.lower, math.inf)
            cells["slenderness"][..., side] = slenderness
        if len(edges) == 1:
            cells["slenderness"][..., 1] = cells["slenderness"][..., 0]
        for side, eta in enumerate(self.restitutions):
            cells["eta"][..., side] = eta
        for name, value in body.restraint.items():
            cells[name] = value
        return cells.ravel()

    @property
    def vertical_scale(self) -> Array:
        """Factor of the vertical component of a record, over the standard gravity [-]; 0 without one."""
        if self.motion.vertical is None:
            return ZERO
        return np.asarray(self.strength * (STANDARD_GRAVITY / self.body.gravity))

    def solve(
        self, threads: int | None = None, stop: StopFlag | None = None, *, error_bound: bool = False
    ) -> tuple[NDArray[np.void], Array, Array | None]:
        """`rocking._solver.bodies.solve` of `cells`, with a bound of the error of the peaks where it is asked for.

        Refused where the vertical acceleration reaches -g.
        """
        self.reject_flight()
        if error_bound:
            return solve_with_bound(self.motion, self.cells, threads, stop)
        return *solve(self.motion, self.cells, threads, stop), None

    def solver(self, index: int = 0, stop: StopFlag | None = None) -> Solve:
        """One of the bodies as a `Solve`: slenderness over that of uplift, `rate` of the cell; the rest is not read."""
        cell: KernelRecord = self.cells[index]
        level = cell["slenderness"].min() * (1.0 + cell["prestress"])
        uplift, vertical = cell["slenderness"] / level, cell["vertical"] * level  # at uplift

        def solve_at(slenderness: Array, omega: Array, eta: Array, _alpha: Array) -> tuple[NDArray[np.void], Array]:
            cells = np.repeat(cell, eta.size)
            cells["rate"], cells["slenderness"] = omega, slenderness[:, None] * uplift
            cells["vertical"] = vertical / slenderness
            records, edges = solve(self.motion, cells, None, stop)
            return records, outcome_margin_of(records, edges, cells)

        return solve_at

    def body_motion(self, duration: float | None = None, stop: StopFlag | None = None, index: int = 0) -> BodyMotion:
        """The motion of one of the bodies over time, up to a duration [s] or 8/p after the ground motion."""
        self.reject_flight()
        cell: KernelRecord = self.cells[index : index + 1].copy()[0]
        right, left, place = self.body.right, self.body.left, np.unravel_index(index, self.shape)

        def value_of(values: Array | float) -> float:
            return float(np.broadcast_to(values, self.shape)[place])

        p, tilt = value_of(right.frequency_parameter), value_of(self.body.tilt)
        inertia = value_of(right.inertia_ratio), value_of(left.inertia_ratio)
        horizon = FREE_DURATION if duration is None else p * duration
        if duration is None:
            horizon += p * value_of(self.duration)
        return motion_of_body(self.motion, cell, horizon, stop, inertia_ratio=inertia, tilt=tilt)

    def reject_flight(self) -> None:
        """Refuse a factor of a record at which its vertical acceleration reaches -g."""
        if self.motion.vertical is None:
            return
        gravity = np.asarray(self.body.gravity)
        for g in np.unique(gravity).tolist():
            highest = float(np.max(self.strength, where=gravity == g, initial=0.0))
            reject_flight("scale", self.motion, highest, g)


def checked_restitution(restitution: Values) -> Array | None:
    """The coefficient of restitution: None for "momentum", else an array."""
    if isinstance(restitution, str) and restitution == "momentum":
        return None
    try:
        return q.RESTITUTION.convert(restitution)
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
    eta = checked_restitution(spread_restitution(block, restitution))
    return q.RESTITUTION.number(block.inelastic_restitution if eta is None else eta)


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
