"""Independent integration of the rocking block, event by event, by long Taylor steps in multi-precision arithmetic.

It shares no code and no method with the package: one Taylor series for all pulses and both equations (no exact arcs),
events from the roots of the step's polynomial (`polynomial_roots`: none can be passed over), every impact simulated
down to a chatter of 1e-20. The working precision is `flint.ctx.prec`; use
`exact_response.working_precision` around calls.
"""

from __future__ import annotations

import math

from flint import arb, ctx

from reference.equation_of_motion import Motion
from reference.exact_pulses import exact_pulse, unit_crossings
from reference.exact_response import (
    CAPPED,
    NO_UPLIFT,
    OVERTURNED_AFTER_IMPACT,
    OVERTURNED_DIRECTLY,
    SAFE,
    ExactResponse,
)
from reference.polynomial_roots import bernstein_bounds, roots

CHATTER_LEFT = 1e-20
"""Rest is declared when all remaining flights together last less than this, in the pulse's and the block's time."""


def integrate(
    pulse: str,
    *,
    slenderness: arb | float,
    frequency_ratio: arb | float,
    restitution: arb | float,
    alpha: arb | float | None = None,
    cycles: float = 2.0,
    phase: float = 0.0,
    most_impacts: int = 20_000,
) -> ExactResponse:
    """Response of one block [all inputs dimensionless, alpha in rad]; floats are taken as exact.

    After `most_impacts` the outcome is CAPPED, unless the block was coming to rest by chatter.
    """
    shape = exact_pulse(pulse, cycles, phase)
    angle = None if alpha is None else arb(alpha)
    motion = Motion(shape, (1 / arb(slenderness)).mid(), arb(frequency_ratio), angle)
    return _Integration(motion, arb(restitution), most_impacts).run()


