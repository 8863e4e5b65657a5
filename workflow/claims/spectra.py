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
from workflow.claims.area import MEASURE, Flags, Floats, node_areas, share_of_area
from workflow.claims.claim import SAME, SMALL, Claim, Range, holding_range, percent

OCTAVES = ((0.5, 1.0), (1.0, 2.0), (2.0, 4.0), (4.0, 8.0), (8.0, 15.0))
"""Ranges of omega in which the time of the peak is compared [-]."""

DISTANCES = ((0.0, 0.05), (0.05, 0.1), (0.1, 0.2), (0.2, 0.3))
"""Ranges of the distance in 1/a from (3.31) in which the error of (4.13) is compared [-]."""

SLOW_IMPACT = 0.3  # largest eta v that is considered small [-]
LAW = 0.10  # error of the scale law up to which a spectrum is "approximated" by it [-]


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

    @property
    def range(self) -> str:
        """The window in words."""
        s, omega, eta = self.slenderness, self.frequency_ratio, self.restitution
        return (
            f"1/a {s[0]:.2f} to {s[-1]:.2f}, omega {omega[0]:.1f} to {omega[-1]:.0f}, eta {eta[0]:.2f} to {eta[-1]:.2f}"
        )


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


def closed_form(spectra: Spectra) -> Iterator[Claim]:
    """(4.13) against the solver where the first impact follows the pulse."""
    with np.errstate(invalid="ignore"):
        error = np.abs(spectra.closed / spectra.peak - 1)
    region = spectra.after_pulse & spectra.survives
    exact = region & (np.nan_to_num(error, nan=np.inf) < SAME)
    share = share_of_area(exact, region, spectra.areas)
    later = region & (spectra.mode == 3)  # the peak is reached in free rocking after one impact
    rest = region & ~exact
    yield Claim(
        key="spectrum-exact",
        fails_if="the largest rotation comes before the impact, which (4.13) does not describe",
        place="section 4a, (4.13), figure 8",
        printed="(4.13) is accurate where the first impact follows the pulse",
        criterion=f"it is the peak of the whole response, within a relative {SAME:.0e}, where the first impact follows "
        f"the pulse and the block survives; {MEASURE}, {spectra.range}",
        found=f"on {percent(share)}; where the largest rotation comes after that impact the difference is at most "
        f"{error[later].max(initial=0.0):.0e}; on the rest the block rotated further before it",
        share=share,
        within=Range("the largest rotation comes after that impact", share_of_area(later, region, spectra.areas))
        if exact[later].all()
        else None,
        numbers={"share_peak_before_impact": share_of_area(rest & ~later, region, spectra.areas)},
    )


def time_of_peak(spectra: Spectra) -> Iterator[Claim]:
    """When the largest rotation is reached where the first impact follows the pulse, and the two roots of (4.12)."""
    region = spectra.after_pulse & spectra.survives
    between = spectra.mode == 1  # reached in free rocking before any impact
    yield Claim(
        key="time-of-peak",
        fails_if="the block still rises when the pulse ends",
        place="section 4a, above (4.12)",
        printed="above (3.31) the maximum rotation appears either during the excitation or after the first impact",
        criterion="where the first impact follows the pulse and the block survives, the peak is not reached between "
        f"the end of the pulse and that impact; share of nodes, {spectra.range}",
        found=f"at {int((region & ~between).sum())} of {int(region.sum())} nodes",
        share=float((~between)[region].mean()) if region.any() else np.nan,
        within=spectra.within(~between, region),
        numbers={"nodes": int(region.sum()), "between": int((region & between).sum())},
    )
    later = region & (spectra.mode == 3) & np.isfinite(spectra.closed)
    other, peak = 2 - spectra.closed[later], spectra.peak[later]  # 1 + and 1 - the square root of (4.12)
    yield Claim(
        key="positive-root",
        fails_if="only by a slip: no square root is negative",
        place="section 4a, below (4.12)",
        printed="the positive sign in (4.12) lacks physical meaning, as it yields a rotation greater than alpha",
        criterion="where the largest rotation follows the first impact, the root with the positive sign is above alpha "
        "and the peak that the solver finds below it; share of nodes",
        found=f"at {int(((other > 1) & (peak < 1)).sum())} of {peak.size} nodes; smallest root "
        f"{other.min(initial=2.0):.5f}, largest peak {peak.max(initial=0.0):.5f}",
        share=float(((other > 1) & (peak < 1)).mean()) if peak.size else np.nan,
        identity=True,
        numbers={"nodes": peak.size},
    )


