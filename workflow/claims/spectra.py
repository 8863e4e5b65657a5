"""Claims of section 4a on peak rotation: the closed form (4.13) and the scale law (4.16) for restitution."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from rocking._history.time_history import time_history
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking.paper.overturning import case_1_2_impact_velocity, case_2_amplitude, limit_amplitude
from rocking.paper.peak import case_1_2_peak, small_peak
from rocking.paper.scale_law import largest_deviation, restitution_exponent
from workflow.claims.area import LAW, Flags, Floats, node_areas, share_of_area
from workflow.claims.claim import SAME, SMALL, Claim, Range, holding_range
from workflow.claims.impact_times import amplitudes_between

OCTAVES = ((0.5, 1.0), (1.0, 2.0), (2.0, 4.0), (4.0, 8.0), (8.0, 15.0))
"""Ranges of omega in which the time of the peak is compared [-]."""

DISTANCES = ((0.0, 0.05), (0.05, 0.1), (0.1, 0.2), (0.2, 0.3))
"""Ranges of the distance in 1/a from (3.31) in which the error of (4.13) is compared [-]."""

SLOW_IMPACT = 0.3  # largest eta v that is considered small [-]


class Spectra(NamedTuple):
    """Slender blocks under the sine on a grid, for several restitutions: arrays (restitution, slenderness, omega)."""

    restitution: Floats  # (restitution,)
    slenderness: Floats  # (slenderness,)
    frequency_ratio: Floats  # (omega,)
    peak: Floats  # theta_max/alpha by the solver, nan where overturned
    outcome: np.ndarray
    mode: np.ndarray  # arc of the peak, `peak_mode`
    closed: Floats  # (4.13), nan where it has no real root

    @property
    def after_pulse(self) -> Flags:
        """Where the first impact follows the pulse, above (3.31) and below (3.10)."""
        a, omega = 1 / self.slenderness[:, None], self.frequency_ratio
        return np.broadcast_to((a > limit_amplitude(omega)) & (a < case_2_amplitude(omega)), self.peak.shape)

    @property
    def survives(self) -> Flags:
        """Where the block uplifts and survives."""
        return np.asarray(self.outcome == Outcome.RECOVERS)

    @property
    def areas(self) -> Floats:
        """Area of each node, broadcast over restitution."""
        return np.broadcast_to(node_areas(self.slenderness, self.frequency_ratio), self.peak.shape)

    def within(self, good: Flags, tested: Flags) -> Range | None:
        """The range of 1/a or omega in which all that was tested is good."""
        parameters = {"1/a": self.slenderness[:, None], "omega": self.frequency_ratio}
        return holding_range(good, parameters, tested=tested, weights=self.areas[0])


def spectra_of(cubes: Sequence[xr.Dataset]) -> Spectra:
    """The slender layer of the spectrum cubes of the sine, in ascending order of restitution."""
    ordered = [cube.sel(alpha=0.0) for cube in sorted(cubes, key=lambda cube: float(cube.restitution))]
    eta = np.array([float(one.restitution) for one in ordered])
    s, omega = ordered[0].slenderness.values, ordered[0].frequency_ratio.values
    peak, outcome, mode = (
        np.stack([one[name].values for one in ordered]) for name in ("peak_rotation", "outcome", "peak_mode")
    )
    closed = case_1_2_peak(1 / s[:, None], omega, eta[:, None, None])
    return Spectra(eta, s, omega, peak, outcome, mode, closed)


def closed_form(spectra: Spectra) -> Claim:
    """(4.13) against the solver where the first impact follows the pulse."""
    with np.errstate(invalid="ignore"):
        error = np.abs(spectra.closed / spectra.peak - 1)
    region = spectra.after_pulse & spectra.survives
    exact = region & (np.nan_to_num(error, nan=np.inf) < SAME)
    later = region & (spectra.mode == 3)  # the peak is reached in free rocking after one impact
    within = Range("the largest rotation comes after that impact", share_of_area(later, region, spectra.areas))
    return Claim(
        "spectrum-exact",
        share_of_area(exact, region, spectra.areas),
        {"peak before the impact": share_of_area(region & ~exact & ~later, region, spectra.areas)},
        within=within if exact[later].all() else None,
    )


def time_of_peak(spectra: Spectra) -> Iterator[Claim]:
    """When the largest rotation is reached where the first impact follows the pulse, and the two roots of (4.12)."""
    region = spectra.after_pulse & spectra.survives
    between = spectra.mode == 1  # reached in free rocking before any impact
    yield Claim(
        "time-of-peak",
        float((~between)[region].mean()) if region.any() else np.nan,
        {"nodes": int(region.sum()), "between": int((region & between).sum())},
        within=spectra.within(~between, region),
    )
    later = region & (spectra.mode == 3) & np.isfinite(spectra.closed)
    other, peak = 2 - spectra.closed[later], spectra.peak[later]  # 1 + and 1 - the square root of (4.12)
    yield Claim(
        "positive-root",
        float(((other > 1) & (peak < 1)).mean()) if peak.size else np.nan,
        {"nodes": peak.size},
        identity=True,
    )


def no_real_root(spectra: Spectra) -> Claim:
    """Whether (4.13) has no real root exactly where the solver finds that the block overturns."""
    region = spectra.after_pulse
    equal = np.isnan(spectra.closed) == (spectra.outcome >= Outcome.OVERTURNED_DIRECTLY)
    return Claim(
        "no-real-root",
        share_of_area(equal, region, spectra.areas),
        {"different": int((region & ~equal).sum()), "nodes": int(region.sum())},
        within=spectra.within(equal, region),
    )


def peak_after_pulse(spectra: Spectra) -> Claim:
    """Whether the largest rotation comes after the pulse as omega grows."""
    region = spectra.after_pulse & spectra.survives
    free = spectra.mode % 2 == 1  # reached in free rocking
    omega = spectra.frequency_ratio
    shares = {}
    for low, high in OCTAVES:
        band = region & (omega >= low) & (omega < high)
        if band.any():
            shares[f"share, omega {low:g} to {high:g}"] = share_of_area(free, band, spectra.areas)
    values = list(shares.values())
    return Claim("peak-after-pulse", float(np.mean([np.all(np.diff(values) >= 0), values[-1] > 0.5])), shares)


def approximation_near_limit(spectra: Spectra) -> Claim:
    """Below (3.31) the error of (4.13) by distance from that curve."""
    omega = spectra.frequency_ratio
    distance = np.broadcast_to(spectra.slenderness[:, None] - 1 / limit_amplitude(omega), spectra.peak.shape)
    with np.errstate(invalid="ignore"):
        error = np.abs(spectra.closed / spectra.peak - 1)
    valid = spectra.survives & np.isfinite(error) & (omega > 2)
    medians = {
        f"median {low:g} to {high:g}": float(np.median(error[valid & (distance >= low) & (distance < high)]))
        for low, high in DISTANCES
    }
    return Claim("approximation-near-limit", float((np.diff(list(medians.values())) > 0).mean()), medians)


class SlowImpacts(NamedTuple):
    """Blocks whose first impact follows the pulse and is slow, arrays of one shape."""

    speed: Floats  # eta v, by (3.15)
    peak: Floats  # theta_max/alpha after the impact by the solver
    leading: Floats  # (4.14), corrected


def slow_impacts() -> SlowImpacts:
    """Blocks under short pulses that rotate furthest after the impact, eta v up to `SLOW_IMPACT`."""
    omega, eta = np.geomspace(15.0, 150.0, 60), np.array([0.80, 0.85, 0.90, 0.96])[:, None, None]
    a = amplitudes_between(omega, np.linspace(0.02, 0.98, 25))
    response = peak_response("sine", slenderness=1 / a, frequency_ratio=omega, restitution=eta)
    speed = eta * case_1_2_impact_velocity(a, omega)
    chosen = (response.peak_mode == 3) & (speed <= SLOW_IMPACT)
    return SlowImpacts(speed[chosen], response.peak_rotation[chosen], small_peak(a, omega, eta)[chosen])


def leading_term(slow: SlowImpacts) -> Claim:
    """(4.14), corrected, against the peaks of the solver for small velocities after the impact."""
    error = np.abs(slow.leading / slow.peak - 1)
    return Claim(
        "leading-term",
        float((error <= SMALL).mean()) if error.size else np.nan,
        {"largest": float(error.max(initial=0.0)), "blocks": error.size},
        within=holding_range(error <= SMALL, {"eta v": slow.speed}),
    )


def scale_law(spectra: Spectra) -> Iterator[Claim]:
    """(4.16): deviation of the peaks from proportionality to eta squared, and one spectrum for all restitutions."""
    eta, s = spectra.restitution, spectra.slenderness[:, None]
    reference = float(eta[np.argmin(np.abs(eta - 0.9))])
    survives = np.isfinite(spectra.peak).all(axis=0) & spectra.survives.all(axis=0)
    peaks = np.where(survives, spectra.peak, np.nan)
    error, exponent = largest_deviation(peaks, eta, reference=reference), restitution_exponent(peaks, eta)
    after = survives & spectra.after_pulse[0]
    parts = {
        "first impact after the pulse": after,
        "first impact within it, 1/a below 0.85": survives & ~after & (s < 0.85),
        "1/a from 0.85": survives & (s >= 0.85),
    }
    areas = spectra.areas[0]
    good = np.nan_to_num(error, nan=np.inf) <= LAW
    share, within = share_of_area(good, survives, areas), spectra.within(good, survives)
    numbers = {f"share, {name}": share_of_area(good, part, areas) for name, part in parts.items()}
    for name, part in parts.items():
        numbers[f"median exponent, {name}"] = float(np.nanmedian(exponent[part])) if part.any() else np.nan
    yield Claim("scale-law", share, numbers, within=within)
    overturns = spectra.outcome >= Outcome.OVERTURNED_DIRECTLY
    depends = overturns.any(axis=0) & ~overturns.all(axis=0)
    yield Claim(
        "one-spectrum",
        share,
        {"outcome depends on eta": share_of_area(depends, np.ones_like(depends), areas)},
        within=within,
    )


def damping(spectra: Spectra) -> Claim:
    """Whether the peak never rises as restitution falls."""
    s = spectra.slenderness[:, None]
    survives = np.isfinite(spectra.peak).all(axis=0) & spectra.survives.all(axis=0)
    steps = np.diff(np.where(survives, spectra.peak, 0.0), axis=0)
    falls = survives & (steps.min(axis=0, initial=np.inf) >= -SAME)
    areas = spectra.areas[0]
    return Claim(
        "damping",
        share_of_area(falls, survives, areas),
        {"share below 1/a = 0.85": share_of_area(falls, survives & (s < 0.85), areas)},
        within=spectra.within(falls, survives),
    )


class Swings(NamedTuple):
    """Free rocking of several blocks for several restitutions, arrays (block, restitution)."""

    restitution: Floats  # ascending
    swing: Floats  # time between the first two impacts after the pulse, p t
    velocity: Floats  # largest |theta'|/(p alpha) after the first impact
    whole_velocity: Floats  # the same of the whole response


def swings() -> Swings:
    """Nine blocks under the sine, solved for the restitutions of figure 8."""
    etas = np.round(np.arange(0.80, 0.97, 0.02), 2)
    blocks = [(s, omega) for s in (0.3, 0.45, 0.6) for omega in (6.0, 9.0, 12.0)]
    rows = np.array([[_swing(s, omega, eta) for eta in etas] for s, omega in blocks])
    return Swings(etas, *np.moveaxis(rows, -1, 0))


def _swing(slenderness: float, omega: float, restitution: float) -> tuple[float, float, float]:
    history = time_history(
        "sine", slenderness=slenderness, frequency_ratio=omega, restitution=restitution, duration=30.0, samples=6001
    )
    impacts = history.impact_time.values
    free = impacts[impacts > history.attrs["pulse_end"]]
    velocity = np.abs(history.angular_velocity.values)
    later = velocity[history.tau.values > impacts[0]].max()
    return float(free[1] - free[0]), float(later), float(velocity.max())


def period(swings: Swings) -> Iterator[Claim]:
    """The effective period and the largest velocity of free rocking by restitution."""
    shorter, slower, whole = (
        float(np.all(np.diff(values, axis=1) > 0, axis=1).mean())
        for values in (swings.swing, swings.velocity, swings.whole_velocity)
    )
    yield Claim("period", shorter)
    yield Claim("velocity-peaks", slower, {"share, whole response": whole})