class _Integration:
    """State of one integration."""

    def __init__(self, motion: Motion, restitution: arb, most_impacts: int) -> None:
        self.motion, self.restitution, self.most_impacts = motion, restitution, most_impacts
        self.end = motion.duration.mid()
        start, omega = motion.pulse.start, motion.frequency_ratio
        self.uplifts = [((phi - start) / omega).mid() for phi in unit_crossings(motion.pulse, motion.amplitude)]
        self.order = 64 if motion.alpha is None else 44
        self.rate = motion.fastest_rate()
        self.step = (2.0 if motion.alpha is None else 0.7) / self.rate
        self.fallen_at = None if motion.alpha is None else arb.pi() / (2 * motion.alpha)
        self.tau, self.z, self.v, self.side = arb(0), arb(0), arb(0), 0
        self.peak = arb(0)
        self.answer = ExactResponse()

    def run(self) -> ExactResponse:
        answer = self.answer
        while self._wait_for_uplift():
            answer.uplifts += 1
            if answer.uplift_time is None:
                answer.uplift_time = self.tau
            fate = self._rock()
            if fate is not None:
                return self._close(fate)
            if self.tau >= self.end:
                return self._free_rocking()
            answer.chatter = True
        if answer.uplift_time is None:
            return self._close(NO_UPLIFT)
        answer.margin = arb(-1)
        return self._close(SAFE)

    def _close(self, outcome: int) -> ExactResponse:
        answer = self.answer
        answer.outcome = outcome
        answer.exceeded_alpha = answer.overturned or bool(self.peak > 1)
        if outcome in (NO_UPLIFT, SAFE):
            answer.peak_rotation = self.peak
        return answer

    def _wait_for_uplift(self) -> bool:
        """At rest at tau: move to the next time when |u| >= 1, if there is one."""
        ground = self.motion.ground(self.tau)
        self.crossing = not abs(ground) > 1
        if self.crossing:
            self.uplifts = [t for t in self.uplifts if t > self.tau]
            if not self.uplifts:
                return False
            self.tau = self.uplifts.pop(0)
            ground = self.motion.ground(self.tau)
        self.side = -1 if ground > 0 else 1
        self.z, self.v = arb(0), arb(0)
        return True

    def _rock(self) -> int | None:
        """From a start on one edge to rest (tau < end), to the pulse's end (tau = end), or to a fate."""
        while self.tau < self.end:
            zeros = 0 if self.z > 0 else 1 if self.v > 0 else 3 if self.crossing else 2
            series, length = self._expand(zeros)
            self.crossing = False
            impact = next(iter(roots(series[zeros:], length)), None)
            length = length if impact is None else impact
            if self._falls_during(series, length):
                return self._overturned()
            self._watch_peak(series, length, zeros)
            self._move(series, length)
            if impact is not None or (self.v < 0 and self.z <= self.rounding):
                if self._impact():
                    return None
                if self.answer.impacts >= self.most_impacts:
                    return CAPPED
            elif self._never_returns():
                return self._overturned()
        return None

    def _expand(self, zeros: int) -> tuple[list[arb], arb]:
        """Series from here in x = time/step, and the x up to which it holds and is wanted."""
        left = (self.end - self.tau).mid()
        step, order, short = self.step, self.order, False
        if zeros == 1:  # the next flight after an impact, thrown against a nearly constant acceleration
            pull = float(self._pull())
            if pull > 0:
                flight = 2.5 * float(self.v) / pull
                if flight < step:
                    step, short = flight, True
                    if flight * self.rate < 0.2:
                        order = min(order, 8 + int(ctx.prec * math.log(2) / -math.log(2 * flight * self.rate)))
        last = bool(left <= step)
        size = left if last else arb(step)
        series = self.motion.expand(self.tau, self.z, self.v, self.side, size, order, self.crossing)
        coarse = [abs(float(c)) for c in series]
        scale = max(coarse[1:]) * 2.0 ** (12 - ctx.prec)
        self.rounding = scale * 2.0**24  # a smaller z at the end of the step is the impact itself
        reach = min(((scale / c) ** (1.0 / k) for k, c in enumerate(coarse) if k > order - 4 and c > 0.0), default=2.0)
        self.size, self.last = size, last and reach >= 1.0
        if not short and not last:
            self.step = step * min(max(0.9 * reach, 0.1), 1.5)
        return series, arb(1) if reach >= 1.0 else arb(reach)

    def _pull(self) -> arb:
        """-z'' at z = 0."""
        ground = self.side * self.motion.ground(self.tau)
        alpha = self.motion.alpha
        return 1 + ground if alpha is None else (1 + ground) * alpha.sin() / alpha

    def _falls_during(self, series: list[arb], length: arb) -> bool:
        """|theta| reaches pi/2 while the pulse acts (rigid only)."""
        if self.fallen_at is None or bernstein_bounds(series, length)[1] < float(self.fallen_at):
            return False
        return bool(roots([series[0] - self.fallen_at, *series[1:]], length))

    def _never_returns(self) -> bool:
        """Slender: b = z + z' has b' = b - 1 - s u >= b - 1 - a: from b > 1 + a it grows for ever, whatever comes."""
        return self.motion.alpha is None and bool(self.z + self.v > 1 + self.motion.amplitude)

    def _overturned(self) -> int:
        self.answer.margin = abs(self.motion.barrier_excess(self.z, self.v)) + 1
        return OVERTURNED_AFTER_IMPACT if self.answer.impacts else OVERTURNED_DIRECTLY

    def _watch_peak(self, series: list[arb], length: arb, zeros: int) -> None:
        if bernstein_bounds(series, length)[1] < float(self.peak):
            return
        slope = [k * c for k, c in enumerate(series)][max(zeros, 1) :]
        for x in [*roots(slope, length), length]:
            z = _value(series, x)
            if z > self.peak:
                self.peak = z

    def _move(self, series: list[arb], x: arb) -> None:
        self.z = _value(series, x)
        self.v = (_value([k * c for k, c in enumerate(series)][1:], x) / self.size).mid()
        at_end = self.last and x == 1
        self.tau = self.end if at_end else (self.tau + x * self.size).mid()

    def _impact(self) -> bool:
        """Go on about the other edge (2.4); True if the block rests, at once or after a chatter too small to see."""
        answer, eta = self.answer, self.restitution
        answer.impacts += 1
        if answer.first_impact_time is None:
            answer.first_impact_time = (self.tau - answer.uplift_time).mid()
            answer.first_impact_velocity = (self.side * self.v).mid()
        if answer.slowest_impact is None or abs(self.v) < answer.slowest_impact:
            answer.slowest_impact = abs(self.v)
        self.side, self.z, self.v = -self.side, arb(0), abs(eta * self.v).mid()
        ground = self.motion.ground(self.tau)
        if abs(ground) > 1:
            if self.v == 0:
                self.side = -1 if ground > 0 else 1
            return False
        if self.v == 0:
            return True
        held = float(1 - abs(ground))
        loss = float(1 - eta)
        if loss == 0.0 or held == 0.0:
            return False
        remaining = 2.0 * float(self.v) / (held * loss) * self.rate * (1.0 + float(self.motion.amplitude))
        if self.motion.alpha is not None:
            remaining *= float(self.motion.alpha / self.motion.alpha.sin())
        left = CHATTER_LEFT if answer.impacts < self.most_impacts else 1e-6
        return remaining < left * held

    def _free_rocking(self) -> ExactResponse:
        """After the pulse energy decides: at most one impact matters."""
        motion, answer = self.motion, self.answer
        excess = motion.barrier_excess(self.z, self.v)
        if excess > 0:
            answer.margin = excess
            return self._close(OVERTURNED_AFTER_IMPACT if answer.impacts else OVERTURNED_DIRECTLY)
        if self.v > 0:
            self._raise_peak(motion.turning_point(self.z, self.v))
        speed = abs(self.restitution) * motion.impact_speed(self.z, self.v)
        beyond = speed / motion.barrier_speed() - 1
        answer.margin = excess if excess > beyond else beyond
        if beyond > 0:
            answer.impacts += 1
            return self._close(OVERTURNED_AFTER_IMPACT)
        self._raise_peak(motion.turning_point(arb(0), speed))
        return self._close(SAFE)

    def _raise_peak(self, z: arb) -> None:
        if z.mid() > self.peak:
            self.peak = z.mid()


def _value(series: list[arb], x: arb) -> arb:
    total = arb(0)
    for c in reversed(series):
        total = total * x + c
    return total.mid()
