"""Independent integration of the rocking block, event by event, with long Taylor steps in multi-precision arithmetic.

It shares no code and no method with the package: one Taylor series for all pulses and both equations (no exact arcs),
events from the roots of the polynomial of a step (`polynomial_roots`: none can be missed), every impact simulated down
to a remaining chatter of 1e-20. The working precision is `flint.ctx.prec`; use `exact_response.working_precision`.
"""

from __future__ import annotations

import math

from flint import arb, ctx

from reference.equation_of_motion import Motion, Restraint
from reference.exact_pulses import exact_pulse, unit_crossings
from reference.exact_response import (
    CAPPED,
    NO_UPLIFT,
    OVERTURNED_AFTER_IMPACT,
    OVERTURNED_DIRECTLY,
    RECOVERS,
    ExactResponse,
)
from reference.polynomial_roots import bernstein_bounds, derivative, evaluate, roots

CHATTER_LEFT = 1e-20
"""Rest is declared when all remaining flights together last less than this, in the time scales of pulse and block."""


def integrate(
    pulse: str,
    *,
    slenderness: arb | float,
    frequency_ratio: arb | float,
    restitution: arb | float,
    alpha: arb | float | None = None,
    cycles: float = 2.0,
    phase: float = 0.0,
    max_impacts: int = 20_000,
    stiffness: arb | float = 0.0,
    prestress: arb | float = 0.0,
    damping: arb | float = 0.0,
) -> ExactResponse:
    """Return the response of one block [all inputs dimensionless, alpha in rad]; floats are taken as exact.

    After `max_impacts` the outcome is CAPPED, unless the block was coming to rest by chatter. `stiffness`, `prestress`
    and `damping` are kappa, sigma and zeta of `equation_of_motion`.
    """
    shape = exact_pulse(pulse, cycles, phase)
    angle = None if alpha is None else arb(alpha)
    restraint = Restraint(arb(stiffness), arb(prestress), arb(damping))
    motion = Motion(shape, (1 / arb(slenderness)).mid(), arb(frequency_ratio), angle)
    if restraint == (0, 0, 0):
        return _Integration(motion, arb(restitution), max_impacts).run()
    return _RestrainedIntegration(motion._replace(restraint=restraint), arb(restitution), max_impacts).run()


