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
from workflow.claims.claim import CLOSE, SAME, SMALL, Claim, holding_range

WINDOW = 0.25  # distance from tau = 1 within which (3.27) is tested [-]


class Impacts(NamedTuple):
    """First impacts after the pulse, of blocks between (3.31) and (3.10); arrays of one shape."""

    time: Floats  # by (3.13) [-]
    velocity: Floats  # by (3.15) [-]
    integrated_time: Floats  # by the solver [-]
    integrated_velocity: Floats


def amplitudes_between(omega: Floats, share: Floats) -> Floats:
    """Amplitudes (share, omega) between (3.31) and (3.10), at which an impact follows the pulse."""
    return limit_amplitude(omega) * (case_2_amplitude(omega) / limit_amplitude(omega)) ** share[:, None]


def impacts_after_pulse() -> Impacts:
    """Impacts of blocks with 12 frequency ratios and 5 amplitudes, by formula and by the solver."""
    omega = np.linspace(0.5, 12.0, 12)
    a = amplitudes_between(omega, np.array([0.02, 0.25, 0.5, 0.75, 0.98]))
    time, velocity = case_1_2_impact_time(a, omega), case_1_2_impact_velocity(a, omega)
    integrated = np.array([_first_impact(*block) for block in np.broadcast(a, omega)]).reshape(*a.shape, 2)
    return Impacts(time, velocity, integrated[..., 0], integrated[..., 1])


def _first_impact(amplitude: float, omega: float) -> tuple[float, float]:
    """Time from uplift and velocity of the first impact by the solver."""
    eta = 0.1  # the block survives
    history = time_history(
        "sine", slenderness=1 / amplitude, frequency_ratio=omega, restitution=eta, duration=60.0, samples=2
    )
    impact = float(history.impact_time[0])
    after = int(np.abs(history.tau.values - impact).argmin())  # events are samples, with the state after them
    return impact - float(uplift_phase(amplitude)) / omega, float(np.abs(history.angular_velocity[after])) / eta


def exact_impact(impacts: Impacts) -> Iterator[Claim]:
    """(3.13) and (3.15) against the impacts that the solver finds."""
    for key, formula, solved in (
        ("impact-time-exact", impacts.time, impacts.integrated_time),
        ("impact-velocity", impacts.velocity, impacts.integrated_velocity),
    ):
        largest = float(np.abs(formula / solved - 1).max())
        yield Claim(key, largest < SAME, {"largest relative difference": largest})


def other_roots() -> Floats:
    """e^tau of the second root of (3.12), for blocks between (3.31) and (3.10)."""
    omega = np.linspace(0.5, 12.0, 231)
    a = amplitudes_between(omega, np.linspace(0.01, 0.99, 99))
    _, growing = after_pulse_coefficients(a, omega)
    return np.asarray((1 - case_1_2_impact_velocity(a, omega)) / growing)


def other_root(exponential: Floats) -> Claim:
    """Whether the second root of the quadratic in e^tau is ever a time after the uplift."""
    physical = exponential > 1.0
    return Claim("other-root", 1.0 - float(physical.mean()), {"share of positive times": float(physical.mean())})


class Curve(NamedTuple):
    """The curve from which case 1.1 overturns, over omega for each restitution: arrays (restitution, omega)."""

    frequency_ratio: Floats  # (omega,), equidistant
    restitution: Floats  # (restitution,)
    amplitude: Floats  # by (3.20) and (3.21), nan beyond the end of case 1.1
    semi_analytical: Floats  # by (3.30), nan where it has no solution with an impact inside the pulse
    impact_time: Floats  # on the exact curve
    approximate_time: Floats  # (3.29) there, nan where it is no real number

    @property
    def overturns(self) -> Flags:
        """Where case 1.1 overturns."""
        return np.isfinite(self.amplitude)


