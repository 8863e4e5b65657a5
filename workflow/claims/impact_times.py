"""Claims of section 3 on the time of the first impact, exact (3.13) and approximate (3.23) to (3.30)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rocking.closed_form import (
    ad_hoc_impact_time,
    ad_hoc_sine,
    after_pulse_coefficients,
    case_1_1_amplitudes,
    case_1_1_end,
    case_1_1_impact_time,
    case_1_2_impact_time,
    case_1_2_impact_velocity,
    case_1_2_residual,
    case_2_amplitude,
    free_velocity,
    limit_amplitude,
    semi_analytical_amplitudes,
    uplift_phase,
    within_pulse,
)
from rocking.closed_form.roots import find_root
from workflow.claims.claim import FAILS, IN_RANGE, Claim, verdict


def exact_impact() -> list[Claim]:
    """(3.13) and (3.15) where the first impact follows the pulse, between (3.31) and (3.10)."""
    omega = np.linspace(0.5, 12.0, 231)
    share = np.linspace(0.01, 0.99, 99)[:, None]
    a = limit_amplitude(omega) * (case_2_amplitude(omega) / limit_amplitude(omega)) ** share
    tau = case_1_2_impact_time(a, omega)
    residual = float(np.abs(case_1_2_residual(a, omega, tau)).max())
    velocity = case_1_2_impact_velocity(a, omega)
    slope = float(np.abs(free_velocity(a, omega, tau) / velocity - 1).max())
    _, growing = after_pulse_coefficients(a, omega)
    other = (1 - velocity) / growing  # e^tau of the other root of (3.12)
    real = other > 0
    positive = real & (other > 1)
    return [
        Claim(
            key="impact-time-exact",
            place="section 3b, (3.13)",
            printed="(3.13) solves (3.12) exactly for the impact after the pulse",
            found=f"left side of (3.12) at (3.13) at most {residual:.1e} on {a.size} blocks of case 1.2",
            verdict=verdict(residual < 1e-9, somewhere=False),
            numbers={"largest_residual": residual},
        ),
        Claim(
            key="other-root",
            place="section 3b, below (3.12)",
            printed="the other solution of (3.12) is negative and lacks physical meaning",
            found=f"of {a.size} blocks of case 1.2 it is no real number for {100 * (1 - real.mean()):.1f} %, "
            f"negative for {100 * (real & ~positive).mean():.1f} % and positive for {100 * positive.mean():.1f} %",
            verdict=verdict(not positive.any(), somewhere=not positive.all()),
            numbers={"share_positive": float(positive.mean()), "share_not_real": float(1 - real.mean())},
        ),
        Claim(
            key="impact-velocity",
            place="section 3b, (3.15)",
            printed="the velocity before that impact is sqrt(1 - D0*)",
            found=f"(3.14) at (3.13) agrees to a relative {slope:.1e}",
            verdict=verdict(slope < 1e-9, somewhere=False),
            numbers={"largest_relative_difference": slope},
        ),
    ]


def ad_hoc(restitution: Sequence[float]) -> list[Claim]:
    """The assumption tau = 1, the expansion around it, and the curve it gives."""
    eta = np.array(restitution)[:, None]
    omega = np.linspace(1.0, 5.5, 181)
    exact = case_1_1_amplitudes(omega, eta).lower
    known = np.isfinite(exact)
    tau = np.where(known, case_1_1_impact_time(np.where(known, exact, 2.0), omega), np.nan)
    approximate = np.where(known, ad_hoc_impact_time(np.where(known, exact, 2.0), omega), np.nan)
    near_one = omega[np.all(~known | (np.abs(tau - 1) < 0.25), axis=0) & known.any(axis=0)]
    error = np.abs(approximate - tau)

    semi = semi_analytical_amplitudes(omega, eta).lower
    valid = known & np.isfinite(semi) & within_pulse(np.where(np.isfinite(semi), semi, 2.0), omega)
    relative = np.where(valid, np.abs(semi / exact - 1), np.nan)
    bands = {f"{low:g} to {high:g}": float(np.nanmax(relative[:, (omega >= low) & (omega <= high)]))
             for low, high in ((1, 2), (2, 3), (3, 4))}  # fmt: skip
    tips = float(np.nanmax(relative[:, omega > 4]))
    lost = np.where(known & ~valid, omega, np.nan)

    by_omega = _expansion_error()
    return [
        Claim(
            key="impact-at-1/p",
            place="section 3c, (3.23)",
            printed="the block returns to impact about 1/p after uplift",
            found=f"on the curve from which case 1.1 overturns tau_i1 runs from {np.nanmin(tau):.2f} to "
            f"{np.nanmax(tau):.2f} (eta {eta.min():.2f} to {eta.max():.2f}, omega from 1); within 25 % of 1 for omega "
            f"from {near_one.min():.2f} on",
            verdict=IN_RANGE,
            numbers={"smallest": float(np.nanmin(tau)), "largest": float(np.nanmax(tau)), "omega_from": near_one.min()},
        ),
        Claim(
            key="ad-hoc-sine",
            place="section 3c, below (3.27), figure S1",
            printed="near tau = 1 (3.27) is excellent for omega < 2 and satisfactory around omega = 5",
            found="largest error over |tau - 1| < 0.25, whatever the phase: "
            + ", ".join(f"{e:.1e} at omega = {w:g}" for w, e in by_omega.items()),
            verdict=IN_RANGE,
            numbers={f"error_at_{w:g}": e for w, e in by_omega.items()},
        ),
        Claim(
            key="ad-hoc-time",
            place="section 3c, (3.29)",
            printed="(3.29) approximates the time of impact",
            found=f"on the same curve it is off by at most {np.nanmax(error[:, omega <= 2]):.2f} for omega 1 to 2, "
            f"{np.nanmax(error[:, (omega > 2) & (omega <= 4)]):.1e} for 2 to 4 and "
            f"{np.nanmax(error[:, omega > 4]):.2f} beyond",
            verdict=IN_RANGE,
            numbers={"largest_1_to_2": float(np.nanmax(error[:, omega <= 2])),
                     "largest_2_to_4": float(np.nanmax(error[:, (omega > 2) & (omega <= 4)])),
                     "largest_beyond_4": float(np.nanmax(error[:, omega > 4]))},
        ),
        Claim(
            key="minima-coincide",
            place="section 3c, figure 3",
            printed="the smallest solution of (3.30) coincides with that of (3.20) and (3.21)",
            found="relative difference in a at most "
            + ", ".join(f"{value:.1e} for omega {band}" for band, value in bands.items())
            + f", {tips:.1e} beyond; close to the tips of the curves, from omega = {np.nanmin(lost):.2f} on, (3.30) "
            "has no solution inside the pulse at some restitutions",
            verdict=IN_RANGE,
            numbers={f"omega {band}": value for band, value in bands.items()} | {"beyond_4": tips},
        ),
    ]  # fmt: skip


def _expansion_error() -> dict[float, float]:
    """Largest |(3.27) - sine| near tau = 1 for some frequency ratios, over all phases of uplift."""
    a = 1 / np.linspace(0.05, 0.99, 95)[:, None]
    tau = np.linspace(0.75, 1.25, 101)
    return {
        omega: float(np.abs(ad_hoc_sine(a, omega, tau) - np.sin(omega * tau + uplift_phase(a))).max())
        for omega in (1.0, 2.0, 5.0, 8.0)
    }


def end_of_case_1_1(restitution: Sequence[float]) -> list[Claim]:
    """Where overturning by case 1.1 ends."""
    ends = case_1_1_end(np.array([*restitution, 1.0]))
    five = float(find_root(lambda eta: case_1_1_end(eta) - 5.0, np.array(0.8), np.array(1.0)))
    listed = ", ".join(f"{end:.2f} (eta {eta:.2f})" for eta, end in zip([*restitution, 1.0], ends, strict=True))
    return [
        Claim(
            key="no-case-1.1-above-5",
            place="section 3c, below (3.27)",
            printed="for omega > 5 the block does not overturn by case 1.1",
            found=f"case 1.1 ends at omega = {listed}; the claim is true for eta up to {five:.3f}",
            verdict=IN_RANGE if np.any(ends < 5) else FAILS,
            numbers={"end_at_eta_1": float(ends[-1]), "largest_eta": five},
        )
    ]
