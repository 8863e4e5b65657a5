"""Claims of section 4a on peak rotation: the closed form (4.13) and the scale law (4.16) for restitution."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from rocking.closed_form import (
    case_1_2_impact_velocity,
    case_1_2_margin,
    case_1_2_peak,
    case_2_amplitude,
    limit_amplitude,
    small_peak,
)
from rocking.groups.scale_law import largest_deviation, restitution_exponent
from rocking.history.time_history import time_history
from rocking.model.response import Outcome
from workflow.claims.claim import FAILS, Claim, verdict

FAST = 8.0
"""Frequency ratio from which omega is considered large [-]."""


def closed_form(cubes: Sequence[xr.Dataset]) -> list[Claim]:
    """(4.13) compared with the spectrum cubes of the sine."""
    exact, total = 0.0, 0
    later = dict.fromkeys(("after impact", "after pulse"), 0)
    fast = dict.fromkeys(("after pulse", "total"), 0)
    bands: dict[str, list[float]] = {"0.00 to 0.05": [], "0.05 to 0.10": [], "0.10 to 0.20": [], "0.20 to 0.30": []}
    for cube in cubes:
        one = cube.sel(alpha=0.0)
        s, omega = one.slenderness.values[:, None], one.frequency_ratio.values
        peak, safe = one.peak_rotation.values, one.outcome.values == Outcome.SAFE
        closed = case_1_2_peak(1 / s, omega, float(cube.restitution))
        edge = 1 / limit_amplitude(omega)
        after = safe & (s < edge) & np.isfinite(closed)  # the first impact follows the pulse
        free = after & (one.peak_mode.values == 3)  # and the peak is that of free rocking after it
        with np.errstate(invalid="ignore"):
            error = np.abs(closed / peak - 1)
        exact = max(exact, float(error[free].max(initial=0.0)))
        total += int(after.sum())
        later["after impact"] += int(free.sum())
        over = after & (one.peak_mode.values % 2 == 1)  # the peak is reached in free rocking
        later["after pulse"] += int(over.sum())
        fast["after pulse"] += int(over[:, omega > FAST].sum())
        fast["total"] += int(after[:, omega > FAST].sum())
        for band in bands:
            low, high = (float(x) for x in band.split(" to "))
            part = safe & np.isfinite(error) & (s - edge >= low) & (s - edge < high) & (omega > 2)
            bands[band] += [float(np.median(error[part]))] if part.any() else []
    medians = {band: float(np.mean(values)) for band, values in bands.items() if values}
    shares = [later["after impact"] / total, later["after pulse"] / total, fast["after pulse"] / fast["total"]]
    rising = bool(np.all(np.diff(list(medians.values())) > 0))
    return [
        Claim(
            key="spectrum-exact",
            place="section 4a, (4.13), figure 8",
            printed="(4.13) is accurate where the first impact follows the pulse",
            found=f"where the largest rotation comes after that impact, {100 * shares[0]:.1f} % of {total} nodes, "
            f"the relative difference is at most {exact:.1e}; at the others the block rotated further before it",
            verdict=verdict(later["after impact"] == total, somewhere=exact < 1e-9),
            numbers={"largest_difference": exact, "share_after_impact": shares[0], "nodes": total},
        ),
        Claim(
            key="peak-after-pulse",
            place="section 4a, above (4.12)",
            printed="as omega grows the largest rotation comes after the excitation",
            found=f"at the same nodes it does so for {100 * shares[1]:.1f} % in all and for {100 * shares[2]:.1f} % of "
            f"those with omega > {FAST:g}; where it does not, the block is far from rest when a strong pulse ends",
            verdict=verdict(shares[2] == 1.0),
            numbers={"share": shares[1], "share_of_large_omega": shares[2]},
        ),
        Claim(
            key="approximation-near-limit",
            place="section 4a, below (4.13)",
            printed="below the curve (3.31) the approximation gets better near the curve",
            found="median relative error of (4.13) by distance of 1/a from the curve, omega > 2: "
            + ", ".join(f"{value:.3f} ({band})" for band, value in medians.items()),
            verdict=verdict(rising),
            numbers={f"median {band}": value for band, value in medians.items()},
        ),
    ]


def no_real_root(restitution: Sequence[float]) -> list[Claim]:
    """(4.13) has no real root exactly where the block overturns by (3.18)."""
    eta = np.array(restitution)[:, None, None]
    omega = np.linspace(0.5, 12.0, 231)
    share = np.linspace(0.001, 0.999, 199)[:, None]
    a = limit_amplitude(omega) * (case_2_amplitude(omega) / limit_amplitude(omega)) ** share
    complex_root = np.isnan(case_1_2_peak(a, omega, eta))
    overturns = case_1_2_margin(a, omega, eta) > 0
    different = int((complex_root != overturns).sum())
    return [
        Claim(
            key="no-real-root",
            place="section 4a, below (4.13)",
            printed="(4.13) yields no real root where the block overturns by case 1.2",
            found=f"the two conditions differ at {different} of {overturns.size} blocks",
            verdict=verdict(different == 0, somewhere=False),
            numbers={"different": different, "blocks": overturns.size},
        )
    ]


def leading_term() -> list[Claim]:
    """(4.14) to (4.16) as printed, with the square root, and as they follow from (4.13)."""
    omega, a, eta = 10.0, 4.0, 0.85
    full, corrected = float(case_1_2_peak(a, omega, eta)), float(small_peak(a, omega, eta))
    printed = eta**2 / 2 * float(case_1_2_impact_velocity(a, omega))
    x = np.linspace(1e-3, 1.0, 1000)
    error = 1 - (x * x / 2) / (1 - np.sqrt(1 - x * x))
    five = float(x[error < 0.05].max())
    return [
        Claim(
            key="leading-term-printed",
            place="section 4a, (4.14), (4.15), (4.16)",
            printed="theta_m/alpha tends to (eta^2/2) sqrt(1 - D0*)",
            found=f"at omega = {omega:g}, a = {a:g}, eta = {eta}: (4.13) gives {full:.5f}, the printed term "
            f"{printed:.5f}, without the square root {corrected:.5f}",
            verdict=FAILS,
            numbers={"full": full, "printed": printed, "corrected": corrected},
        ),
        Claim(
            key="leading-term",
            place="section 4a, (4.14) corrected",
            printed="for small eta v_i2 (4.13) simplifies to (eta^2/2)(1 - D0*)",
            found=f"the term is low by (eta v_i2)^2/4 to leading order: within 5 % up to eta v_i2 = {five:.2f}, "
            "by half at 1",
            verdict=verdict(False),
            numbers={"velocity_at_5_percent": five},
        ),
    ]


def scale_law(cubes: Sequence[xr.Dataset]) -> list[Claim]:
    """(4.16) on the spectra of the sine: deviation of the peaks from proportionality to eta squared."""
    cubes = sorted(cubes, key=lambda cube: float(cube.restitution))
    eta = np.array([float(cube.restitution) for cube in cubes])
    reference = float(eta[np.argmin(np.abs(eta - 0.9))])
    peaks = np.stack([cube.sel(alpha=0.0).peak_rotation.values for cube in cubes])
    survives = np.isfinite(peaks).all(axis=0)
    peaks[:, ~survives] = np.nan
    s, omega = cubes[0].slenderness.values[:, None], cubes[0].frequency_ratio.values
    error, exponent = largest_deviation(peaks, eta, reference=reference), restitution_exponent(peaks, eta)
    after = survives & (s < 1 / limit_amplitude(omega))
    inside = survives & ~after & (s < 0.85)
    chatter = survives & (s >= 0.85)
    falling = survives & (np.diff(peaks, axis=0).min(axis=0) >= 0)
    slender = float((falling & (s < 0.85)).sum() / (survives & (s < 0.85)).sum())
    parts = {"first impact after the pulse": after, "inside it, 1/a < 0.85": inside, "1/a >= 0.85": chatter}
    numbers = {f"within_10_percent, {name}": float((error[part] < 0.1).mean()) for name, part in parts.items()}
    numbers |= {f"median_exponent, {name}": float(np.nanmedian(exponent[part])) for name, part in parts.items()}
    rows = "; ".join(
        f"{name}: {100 * (error[part] < 0.1).mean():.0f} % of nodes within 10 %, median exponent "
        f"{np.nanmedian(exponent[part]):.2f}"
        for name, part in parts.items()
    )
    return [
        Claim(
            key="scale-law",
            place="section 4a, (4.16)",
            printed="spectra can be approximated by a scaling with eta squared",
            found=f"predicted from eta = {reference:.2f} for {eta.min():.2f} to {eta.max():.2f}: {rows} (map: "
            "figure-scale-law)",
            verdict=verdict(bool((error[survives] < 0.1).all())),
            numbers=numbers,
        ),
        Claim(
            key="damping",
            place="section 4a, figures 7 and 8",
            printed="as restitution decreases the largest rotation decreases",
            found=f"at {100 * falling.sum() / survives.sum():.1f} % of {int(survives.sum())} surviving nodes the peak "
            f"never decreases with increasing eta; at {100 * slender:.1f} % of "
            "those with 1/a < 0.85",
            verdict=verdict(bool(falling.sum() == survives.sum())),
            numbers={"share": float(falling.sum() / survives.sum()),
                     "share_below_0.85": slender},
        ),
    ]  # fmt: skip


def period() -> list[Claim]:
    """The time between the first two impacts after the pulse decreases with restitution."""
    blocks = [(s, omega) for s in (0.3, 0.45, 0.6) for omega in (6.0, 9.0, 12.0)]
    etas = np.round(np.arange(0.80, 0.97, 0.02), 2)
    shorter = 0
    for s, omega in blocks:
        swings = []
        for eta in etas:
            history = time_history("sine", slenderness=s, frequency_ratio=omega, restitution=eta, duration=30.0)
            free = history.impact_time.values[history.impact_time.values > history.attrs["pulse_end"]]
            swings.append(free[1] - free[0])
        shorter += bool(np.all(np.diff(swings) > 0))
    return [
        Claim(
            key="period",
            place="section 4a, figure 7",
            printed="as restitution decreases the effective period becomes shorter",
            found=f"for {shorter} of {len(blocks)} blocks the first swing of free rocking between impacts shortens "
            f"with every step from eta = {etas[-1]} down to {etas[0]}",
            verdict=verdict(shorter == len(blocks), somewhere=shorter > 0),
            numbers={"blocks": len(blocks), "shorter": shorter},
        )
    ]
