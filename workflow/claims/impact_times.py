"""Claims of section 3 on the time of the first impact, exact (3.13) and approximate (3.23) to (3.30)."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from rocking._history.time_history import time_history
from rocking.paper.approximation import ad_hoc_impact_time, ad_hoc_sine, semi_analytical_amplitudes, within_pulse
from rocking.paper.motion import after_pulse_coefficients, uplift_phase
from rocking.paper.overturning import (
    case_1_1_amplitudes,
    case_1_1_end,
    case_1_1_impact_time,
    case_1_2_impact_time,
    case_1_2_impact_velocity,
    case_2_amplitude,
    limit_amplitude,
)
from workflow.claims.area import Flags, Floats
from workflow.claims.claim import ABOUT, CLOSE, FAIR, SAME, SMALL, Claim, Range, holding_range, percent

WINDOW = 0.25  # distance from tau = 1 within which (3.27) is tested [-]


class Impacts(NamedTuple):
    """First impacts after the pulse, of blocks between (3.31) and (3.10); arrays of one shape."""

    time: Floats  # by (3.13) [-]
    velocity: Floats  # by (3.15) [-]
    integrated_time: Floats  # by the solver [-]
    integrated_velocity: Floats


def impacts_after_pulse() -> Impacts:
    """Impacts of blocks with 12 frequency ratios and 5 amplitudes, by formula and by the solver."""
    omega = np.linspace(0.5, 12.0, 12)
    share = np.array([0.02, 0.25, 0.5, 0.75, 0.98])[:, None]
    a = limit_amplitude(omega) * (case_2_amplitude(omega) / limit_amplitude(omega)) ** share
    time, velocity = case_1_2_impact_time(a, omega), case_1_2_impact_velocity(a, omega)
    integrated = np.array([_first_impact(*one) for one in np.broadcast(a, omega)]).reshape(*a.shape, 2)
    return Impacts(time, velocity, integrated[..., 0], integrated[..., 1])


def _first_impact(amplitude: float, omega: float) -> tuple[float, float]:
    """Time from uplift and velocity of the first impact by the solver."""
    eta = 0.1  # the block survives
    history = time_history(
        "sine", slenderness=1 / amplitude, frequency_ratio=omega, restitution=eta, duration=60.0, samples=2
    )
    at = float(history.impact_time[0])
    after = int(np.abs(history.tau.values - at).argmin())  # events are samples, with the state after them
    return at - float(uplift_phase(amplitude)) / omega, float(np.abs(history.angular_velocity[after])) / eta


def exact_impact(impacts: Impacts) -> Iterator[Claim]:
    """(3.13) and (3.15) against the impacts that the solver finds."""
    time = float(np.abs(impacts.time / impacts.integrated_time - 1).max())
    velocity = float(np.abs(impacts.velocity / impacts.integrated_velocity - 1).max())
    blocks = f"{impacts.time.size} blocks between (3.31) and (3.10), omega 0.5 to 12"
    yield Claim(
        key="impact-time-exact",
        fails_if="another root of (3.12) is the impact, or an impact comes earlier",
        place="section 3b, (3.13)",
        printed="(3.13) is the exact time of the impact that follows the pulse",
        criterion=f"it is the time that the solver finds, within a relative {SAME:.0e}; {blocks}",
        found=f"largest relative difference {time:.0e}",
        share=time < SAME,
        numbers={"largest_relative_difference": time},
    )
    yield Claim(
        key="impact-velocity",
        fails_if="D0* is not that of (3.9), as with the second line as printed",
        place="section 3b, (3.15)",
        printed="the velocity before that impact is sqrt(1 - D0*)",
        criterion=f"it is the velocity that the solver finds, within a relative {SAME:.0e}; the same blocks",
        found=f"largest relative difference {velocity:.0e}",
        share=velocity < SAME,
        numbers={"largest_relative_difference": velocity},
    )


def other_roots() -> Floats:
    """e^tau of the second root of (3.12), for blocks between (3.31) and (3.10)."""
    omega = np.linspace(0.5, 12.0, 231)
    share = np.linspace(0.01, 0.99, 99)[:, None]
    a = limit_amplitude(omega) * (case_2_amplitude(omega) / limit_amplitude(omega)) ** share
    _, growing = after_pulse_coefficients(a, omega)
    return np.asarray((1 - case_1_2_impact_velocity(a, omega)) / growing)


def other_root(exponential: Floats) -> Iterator[Claim]:
    """Whether the second root of the quadratic in e^tau is ever a time after the uplift."""
    physical = exponential > 1.0
    yield Claim(
        key="other-root",
        fails_if="the block passes theta = 0 twice after the uplift",
        place="section 3b, below (3.12)",
        printed="the other solution of (3.12) is negative and lacks physical meaning",
        criterion="e^tau of the second root is below 1, so that its time is negative or not real; "
        f"{exponential.size} blocks between (3.31) and (3.10), omega 0.5 to 12",
        found=f"at {percent(1 - float(physical.mean()))} of them; of all, its logarithm is not real at "
        f"{percent(float((exponential <= 0).mean()))}",
        share=1.0 - float(physical.mean()),
        numbers={"share_positive": float(physical.mean())},
    )


class Curve(NamedTuple):
    """The curve from which case 1.1 overturns, over omega for each restitution: arrays (restitution, omega)."""

    frequency_ratio: Floats  # (omega,), equidistant
    restitution: Floats  # (restitution,)
    amplitude: Floats  # by (3.20) and (3.21), nan beyond the end of case 1.1
    semi_analytical: Floats  # by (3.30), nan where it has no solution with an impact inside the pulse
    impact_time: Floats  # on the exact curve
    approximate_time: Floats  # (3.29) there, nan where it is no real number

    @property
    def known(self) -> Flags:
        """Where case 1.1 overturns."""
        return np.isfinite(self.amplitude)

    def within(self, good: Flags) -> Range | None:
        """The range of omega or eta in which all known points are good."""
        parameters = {"omega": self.frequency_ratio, "eta": self.restitution[:, None]}
        return holding_range(good, parameters, tested=self.known)


def case_1_1_curve(restitution: Sequence[float]) -> Curve:
    """The curve for omega from 1, by both conditions, with both times of impact."""
    eta, omega = np.array(restitution), np.linspace(1.0, 5.5, 181)
    exact = case_1_1_amplitudes(omega, eta[:, None]).lower
    known = np.isfinite(exact)
    a = np.where(known, exact, 2.0)
    semi = semi_analytical_amplitudes(omega, eta[:, None]).lower
    valid = known & np.isfinite(semi) & within_pulse(np.where(np.isfinite(semi), semi, 2.0), omega)
    return Curve(
        omega,
        eta,
        exact,
        np.where(valid, semi, np.nan),
        np.where(known, case_1_1_impact_time(a, omega), np.nan),
        np.where(known, ad_hoc_impact_time(a, omega), np.nan),
    )


def _on_curve(curve: Curve) -> str:
    eta = curve.restitution
    return (
        f"along the curve of case 1.1, eta {eta.min():.2f} to {eta.max():.2f}, omega from 1 to its end, share of omega"
    )


def impact_about_one(curve: Curve) -> Iterator[Claim]:
    """(3.23): the impact comes at tau = 1."""
    near = curve.known & (np.abs(curve.impact_time - 1) <= ABOUT)
    share = float(near.sum() / curve.known.sum())
    yield Claim(
        key="impact-at-1/p",
        fails_if="the time depends on omega along the curve",
        place="section 3c, (3.23)",
        printed="the block returns to impact about 1/p after uplift",
        criterion=f"p t of the impact is between {1 - ABOUT:g} and {1 + ABOUT:g}; {_on_curve(curve)}",
        found=f"on {percent(share)}; p t rises from {np.nanmin(curve.impact_time):.2f} "
        f"to {np.nanmax(curve.impact_time):.2f} at omega = 1",
        share=share,
        within=curve.within(near),
        numbers={"largest": float(np.nanmax(curve.impact_time))},
    )


def expansion_errors() -> dict[float, tuple[Floats, Floats]]:
    """For some omega: tau - 1, and the largest |(3.27) - sine| over the phases of uplift."""
    a = 1 / np.linspace(0.05, 0.99, 95)[:, None]
    offset = np.linspace(-WINDOW, WINDOW, 101)
    return {
        omega: (
            offset,
            np.abs(ad_hoc_sine(a, omega, 1 + offset) - np.sin(omega * (1 + offset) + uplift_phase(a))).max(axis=0),
        )
        for omega in (1.0, 2.0, 5.0)
    }


def ad_hoc_function(errors: Mapping[float, tuple[Floats, Floats]]) -> Iterator[Claim]:
    """(3.27) near tau = 1, for small and for intermediate omega."""
    window = f"abs(tau - 1) up to {WINDOW:g}, any phase of uplift"
    slow = np.concatenate([errors[1.0][1], errors[2.0][1]])
    offset, five = errors[5.0]
    good = five <= FAIR
    yield Claim(
        key="ad-hoc-sine-slow",
        fails_if="the terms of third order that are left out are not small",
        place="section 3c, below (3.27), figure S1",
        printed="(3.27) is excellent for small omega < 2",
        criterion=f"it differs from the sine by at most {percent(SMALL)} of its amplitude at omega = 1 and 2; {window}",
        found=f"largest difference {percent(float(errors[1.0][1].max()))} at omega = 1, "
        f"{percent(float(errors[2.0][1].max()))} at omega = 2",
        share=float((slow <= SMALL).mean()),
        numbers={"largest_at_1": float(errors[1.0][1].max()), "largest_at_2": float(errors[2.0][1].max())},
    )
    yield Claim(
        key="ad-hoc-sine-intermediate",
        fails_if="the terms of third order that are left out are not small",
        place="section 3c, below (3.27), figure S1",
        printed="(3.27) is satisfactory around tau = 1 for intermediate omega of about 5",
        criterion=f"it differs from the sine by at most {percent(FAIR)} of its amplitude at omega = 5; {window}",
        found=f"on {percent(float(good.mean()))}; largest difference {percent(float(five.max()))}",
        share=float(good.mean()),
        within=holding_range(good, {"tau - 1 from": offset}),
        numbers={"largest": float(five.max())},
    )


def approximate_time(curve: Curve) -> Iterator[Claim]:
    """(3.29) against the exact time of impact; where it has no real root it does not hold."""
    omega, known = curve.frequency_ratio, curve.known
    error = np.abs(curve.approximate_time / curve.impact_time - 1)
    missing = known & ~np.isfinite(curve.approximate_time)
    good = known & (np.nan_to_num(error, nan=np.inf) <= SMALL)
    share = float(good.sum() / known.sum())
    first = np.array([omega[row].min() for row in (known & ~missing)])
    without = (
        f"it has no real value below omega = {first.min():.2f} to {first.max():.2f}, depending on eta, and just above"
    )
    worst = float(np.nanmax(np.abs(curve.approximate_time - curve.impact_time)))
    yield Claim(
        key="ad-hoc-time",
        fails_if="(3.29) has no real value, or the impact is far from p t = 1",
        place="section 3c, (3.29)",
        printed="(3.29) approximates the time of impact",
        criterion=f"within {percent(SMALL)}; {_on_curve(curve)}",
        found=f"on {percent(share)}; " + (without if missing.any() else "it") + f" is off by up to p t = {worst:.1f}",
        share=share,
        within=curve.within(good),
        numbers={
            "share_without_value": float(missing.sum() / known.sum()),
            "first_value_from": float(first.min()),
            "last_value_from": float(first.max()),
            "largest": worst,
        },
    )


def smallest_solutions(curve: Curve) -> Iterator[Claim]:
    """The curve of (3.30) against that of (3.20) and (3.21)."""
    omega, known = curve.frequency_ratio, curve.known
    difference = np.abs(curve.semi_analytical / curve.amplitude - 1)
    good = known & (np.nan_to_num(difference, nan=np.inf) <= CLOSE)
    share = float(good.sum() / known.sum())
    missing = known & ~np.isfinite(curve.semi_analytical)
    lost = np.array([omega[row].min() for row in missing if row.any()])
    end = float(omega[known.any(axis=0)].max())
    known_difference = np.where(known, difference, -np.inf)
    bands = {
        f"{low:g} to {min(low + 1.0, end):g}": float(
            np.nanmax(known_difference[:, (omega >= low) & (omega <= low + 1.0)])
        )
        for low in np.arange(1.0, end)
    }
    yield Claim(
        key="minima-coincide",
        fails_if="the error of (3.29) moves the smallest solution",
        place="section 3c, figure 3",
        printed="the smallest solution of (3.30) coincides with that of (3.20) and (3.21)",
        criterion=f"within {percent(CLOSE)} in a; {_on_curve(curve)}",
        found=f"on {percent(share)}; largest difference "
        + ", ".join(f"{percent(value)} for omega {band}" for band, value in bands.items())
        + (
            f"; close to the ends of the curves, from omega = {lost.min():.2f} to {lost.max():.2f} on, depending on "
            "eta, (3.30) has no solution inside the pulse"
            if missing.any()
            else ""
        ),
        share=share,
        within=curve.within(good),
        numbers={"largest": max(bands.values())} | {f"omega {band}": value for band, value in bands.items()},
    )


def ends_of_case_1_1() -> tuple[Floats, Floats]:
    """Restitutions of the paper's figures, equidistant, and the omega at which case 1.1 ends."""
    eta = np.linspace(0.80, 0.96, 81)
    return eta, case_1_1_end(eta)


def end_of_case_1_1(restitution: Floats, end: Floats) -> Iterator[Claim]:
    """Where overturning by case 1.1 ends."""
    below = end <= 5.0
    yield Claim(
        key="no-case-1.1-above-5",
        fails_if="case 1.1 reaches beyond omega = 5 for one of the restitutions",
        place="section 3c, below (3.27)",
        printed="for omega > 5 the block does not overturn by case 1.1",
        criterion=f"case 1.1 ends below omega = 5; eta {restitution[0]:.2f} to {restitution[-1]:.2f}, as in figure 8",
        found=f"it ends at omega = {end[0]:.2f} for eta = {restitution[0]:.2f} and at {end[-1]:.2f} for "
        f"{restitution[-1]:.2f}",
        share=float(below.mean()),
        within=holding_range(below, {"eta": restitution}),
        numbers={"end_first": float(end[0]), "end_last": float(end[-1])},
    )