class _Integration:
    """State of one integration."""

    def __init__(self, motion: Motion, restitution: arb, max_impacts: int) -> None:
        self.motion, self.restitution, self.max_impacts = motion, restitution, max_impacts
        self.end = motion.duration.mid()
        start, omega = motion.pulse.start, motion.frequency_ratio
        crossings = unit_crossings(motion.pulse, (motion.amplitude / motion.level).mid())
        self.uplifts = [((phi - start) / omega).mid() for phi in crossings]
        self.order = 64 if motion.alpha is None else 44
        self.rate = motion.max_rate()
        self.step = (2.0 if motion.alpha is None else 0.7) / self.rate
        self.overturning_rotation = None if motion.alpha is None else arb.pi() / (2 * motion.alpha)
        self.tau, self.z, self.v, self.side = arb(0), arb(0), arb(0), 0
        self.peak = arb(0)
        self.response = ExactResponse()

    def run(self) -> ExactResponse:
        response = self.response
        while self._wait_for_uplift():
            response.uplifts += 1
            if response.uplift_time is None:
                response.uplift_time = self.tau
            outcome = self._integrate_motion()
            if outcome is not None:
                return self._close(outcome)
            if self.tau >= self.end:
                return self._free_rocking()
            response.chatter = True
        if response.uplift_time is None:
            return self._close(NO_UPLIFT)
        response.margin = arb(-1)
        return self._close(RECOVERS)

    def _close(self, outcome: int) -> ExactResponse:
        response = self.response
        response.outcome = outcome
        response.exceeded_alpha = response.overturned or bool(self.peak > 1)
        if outcome in (NO_UPLIFT, RECOVERS):
            response.peak_rotation = self.peak
        return response

    def _wait_for_uplift(self) -> bool:
        """At rest at tau: move to the next time with |u| >= level; return False if there is none."""
        ground = self.motion.ground(self.tau)
        self.crossing = not abs(ground) > self.motion.level
        if self.crossing:  # held down now: on to the next time at which |u| rises through the level, 1 if free
            self.uplifts = [t for t in self.uplifts if t > self.tau]
            if not self.uplifts:
                return False
            self.tau = self.uplifts.pop(0)
            ground = self.motion.ground(self.tau)
        self.side = -1 if ground > 0 else 1
        self.z, self.v = arb(0), arb(0)
        return True

    def _integrate_motion(self) -> int | None:
        """Integrate from uplift to rest (tau < end), to the end of the pulse (tau = end), or to an outcome.

        Return the outcome, None if it is not decided yet.
        """
        while self.tau < self.end:
            # order of the zero of z at the start, which is divided out: 0 in flight, 1 after an impact, 2 for an uplift
            # beyond |u| = 1, 3 for one through it, where the acceleration is zero too
            zeros = 0 if self.z > 0 else 1 if self.v > 0 else 3 if self.crossing else 2
            series, length = self._expand(zeros)
            self.crossing = False
            impact = next(iter(roots(series[zeros:], length)), None)
            length = length if impact is None else impact
            if self._overturns_during(series, length):
                return self._overturned()
            self._watch_peak(series, length, zeros)
            self._move(series, length)
            # a root within rounding of the end of the step is not returned: there z tells
            if impact is not None or (self.v < 0 and self.z <= self.rounding):
                if self._impact():
                    return None
                if self.response.impacts >= self.max_impacts:
                    return CAPPED
            elif self._never_returns():
                return self._overturned()
        return None

    def _expand(self, zeros: int) -> tuple[list[arb], arb]:
        """Return the series from here in x = time/step, and the x up to which it is accurate and needed."""
        remaining_limit = (self.end - self.tau).mid()
        step, order, short = self.step, self.order, False
        if zeros == 1:  # the flight after an impact, under a nearly constant acceleration
            restoring = float(self._restoring_acceleration())
            if restoring > 0:
                flight = 2.5 * float(self.v) / restoring
                if flight < step:
                    step, short = flight, True
                    if flight * self.rate < 0.2:
                        order = min(order, 8 + int(ctx.prec * math.log(2) / -math.log(2 * flight * self.rate)))
        last = bool(remaining_limit <= step)
        size = remaining_limit if last else arb(step)
        series = self.motion.expand(self.tau, self.z, self.v, self.side, size, order, self.crossing)
        # the series is exact as far as its last four terms are below rounding
        coarse = [abs(float(c)) for c in series]
        scale = max(coarse[1:]) * 2.0 ** (12 - ctx.prec)
        self.rounding = scale * 2.0**24  # a smaller z at the end of the step is the impact itself
        reach = min(((scale / c) ** (1.0 / k) for k, c in enumerate(coarse) if k > order - 4 and c > 0.0), default=2.0)
        self.size, self.last = size, last and reach >= 1.0
        if not short and not last:
            self.step = step * min(max(0.9 * reach, 0.1), 1.5)
        return series, arb(1) if reach >= 1.0 else arb(reach)

    def _restoring_acceleration(self) -> arb:
        """Return -z'' at z = 0."""
        ground = self.side * self.motion.ground(self.tau)
        alpha, level = self.motion.alpha, self.motion.level
        return level + ground if alpha is None else (level + ground) * alpha.sin() / alpha

    def _overturns_during(self, series: list[arb], length: arb) -> bool:
        """Return whether |theta| reaches pi/2 during the pulse (rigid only)."""
        if self.overturning_rotation is None or bernstein_bounds(series, length)[1] < float(self.overturning_rotation):
            return False
        return bool(roots([series[0] - self.overturning_rotation, *series[1:]], length))

    def _never_returns(self) -> bool:
        """Return whether the slender block cannot return.

        b = z + z' has b' = b - 1 - s u >= b - 1 - a: from b > 1 + a it grows, whatever the ground does.
        """
        return self.motion.alpha is None and bool(self.z + self.v > 1 + self.motion.amplitude)

    def _overturned(self) -> int:
        self.response.margin = abs(self.motion.barrier_excess(self.z, self.v)) + 1
        return OVERTURNED_AFTER_IMPACT if self.response.impacts else OVERTURNED_DIRECTLY

    def _watch_peak(self, series: list[arb], length: arb, zeros: int) -> None:
        if bernstein_bounds(series, length)[1] < float(self.peak):
            return
        # z is largest at a root of z' or at the end
        slope = derivative(series)[max(zeros - 1, 0) :]
        for x in [*roots(slope, length), length]:
            z = evaluate(series, x)
            if z > self.peak:
                self.peak = z

    def _move(self, series: list[arb], x: arb) -> None:
        self.z = evaluate(series, x)
        self.v = (evaluate(derivative(series), x) / self.size).mid()
        at_end = self.last and x == 1
        self.tau = self.end if at_end else (self.tau + x * self.size).mid()

    def _impact(self) -> bool:
        """Apply the impact (2.4); return True if the block comes to rest, at once or after a negligible chatter."""
        response, eta = self.response, self.restitution
        response.impacts += 1
        if response.first_impact_time is None:
            response.first_impact_time = (self.tau - response.uplift_time).mid()
            response.first_impact_velocity = (self.side * self.v).mid()
        if response.slowest_impact is None or abs(self.v) < response.slowest_impact:
            response.slowest_impact = abs(self.v)
        self.side, self.z, self.v = -self.side, arb(0), abs(eta * self.v).mid()
        ground = self.motion.ground(self.tau)
        if (
            abs(ground) > self.motion.level
        ):  # one edge is destabilised: the block does not rest, and without velocity uplifts there
            if self.v == 0:
                self.side = -1 if ground > 0 else 1
            return False
        if self.v == 0:
            return True
        reserve = float(self.motion.level - abs(ground))
        loss = float(1 - eta)
        if loss == 0.0 or reserve == 0.0:
            return False
        # all remaining flights together last about 2 v/(reserve loss)
        remaining = 2.0 * float(self.v) / (reserve * loss) * self.rate * (1.0 + float(self.motion.amplitude))
        if self.motion.alpha is not None:
            remaining *= float(self.motion.alpha / self.motion.alpha.sin())
        remaining_limit = CHATTER_LEFT if response.impacts < self.max_impacts else 1e-6
        return remaining < remaining_limit * reserve

    def _free_rocking(self) -> ExactResponse:
        """Decide the outcome after the pulse by energy: at most one impact matters."""
        motion, response = self.motion, self.response
        excess = motion.barrier_excess(self.z, self.v)
        if excess > 0:
            response.margin = excess
            return self._close(OVERTURNED_AFTER_IMPACT if response.impacts else OVERTURNED_DIRECTLY)
        if self.v > 0:
            self._raise_peak(motion.turning_point(self.z, self.v))
        speed = abs(self.restitution) * motion.impact_speed(self.z, self.v)
        beyond = speed / motion.barrier_speed() - 1
        response.margin = excess if excess > beyond else beyond
        if beyond > 0:
            response.impacts += 1
            return self._close(OVERTURNED_AFTER_IMPACT)
        self._raise_peak(motion.turning_point(arb(0), speed))
        return self._close(RECOVERS)

    def _raise_peak(self, z: arb) -> None:
        if z.mid() > self.peak:
            self.peak = z.mid()


