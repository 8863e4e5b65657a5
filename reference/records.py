"""Independent integration of a body under a recorded motion in multi-precision arithmetic.

The motion, horizontal and vertical, is linear between its samples and zero after the last. The body is a block, or has
two different edges. On each sample interval the solution, slender or rigid, is a Taylor series of steps of at most
`STEP`, whose roots are isolated so that no impact and no peak is missed. Every impact is followed until the velocity is
below `REST_VELOCITY`. It shares no code and no method with the package: no exact arcs, no bound of chatter, no skipped
samples, no early end.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from flint import arb, ctx

from reference.equation_of_motion import Motion, rigid_series, slender_series
from reference.exact_response import (
    CAPPED,
    NO_UPLIFT,
    OVERTURNED_AFTER_IMPACT,
    OVERTURNED_DIRECTLY,
    RECOVERS,
    ExactResponse,
    working_precision,
)
from reference.polynomial_roots import bernstein_bounds, derivative, evaluate, roots

BITS = 170
REST_VELOCITY = 1e-22  # velocity after an impact [-] below which the block rests, where the ground does not lift it

STEP = 0.3  # longest Taylor step [tau]

RELATIVE_CHANGE = "1e-25"  # relative change of the amplitude for `amplification`


class Edge(NamedTuple):
    """The left edge of a body, in units of the right one: alpha_s/alpha, (p_s/p)^2, and the restitution eta_s."""

    ratio: float
    stiffness: float
    restitution: float


def integrate_record(
    acceleration: Sequence[float],
    time_step: float,
    *,
    frequency_parameter: float,
    slenderness: float,
    restitution: float,
    alpha: float | None = None,
    scale: arb | int = 1,
    vertical: Sequence[float] | None = None,
    left: Edge | None = None,
    one_sided: bool = False,
    max_impacts: int = 20_000,
) -> ExactResponse:
    """Return the response; floats are exact, the acceleration is divided by its largest absolute value.

    The horizontal ground acceleration is multiplied by `scale`; `vertical` is over g, upwards. `left` is the left edge
    where it is not like the right one; a `one_sided` body has none and rebounds on the right one. After `max_impacts`
    the outcome is CAPPED.
    """
    peak = arb(max(abs(a) for a in acceleration))
    factor = scale / (peak * arb(slenderness))
    ground = [(arb(a) * factor).mid() for a in acceleration]
    length = (arb(frequency_parameter) * arb(time_step)).mid()
    angle = None if alpha is None else arb(alpha)
    pressing = [1 + arb(w) for w in vertical] if vertical is not None else [arb(1)] * len(ground)
    edges = {side: _Edge(Edge(1.0, 1.0, restitution) if side == 1 or left is None else left, angle) for side in (1, -1)}
    return _Integration(ground, pressing, length, edges, angle, one_sided, max_impacts).run()


def response_and_amplification(
    acceleration: Sequence[float], time_step: float, bits: int = BITS, **groups: float | None
) -> tuple[ExactResponse, float]:
    """Return the response, and the relative change of its peak per relative change of the amplitude.

    The latter is infinite if the outcome changes, nan where the block does not rock and survive.
    """
    with working_precision(bits):
        response = integrate_record(acceleration, time_step, **groups)
        moved = integrate_record(acceleration, time_step, **groups, scale=1 + arb(RELATIVE_CHANGE))
        if response.outcome != moved.outcome:
            return response, math.inf
        if response.outcome != RECOVERS:
            return response, math.nan
        change = abs(moved.peak_rotation / response.peak_rotation - 1) / arb(RELATIVE_CHANGE)
        return response, float(change.mid())


class _Edge:
    """An edge: its `ratio`, `stiffness`, `eta`, tan(alpha_s)/tan(alpha), and the units of its energy."""

    def __init__(self, given: Edge, alpha: arb | None) -> None:
        self.ratio, self.stiffness, self.eta = (arb(value) for value in given)
        own = None if alpha is None else self.ratio * alpha
        self.slope = self.ratio if alpha is None or own is None else own.tan() / alpha.tan()
        self.block = Motion(None, arb(1), arb(1), own)  # type: ignore[arg-type]  # for its energy only
        self.speed = self.ratio * self.stiffness.sqrt()  # alpha_s p_s/(alpha p)


class _Integration:
    """State of one integration: the interval `k`, the time `s` since its left end, z, v and the side of the body."""

    def __init__(
        self,
        ground: list[arb],
        pressing: list[arb],
        length: arb,
        edges: dict[int, _Edge],
        alpha: arb | None,
        one_sided: bool,
        max_impacts: int,
    ) -> None:
        self.ground, self.pressing, self.length, self.edges = ground, pressing, length, edges
        self.alpha, self.max_impacts, self.sides = alpha, max_impacts, (1,) if one_sided else (1, -1)
        self.fallen = None if alpha is None else arb.pi() / (2 * alpha)
        self.k, self.s = 0, arb(0)
        self.z, self.v, self.side = arb(0), arb(0), 0
        self.at_crossing = False
        self.peaks = {1: arb(0), -1: arb(0)}
        self.response = ExactResponse()

    def run(self) -> ExactResponse:
        response = self.response
        last = len(self.ground) - 1
        while self._uplift():
            response.uplifts += 1
            if response.uplift_time is None:
                response.uplift_time = (self.k * self.length + self.s).mid()
            rests = False
            while self.k < last and not rests:
                ended = self._step()
                if ended == "overturned":
                    return self._close(OVERTURNED_AFTER_IMPACT if response.impacts else OVERTURNED_DIRECTLY)
                if ended == "impact":
                    if response.impacts >= self.max_impacts:
                        return self._close(CAPPED)
                    rests = self._impact()
            if not rests:
                return self._free_rocking()
            response.chatter = True
        return self._close(NO_UPLIFT if response.uplift_time is None else RECOVERS)

    def _close(self, outcome: int) -> ExactResponse:
        response = self.response
        response.outcome = outcome
        highest = max((self.peaks[side] / edge.ratio for side, edge in self.edges.items()), key=float)
        response.exceeded_alpha = response.overturned or bool(highest > 1)
        if outcome in (NO_UPLIFT, RECOVERS):
            response.peak_rotation, response.peaks = highest, (self.peaks[1], self.peaks[-1])
        return response

    def _at(self, samples: list[arb], s: arb) -> arb:
        return (samples[self.k] + (samples[self.k + 1] - samples[self.k]) * s / self.length).mid()

    def _restoring(self, side: int, u: arb, pressing: arb) -> arb:
        """q: the edge of this side is lifted off where it is negative."""
        return self.edges[side].slope * pressing + side * u

    def _lifted(self, s: arb) -> int:
        """The side of the rotation that the ground starts, 0 where it starts none."""
        u, pressing = self._at(self.ground, s), self._at(self.pressing, s)
        return next((side for side in self.sides if self._restoring(side, u, pressing) < 0), 0)

    def _uplift(self) -> bool:
        """From rest: move to the first time with q < 0 on an edge, or return False."""
        if self.k >= len(self.ground) - 1:
            return False
        side = self._lifted(self.s)
        self.at_crossing = side == 0
        # q is linear on an interval: an edge is lifted in the first one at whose end q < 0
        while side == 0 and self.k < len(self.ground) - 1:
            side = self._lifted(self.length)
            if side == 0:
                self.k, self.s = self.k + 1, arb(0)
        if side == 0:
            return False
        if self.at_crossing:
            k = self.k
            q0, q1 = (self._restoring(side, self.ground[n], self.pressing[n]) for n in (k, k + 1))
            self.s = (self.length * q0 / (q0 - q1)).mid()
        self.side = side
        self.z, self.v = arb(0), arb(0)
        return True

    def _step(self) -> str:
        """One Taylor step: "impact", "overturned", or "on" where neither is reached."""
        rest = (self.length - self.s).mid()
        size = rest if rest <= STEP else arb(STEP)
        force, pressing = self._at(self.ground, self.s), self._at(self.pressing, self.s)
        # the order of the zero of z at the start, as in `multiprecision`
        zeros = 0 if self.z > 0 else 1 if self.v > 0 else 3 if self.at_crossing else 2
        if zeros == 1:  # after an impact: a step just beyond the next one keeps the digits of a short flight
            restoring = float(self._restoring(self.side, force, pressing))
            if restoring > 0.0 and 3.0 * float(self.v) / restoring < float(size):
                size = arb(3.0 * float(self.v) / restoring)
        slope, rise = ((row[self.k + 1] - row[self.k]) / self.length for row in (self.ground, self.pressing))
        while True:
            series = self._expand(force, slope, (pressing, (rise * size).mid()), size, self.at_crossing)
            tail = max(abs(float(c)) for c in series[-4:])
            if tail <= max(abs(float(c)) for c in series[1:4]) * 2.0 ** (6 - ctx.prec):
                break
            size = (size / 2).mid()
        self.at_crossing = False
        whole = size == rest
        impact = next(iter(roots(series[zeros:], arb(1))), None)
        end = arb(1) if impact is None else impact
        if (
            self.fallen is not None
            and bernstein_bounds(series, end)[1] >= float(self.fallen)
            and roots([series[0] - self.fallen, *series[1:]], end)
        ):
            return "overturned"
        self._watch_peak(series, end, zeros)
        self.z, self.v = evaluate(series, end), (evaluate(derivative(series), end) / size).mid()
        if impact is not None:
            self.s = (self.s + end * size).mid()
            return "impact"
        if whole:
            self.k, self.s = self.k + 1, arb(0)
        else:
            self.s = (self.s + size).mid()
        return "on"

    def _expand(self, force: arb, slope: arb, vertical: tuple[arb, arb], size: arb, at_crossing: bool) -> list[arb]:
        edge = self.edges[self.side]
        order, term = 8, 1.0
        while term > 2.0 ** (-ctx.prec - 8):
            order += 1
            term *= 2.0 * float(size) / (order - 8)
        push = [arb(0)] * (order + 1)
        push[0], push[1] = (-self.side * force).mid(), (-self.side * slope * size).mid()
        step_slope, square = (self.v * size).mid(), (edge.stiffness * size * size).mid()
        if self.alpha is None:
            return slender_series(self.z, step_slope, square, push, at_crossing, edge.ratio, vertical)
        return rigid_series(self.z, step_slope, square, push, self.alpha, at_crossing, edge.ratio, vertical)

    def _watch_peak(self, series: list[arb], end: arb, zeros: int) -> None:
        if bernstein_bounds(series, end)[1] < float(self.peaks[self.side]):
            return
        for x in [*roots(derivative(series)[max(zeros - 1, 0) :], end), end]:
            z = evaluate(series, x)
            if z > self.peaks[self.side]:
                self.peaks[self.side] = z

    def _impact(self) -> bool:
        """Apply the restitution; return whether the block rests."""
        response = self.response
        response.impacts += 1
        if response.first_impact_time is None:
            time = self.k * self.length + self.s
            response.first_impact_time = (time - response.uplift_time).mid()
            response.first_impact_velocity = (self.side * self.v).mid()
        self.z, self.v = arb(0), abs(self.edges[self.side].eta * self.v).mid()
        self._change_side()
        lifted = self._lifted(self.s)
        if lifted != 0:  # the ground lifts an edge: no rest, and without velocity an uplift there
            if self.v == 0:
                self.side = lifted
            return False
        return bool(self.v < REST_VELOCITY)

    def _change_side(self) -> None:
        """The side of the flight after an impact: the other one, if there are two."""
        if len(self.sides) == 2:
            self.side = -self.side

    def _free_rocking(self) -> ExactResponse:
        """Decide the outcome after the last sample by energy, in the units of each edge.

        What comes back from an edge did not pass its barrier, so that two impacts decide.
        """
        response, edge = self.response, self.edges[self.side]
        z, v = self.z / edge.ratio, self.v / edge.speed
        response.margin = edge.block.barrier_excess(z, v)
        if response.margin > 0:
            return self._close(OVERTURNED_AFTER_IMPACT if response.impacts else OVERTURNED_DIRECTLY)
        if v > 0:
            self._reach(edge.block.turning_point(z, v))
        speed = edge.block.impact_speed(z, v)
        for impact in (1, 2):
            speed *= edge.eta * edge.speed
            self._change_side()
            edge = self.edges[self.side]
            speed /= edge.speed
            if speed > edge.block.barrier_speed():
                response.impacts += impact
                return self._close(OVERTURNED_AFTER_IMPACT)
            self._reach(edge.block.turning_point(arb(0), speed))
        return self._close(RECOVERS)

    def _reach(self, z: arb) -> None:
        """A peak on the present edge, in its units."""
        self.peaks[self.side] = max(self.peaks[self.side], (z * self.edges[self.side].ratio).mid(), key=float)