def no_real_root(spectra: Spectra) -> Iterator[Claim]:
    """Whether (4.13) has no real root exactly where the solver finds that the block overturns."""
    region = spectra.after_pulse
    overturns = spectra.outcome >= Outcome.OVERTURNED_DIRECTLY
    equal = np.isnan(spectra.closed) == overturns
    share = share_of_area(equal, region, spectra.areas)
    yield Claim(
        key="no-real-root",
        fails_if="the block survives without a root, or overturns in spite of one by further impacts",
        place="section 4a, below (4.13)",
        printed="where the block overturns by case 1.2 (4.13) yields no real root",
        criterion="it has no real root where the solver finds overturning, and one where it finds survival; first "
        f"impact after the pulse, {MEASURE}, {spectra.range}",
        found=f"on {percent(share)}: {int((region & ~equal).sum())} of {int(region.sum())} nodes differ",
        share=share,
        within=spectra.within(equal, region),
        numbers={"different": int((region & ~equal).sum()), "nodes": int(region.sum())},
    )


def peak_after_pulse(spectra: Spectra) -> Iterator[Claim]:
    """Whether the largest rotation comes after the pulse as omega grows."""
    region = spectra.after_pulse & spectra.survives
    free = spectra.mode % 2 == 1  # reached in free rocking
    omega = spectra.frequency_ratio
    shares = {}
    for low, high in OCTAVES:
        band = region & (omega >= low) & (omega < high)
        if band.any():
            shares[f"{low:g} to {high:g}"] = share_of_area(free, band, spectra.areas)
    values = list(shares.values())
    met = bool(np.all(np.diff(values) >= 0)), bool(values[-1] > 0.5)
    yield Claim(
        key="peak-after-pulse",
        fails_if="the share falls from an octave to the next, or stays below one half",
        place="section 4a, above (4.12)",
        printed="as omega becomes larger the maximum rotation appears after the end of the excitation",
        criterion="where the first impact follows the pulse and the block survives, the share of blocks with their "
        "peak after the pulse does not fall from one octave of omega to the next, and exceeds one half in the last; "
        f"{MEASURE}, {spectra.range}; share of the two",
        found="share by omega: " + ", ".join(f"{percent(share)} ({band})" for band, share in shares.items()),
        share=float(np.mean(met)),
        numbers={f"share, omega {band}": share for band, share in shares.items()},
    )


def approximation_near_limit(spectra: Spectra) -> Iterator[Claim]:
    """Below (3.31) the error of (4.13) by distance from that curve."""
    omega = spectra.frequency_ratio
    distance = np.broadcast_to(spectra.slenderness[:, None] - 1 / limit_amplitude(omega), spectra.peak.shape)
    with np.errstate(invalid="ignore"):
        error = np.abs(spectra.closed / spectra.peak - 1)
    known = spectra.survives & np.isfinite(error) & (omega > 2)
    medians = {
        f"{low:g} to {high:g}": float(np.median(error[known & (distance >= low) & (distance < high)]))
        for low, high in DISTANCES
    }
    rises = np.diff(list(medians.values())) > 0
    yield Claim(
        key="approximation-near-limit",
        fails_if="the error does not depend on the distance, or falls with it",
        place="section 4a, below (4.13)",
        printed="below the curve (3.31) the approximation gets better near the curve",
        criterion="the median error of (4.13) rises from each range of distance in 1/a to the next; omega from 2, "
        f"eta {spectra.restitution[0]:.2f} to {spectra.restitution[-1]:.2f}",
        found="median error by distance: " + ", ".join(f"{percent(value)} ({band})" for band, value in medians.items()),
        share=float(rises.mean()),
        numbers={f"median {band}": value for band, value in medians.items()},
    )


class SlowImpacts(NamedTuple):
    """Blocks whose first impact follows the pulse and is slow, arrays of one shape."""

    speed: Floats  # eta v, by (3.15)
    peak: Floats  # theta_max/alpha after the impact by the solver
    leading: Floats  # (4.14), corrected


def slow_impacts() -> SlowImpacts:
    """Blocks under short pulses that rotate furthest after the impact, eta v up to `SLOW_IMPACT`."""
    omega, eta = np.geomspace(15.0, 150.0, 60), np.array([0.80, 0.85, 0.90, 0.96])[:, None, None]
    share = np.linspace(0.02, 0.98, 25)[:, None]
    a = limit_amplitude(omega) * (case_2_amplitude(omega) / limit_amplitude(omega)) ** share
    found = peak_response("sine", slenderness=1 / a, frequency_ratio=omega, restitution=eta)
    speed = eta * case_1_2_impact_velocity(a, omega)
    chosen = (found.peak_mode == 3) & (speed <= SLOW_IMPACT)
    return SlowImpacts(speed[chosen], found.peak_rotation[chosen], small_peak(a, omega, eta)[chosen])


def leading_term(slow: SlowImpacts) -> Iterator[Claim]:
    """(4.14), corrected, against the peaks of the solver for small velocities after the impact."""
    error = np.abs(slow.leading / slow.peak - 1)
    share = float((error <= SMALL).mean()) if error.size else np.nan
    yield Claim(
        key="leading-term",
        fails_if="the next term of (4.13) matters at these velocities",
        place="section 4a, (4.14), corrected",
        printed="for small eta v_i2 (4.13) simplifies to (eta^2/2)(1 - D0*)",
        criterion=f"within {percent(SMALL)} of the peak that the solver finds for eta v up to {SLOW_IMPACT:g}; "
        f"{error.size} blocks, omega 15 to 150, eta 0.80 to 0.96; share of blocks",
        found=f"for {percent(share)}; largest error {percent(float(error.max(initial=0.0)))}",
        share=share,
        within=holding_range(error <= SMALL, {"eta v": slow.speed}),
        numbers={"largest": float(error.max(initial=0.0)), "blocks": error.size},
    )