class _RestrainedIntegration(_Integration):
    """The same with tendon and damper, for which the energy does not decide after the pulse."""

    def __init__(self, motion: Motion, restitution: arb, max_impacts: int) -> None:
        super().__init__(motion, restitution, max_impacts)
        self.restraint: Restraint = motion.restraint or Restraint(arb(0), arb(0), arb(0))
        self.equilibrium = self._unstable_equilibrium()

    def _unstable_equilibrium(self) -> arb | None:
        """Return the z above which the moments at rest increase z; pi/2 if there is none below; None if there is none.

        They are -(sin(alpha) cos(t) - (cos(alpha) - kappa) sin(t) + sigma sin(alpha) cos(t/2)), t = alpha z, in the
        slender limit -(1 + sigma) + (1 - kappa) z: with one zero, at most, below pi/2.
        """
        stiffness, prestress, _ = self.restraint
        alpha = self.motion.alpha
        if alpha is None:
            return (1 + prestress) / (1 - stiffness) if stiffness < 1 else None
        low, high = arb(0), arb.pi() / 2

        def restoring(t: arb) -> arb:
            tendon = prestress * alpha.sin() * (t / 2).cos() + stiffness * t.sin()
            return (alpha - t).sin() + tendon

        if restoring(high) < 0:
            for _ in range(ctx.prec):
                middle = ((low + high) / 2).mid()
                low, high = (middle, high) if restoring(middle) > 0 else (low, middle)
        return (high / alpha).mid()

    def _growing_part(self, z: arb, v: arb) -> arb | None:
        """Return W = z' + (1 - kappa)/lambda (z - z*) of a slender block, W' = lambda W - s u; None if it has none."""
        if self.motion.alpha is not None or self.equilibrium is None:
            return None
        return v + (1 - self.restraint.stiffness) / self._growth_rate() * (z - self.equilibrium)

    def _growth_rate(self) -> arb:
        stiffness, _, damping = self.restraint
        return (damping * damping + 1 - stiffness).sqrt() - damping

    def _never_returns(self) -> bool:
        growing = self._growing_part(self.z, self.v)
        return growing is not None and bool(self._growth_rate() * growing > self.motion.amplitude)

    def _overturned(self) -> int:
        self.response.margin = arb(1)
        return OVERTURNED_AFTER_IMPACT if self.response.impacts else OVERTURNED_DIRECTLY

    def _free_rocking(self) -> ExactResponse:
        """Continue without ground motion up to the escape, or to the first peak.

        Each later peak is lower: energy only falls, and below the equilibrium the potential rises with z. The response
        has no margin.
        """
        self.motion = self.motion._replace(amplitude=arb(0))
        self.rate = self.motion.max_rate()
        self.step = (2.0 if self.motion.alpha is None else 0.7) / self.rate
        self.order = 64 if self.motion.alpha is None else 44
        self.end = self.tau + arb("1e9")
        outcome = OVERTURNED_AFTER_IMPACT if self.response.impacts else OVERTURNED_DIRECTLY
        while True:
            if self._escapes():
                return self._close(outcome)
            zeros = 0 if self.z > 0 else 1
            if zeros == 1 and self.v <= 0:
                return self._close(RECOVERS)
            series, length = self._expand(zeros)
            impact = next(iter(roots(series[zeros:], length)), None)
            length = length if impact is None else impact
            self._watch_peak(series, length, zeros)
            rises = self.v > 0
            self._move(series, length)
            if impact is not None:
                if rises:
                    return self._close(RECOVERS)
                self.z, self.v = arb(0), abs(self.restitution * self.v).mid()
                if self._escapes():
                    self.response.impacts += 1
                    return self._close(OVERTURNED_AFTER_IMPACT)
                outcome = OVERTURNED_AFTER_IMPACT
            elif rises and self.v <= 0 and (self.equilibrium is None or self.z < self.equilibrium):
                return self._close(RECOVERS)

    def _escapes(self) -> bool:
        """Return whether the block overturns in this flight, without ground motion; it may not be decided yet."""
        growing = self._growing_part(self.z, self.v)
        if growing is not None:
            return bool(growing > 0)
        return self.equilibrium is not None and bool(self.z >= self.equilibrium and self.v >= 0)