def case_1_1_curve(restitution: Sequence[float]) -> Curve:
    """The curve for omega from 1, by both conditions, with both times of impact."""
    eta, omega = np.array(restitution), np.linspace(1.0, 5.5, 181)
    exact = case_1_1_amplitudes(omega, eta[:, None]).lower
    overturns = np.isfinite(exact)
    a = np.where(overturns, exact, 2.0)
    semi = semi_analytical_amplitudes(omega, eta[:, None]).lower
    valid = overturns & np.isfinite(semi) & within_pulse(np.where(np.isfinite(semi), semi, 2.0), omega)
    return Curve(
        omega,
        eta,
        exact,
        np.where(valid, semi, np.nan),
        np.where(overturns, case_1_1_impact_time(a, omega), np.nan),
        np.where(overturns, ad_hoc_impact_time(a, omega), np.nan),
    )


def expansion_errors() -> dict[float, Floats]:
    """For some omega: the |(3.27) - sine| around tau = 1, the largest over the phases of uplift."""
    a = 1 / np.linspace(0.05, 0.99, 95)[:, None]
    tau = 1 + np.linspace(-WINDOW, WINDOW, 101)
    return {
        omega: np.abs(ad_hoc_sine(a, omega, tau) - np.sin(omega * tau + uplift_phase(a))).max(axis=0)
        for omega in (1.0, 2.0, 5.0)
    }


def approximation(curve: Curve, errors: Mapping[float, Floats]) -> Claim:
    """The steps of the semi-analytical approach, (3.23) to (3.29), for which the paper has adjectives."""
    missing = curve.overturns & ~np.isfinite(curve.approximate_time)
    numbers = {
        "p t of the impact from": float(np.nanmin(curve.impact_time)),
        "p t to": float(np.nanmax(curve.impact_time)),
    }
    numbers |= {f"abs((3.27) - sine) at omega {omega:g}": float(error.max()) for omega, error in errors.items()}
    numbers |= {
        "share of the curve without a real (3.29)": float(missing.sum() / curve.overturns.sum()),
        "(3.29) off by p t": float(np.nanmax(np.abs(curve.approximate_time - curve.impact_time))),
    }
    return Claim("ad-hoc-approximation", None, numbers)


def smallest_solutions(curve: Curve) -> Iterator[Claim]:
    """The curve of (3.30) against that of (3.20) and (3.21)."""
    omega, overturns = curve.frequency_ratio, curve.overturns
    difference = np.nan_to_num(np.abs(curve.semi_analytical / curve.amplitude - 1), nan=np.inf)
    solved = overturns & np.isfinite(difference)
    end = float(omega[overturns.any(axis=0)].max())
    numbers = {"largest": float(difference[solved].max()), "no solution": float((overturns & ~solved).sum())}
    for low in np.arange(1.0, end):
        band = solved & (omega >= low) & (omega <= low + 1.0)
        numbers[f"omega {low:g} to {min(low + 1.0, end):g}"] = float(difference[band].max(initial=0.0))
    for key, limit in (("minima-coincide", CLOSE), ("plots-agree", SMALL)):
        good = overturns & (difference <= limit)
        yield Claim(
            key,
            float(good.sum() / overturns.sum()),
            numbers,
            within=holding_range(good, {"omega": omega, "eta": curve.restitution[:, None]}, tested=overturns),
        )


def ends_of_case_1_1() -> tuple[Floats, Floats]:
    """Restitutions of the paper's figures, equidistant, and the omega at which case 1.1 ends."""
    eta = np.linspace(0.80, 0.96, 81)
    return eta, case_1_1_end(eta)


def end_of_case_1_1(restitution: Floats, end: Floats) -> Claim:
    """Where overturning by case 1.1 ends."""
    below = end <= 5.0
    return Claim(
        "no-case-1.1-above-5",
        float(below.mean()),
        {"first end": float(end[0]), "last end": float(end[-1])},
        within=holding_range(below, {"eta": restitution}),
    )