def scale_law(spectra: Spectra) -> Iterator[Claim]:
    """(4.16): deviation of the peaks from proportionality to eta squared."""
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
    share = share_of_area(good, survives, areas)
    shares = {name: share_of_area(good, part, areas) for name, part in parts.items()}
    exponents = {name: float(np.nanmedian(exponent[part])) if part.any() else np.nan for name, part in parts.items()}
    yield Claim(
        key="scale-law",
        fails_if="the largest rotation comes before any impact, which eta does not change, or after several",
        place="section 4a, (4.16)",
        printed="spectra can be approximated by a scaling with eta squared",
        criterion=f"the peak at eta = {reference:.2f} and the law give the peaks at all other eta within "
        f"{percent(LAW)}, where the block survives for all of them; {MEASURE}, {spectra.range}",
        found=f"on {percent(share)}; "
        + "; ".join(f"{name}: {percent(shares[name])}, median exponent {exponents[name]:.2f}" for name in parts)
        + " (map: figure-scale-law)",
        share=share,
        within=spectra.within(good, survives),
        numbers={f"share, {name}": value for name, value in shares.items()}
        | {f"median exponent, {name}": value for name, value in exponents.items()},
    )


def damping(spectra: Spectra) -> Iterator[Claim]:
    """Whether the peak never rises as restitution falls."""
    s = spectra.slenderness[:, None]
    survives = np.isfinite(spectra.peak).all(axis=0) & spectra.survives.all(axis=0)
    steps = np.diff(np.where(survives, spectra.peak, 0.0), axis=0)
    falls = survives & (steps.min(axis=0, initial=np.inf) >= -SAME)
    areas = spectra.areas[0]
    share, below = (share_of_area(falls, part, areas) for part in (survives, survives & (s < 0.85)))
    yield Claim(
        key="damping",
        fails_if="a weaker impact changes the phase of the next so that the pulse adds rotation",
        place="section 4a, figures 7 and 8",
        printed="as the coefficient of restitution decreases the maximum rotation decreases",
        criterion="the peak does not rise with any step down in eta, where the block survives for all eta; "
        f"{MEASURE}, {spectra.range}",
        found=f"on {percent(share)}; on {percent(below)} of what lies below 1/a = 0.85, above which a block has many "
        "impacts and restarts",
        share=share,
        within=spectra.within(falls, survives),
        numbers={"share_below_0.85": below},
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
    found = np.array([[_swing(s, omega, eta) for eta in etas] for s, omega in blocks])
    return Swings(etas, *np.moveaxis(found, -1, 0))


def _swing(slenderness: float, omega: float, restitution: float) -> tuple[float, float, float]:
    history = time_history(
        "sine", slenderness=slenderness, frequency_ratio=omega, restitution=restitution, duration=30.0, samples=6001
    )
    impacts = history.impact_time.values
    free = impacts[impacts > history.attrs["pulse_end"]]
    velocity = np.abs(history.angular_velocity.values)
    later = velocity[history.tau.values > impacts[0]].max()
    return float(free[1] - free[0]), float(later), float(velocity.max())


def period(swing: Swings) -> Iterator[Claim]:
    """The effective period and the largest velocity of free rocking by restitution."""
    shorter = np.all(np.diff(swing.swing, axis=1) > 0, axis=1)
    slower = np.all(np.diff(swing.velocity, axis=1) > 0, axis=1)
    whole = np.all(np.diff(swing.whole_velocity, axis=1) > 0, axis=1)
    low, high = swing.restitution[0], swing.restitution[-1]
    blocks = f"{shorter.size} blocks under the sine, 1/a 0.3 to 0.6, omega 6 to 12, eta {high} down to {low}"
    yield Claim(
        key="period",
        fails_if="the time to the next impact does not fall with the velocity after an impact",
        place="section 4a, figure 7",
        printed="as the coefficient of restitution decreases the effective period becomes shorter",
        criterion=f"the time between the first two impacts after the pulse shortens with every step; {blocks}",
        found=f"for {int(shorter.sum())} of them",
        share=float(shorter.mean()),
    )
    yield Claim(
        key="velocity-peaks",
        fails_if="a later stage of the pulse adds velocity to a weaker impact",
        place="section 4a, figure 7",
        printed="as the coefficient of restitution decreases the maximum angular velocity becomes lower",
        criterion=f"the largest velocity after the first impact falls with every step; {blocks}",
        found=f"for {int(slower.sum())} of them; the largest velocity of the whole response does so for "
        f"{int(whole.sum())}, as it can be that before the first impact, which does not depend on eta",
        share=float(slower.mean()),
        numbers={"share_whole_response": float(whole.mean())},
    )
