"""Independent integration of a block under a recorded motion in multi-precision arithmetic.

The motion is linear between its samples and zero after the last. On each sample interval the solution, slender or
rigid, X Every impact is followed until the velocity is below `REST_VELOCITY`. It shares no code and no
method with the package: no exact arcs, no bound of chatter, no skipped samples, no early end.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from flint import arb, ctx

from reference.equation_of_motion import Motion, rigid_series, slender_series
from reference.exact_response import (
    CAPPED,
    NO_UPLIFT,
    OVERTURNED_AFTER_IMPACT,
    OVERTURNED_DIRECTLY,
    SAFE,
    ExactResponse,
    working_precision,
)
from reference.polynomial_roots import bernstein_bounds, roots

BITS = 170
REST_VELOCITY = 1e-22
"""Velocity after an impact [-] below which the block rests, where the ground does not lift it."""

STEP = 0.3
"""Longest Taylor step [tau]."""

RELATIVE_CHANGE = "1e-25"
"""Relative change of the amplitude for `amplification`."""


def integrate_record(
    acceleration: Sequence[float],
    time_step: float,
    *,
    frequency_parameter: float,
    slenderness: float,
    restitution: float,
    alpha: float | None = None,
    scale: arb | int = 1,
    max_impacts: int = 20_000,
) -> ExactResponse:
    """Return the response; floats are exact, the acceleration is divided by its largest absolute value.

    The ground acceleration is multiplied by `scale`. After `max_impacts` the outcome is CAPPED.
    """
    peak = arb(max(abs(a) for a in acceleration))
    factor = scale / (peak * arb(slenderness))
    ground = [(arb(a) * factor).mid() for a in acceleration]
    length = (arb(frequency_parameter) * arb(time_step)).mid()
    angle = None if alpha is None else arb(alpha)
    return _Integration(ground, length, arb(restitution), angle, max_impacts).run()


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
        if response.outcome != SAFE:
            return response, math.nan
        change = abs(moved.peak_rotation / response.peak_rotation - 1) / arb(RELATIVE_CHANGE)
        return response, float(change.mid())


class _Integration:
    """State of one integration: the interval `k`, the time `s` since its left end, z, v and the side of the block."""

    def __init__(self, ground: list[arb], length: arb, eta: arb, alpha: arb | None, max_impacts: int) -> None:
        self.ground, self.length, self.eta, self.alpha, self.max_impacts = ground, length, eta, alpha, max_impacts
        self.block = Motion(None, arb(1), arb(1), alpha)  # type: ignore[arg-type]  # for its energy only
        self.fallen = None if alpha is None else arb.pi() / (2 * alpha)
        self.k, self.s = 0, arb(0)
        self.z, self.v, self.side = arb(0), arb(0), 0
        self.at_crossing = False
        self.peak = arb(0)
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
        return self._close(NO_UPLIFT if response.uplift_time is None else SAFE)

    def _close(self, outcome: int) -> ExactResponse:
        response = self.response
        response.outcome = outcome
        response.exceeded_alpha = response.overturned or bool(self.peak > 1)
        if outcome in (NO_UPLIFT, SAFE):
            response.peak_rotation = self.peak
        return response

    def _u(self, k: int, s: arb) -> arb:
        return (self.ground[k] + (self.ground[k + 1] - self.ground[k]) * s / self.length).mid()

    def _uplift(self) -> bool:
        """From rest: move to the first time with |u| > 1, or return False."""
        if self.k >= len(self.ground) - 1:
            return False
        start = self._u(self.k, self.s)
        if abs(start) > 1:
            self.at_crossing, self.side = False, -1 if start > 0 else 1
        else:
            while self.k < len(self.ground) - 1 and not abs(self.ground[self.k + 1]) > 1:
                self.k, self.s = self.k + 1, arb(0)
            if self.k == len(self.ground) - 1:
                return False
            level = 1 if self.ground[self.k + 1] > 0 else -1
            rise = self.ground[self.k + 1] - self.ground[self.k]
            self.s = (self.length * (level - self.ground[self.k]) / rise).mid()
            self.at_crossing, self.side = True, -level
        self.z, self.v = arb(0), arb(0)
        return True

    def _step(self) -> str:
        """One Taylor step: "impact", "overturned", or "on" where neither is reached."""
        rest = (self.length - self.s).mid()
        size = rest if rest <= STEP else arb(STEP)
        force = self._u(self.k, self.s)
        zeros = 0 if self.z > 0 else 1 if self.v > 0 else 3 if self.at_crossing else 2
        if zeros == 1:
            restoring = float(1 + self.side * force)
            if restoring > 0.0 and 3.0 * float(self.v) / restoring < float(size):
                size = arb(3.0 * float(self.v) / restoring)
        slope = (self.ground[self.k + 1] - self.ground[self.k]) / self.length
        while True:
            series = self._expand(force, slope, size, self.at_crossing)
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
        self.z, self.v = _value(series, end), (_value(_slope(series), end) / size).mid()
        if impact is not None:
            self.s = (self.s + end * size).mid()
            return "impact"
        if whole:
            self.k, self.s = self.k + 1, arb(0)
        else:
            self.s = (self.s + size).mid()
        return "on"

    def _expand(self, force: arb, slope: arb, size: arb, at_crossing: bool) -> list[arb]:
        order, term = 8, 1.0
        while term > 2.0 ** (-ctx.prec - 8):
            order += 1
            term *= 2.0 * float(size) / (order - 8)
        push = [arb(0)] * (order + 1)
        push[0], push[1] = (-self.side * force).mid(), (-self.side * slope * size).mid()
        step_slope, square = (self.v * size).mid(), (size * size).mid()
        if self.alpha is None:
            return slender_series(self.z, step_slope, square, push, at_crossing)
        return rigid_series(self.z, step_slope, square, push, self.alpha, at_crossing)

    def _watch_peak(self, series: list[arb], end: arb, zeros: int) -> None:
        if bernstein_bounds(series, end)[1] < float(self.peak):
            return
        for x in [*roots(_slope(series)[max(zeros - 1, 0) :], end), end]:
            z = _value(series, x)
            if z > self.peak:
                self.peak = z

    def _impact(self) -> bool:
        """Apply the restitution; return whether the block rests."""
        response = self.response
        response.impacts += 1
        if response.first_impact_time is None:
            time = self.k * self.length + self.s
            response.first_impact_time = (time - response.uplift_time).mid()
            response.first_impact_velocity = (self.side * self.v).mid()
        self.side, self.z, self.v = -self.side, arb(0), abs(self.eta * self.v).mid()
        force = self._u(self.k, self.s)
        if abs(force) > 1:
            if self.v == 0:
                self.side = -1 if force > 0 else 1
            return False
        return bool(self.v < REST_VELOCITY)

    def _free_rocking(self) -> ExactResponse:
        """Decide the outcome after the last sample by energy."""
        block, response = self.block, self.response
        response.margin = block.barrier_excess(self.z, self.v)
        if response.margin > 0:
            return self._close(OVERTURNED_AFTER_IMPACT if response.impacts else OVERTURNED_DIRECTLY)
        if self.v > 0:
            self.peak = max(self.peak, block.turning_point(self.z, self.v).mid(), key=float)
        speed = abs(self.eta) * block.impact_speed(self.z, self.v)
        if speed > block.barrier_speed():
            response.impacts += 1
            return self._close(OVERTURNED_AFTER_IMPACT)
        self.peak = max(self.peak, block.turning_point(arb(0), speed).mid(), key=float)
        return self._close(SAFE)


def _slope(series: list[arb]) -> list[arb]:
    return [k * c for k, c in enumerate(series)][1:]


def _value(series: list[arb], x: arb) -> arb:
    total = arb(0)
    for c in reversed(series):
        total = total * x + c
    return total.mid()
