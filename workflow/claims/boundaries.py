"""Claims of section 3 on the overturning curves: closed forms compared with curves traced with the solver."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from rocking.boundary.search import RESOLUTION
from rocking.closed_form import case_2_amplitude, limit_amplitude, overturning_amplitudes
from rocking.model.response import Outcome
from rocking.solver.peak_response import peak_response
from workflow.claims.claim import FAILS, IN_RANGE, Claim, verdict

AGREEMENT = 1e-9
"""Difference in 1/a up to which a traced and a closed-form boundary are considered the same curve [-]."""


def exact_curves(boundaries: Sequence[xr.Dataset]) -> list[Claim]:
    """(3.10), (3.18) and (3.20) with (3.21) against the traced points of their own mode."""
    worst = {"case 2": 0.0, "case 1.2": 0.0, "case 1.1": 0.0}
    count = dict.fromkeys(worst, 0)
    for curves in boundaries:
        rows = curves.row_size.values
        direct = np.repeat(curves.outcome.values == Outcome.OVERTURNED_DIRECTLY, rows)
        once = np.repeat(curves.impacts.values == 1, rows)
        above = 1 / curves.slenderness.values > limit_amplitude(curves.frequency_ratio.values)
        difference = np.abs(curves.closed_form_difference.values)
        for case, part in (("case 2", direct), ("case 1.2", once & above), ("case 1.1", once & ~above)):
            count[case] += int(part.sum())
            worst[case] = max(worst[case], float(difference[part].max(initial=0.0)))
    eta = [float(curves.restitution) for curves in boundaries]
    printed = {
        "case 2": ("(3.10)", "bounds overturning without impact, for any restitution"),
        "case 1.2": ("(3.18)", "is the exact envelope of overturning after an impact that follows the pulse"),
        "case 1.1": ("(3.20), (3.21)", "give the curve of overturning after an impact while the pulse acts"),
    }
    return [
        Claim(
            key=f"curve-{case.replace(' ', '-')}",
            place=f"section 3, {equation}",
            printed=f"{equation} {text}",
            found=f"{count[case]} traced points at {len(eta)} restitutions from {min(eta):.2f} to {max(eta):.2f}: "
            f"largest difference in 1/a {worst[case]:.1e}, bisected to {RESOLUTION:.0e}",
            verdict=verdict(worst[case] < AGREEMENT, somewhere=False),
            numbers={"largest_difference": worst[case], "points": count[case]},
        )
        for case, (equation, text) in printed.items()
    ]


def completeness(cubes: Sequence[xr.Dataset]) -> list[Claim]:
    """Whether the closed forms give the outcome of every node of the spectrum cubes."""
    missed, total, numbers = 0, 0, {}
    place = np.empty((0, 2))
    impacts: set[int] = set()
    for cube in cubes:
        one = cube.sel(alpha=0.0)
        a, omega = 1 / one.slenderness.values[:, None], one.frequency_ratio.values
        closed = overturning_amplitudes(omega, float(cube.restitution))
        predicted = ((a > closed.falls_from) & (a < closed.safe_again)) | (a > closed.direct)
        wrong = predicted != (one.outcome.values >= Outcome.OVERTURNED_DIRECTLY)
        i, j = np.nonzero(wrong)
        impacts |= {int(n) for n in np.unique(one.impacts.values[wrong])}
        place = np.vstack([place, np.column_stack([one.slenderness.values[i], omega[j]])])
        missed, total = missed + int(wrong.sum()), total + wrong.size
        numbers[f"missed_eta_{float(cube.restitution):.2f}"] = int(wrong.sum())
    numbers |= {"missed": missed, "nodes": total}
    where = "none"
    if missed:
        (s0, w0), (s1, w1) = place.min(axis=0), place.max(axis=0)
        where = (
            f"all between 1/a = {s0:.3f} and {s1:.3f} and omega = {w0:.2f} and {w1:.2f}, where the block overturns "
            f"after {min(impacts)} to {max(impacts)} impacts"
        )
        numbers |= {"slenderness_from": s0, "slenderness_to": s1, "omega_from": w0, "omega_to": w1}
    return [
        Claim(
            key="complete",
            place="section 3, (3.10), (3.18), (3.20), (3.21), (3.31)",
            printed="the closed-form expressions describe overturning under one sine completely",
            found=f"they miss {missed} of {total} nodes ({100 * missed / total:.2f} %): {where}; outside these islands "
            "they are complete",
            verdict=verdict(missed == 0, somewhere=False),
            numbers=numbers,
        )
    ]


def limit() -> list[Claim]:
    """(3.31): the curve on which the first impact coincides with the end of the pulse."""
    omega = np.linspace(0.5, 15.0, 581)
    a = limit_amplitude(omega)
    step = 1e-9

    def impact(amplitude: np.ndarray) -> np.ndarray:
        found = peak_response("sine", slenderness=1 / amplitude, frequency_ratio=omega, restitution=0.5)
        return np.isfinite(found.first_impact_time)

    separates = impact(a * (1 - step)) & ~impact(a * (1 + step))
    near = np.abs(a**-1 / 0.4 - 1) < 0.1
    inside = omega[near]
    return [
        Claim(
            key="limit-separates",
            place="section 3d, (3.31)",
            printed="below (3.31) the first impact is within the pulse, above it after the pulse",
            found=f"at {separates.mean():.2%} of {omega.size} frequency ratios from 0.5 to 15 the first impact changes "
            f"sides within a relative {step:.0e} of the curve",
            verdict=verdict(bool(separates.all()), somewhere=bool(separates.any())),
            numbers={"share": float(separates.mean())},
        ),
        Claim(
            key="limit-0.4",
            place="section 4a, below (4.13)",
            printed="(3.31) corresponds roughly to g alpha/a_g = 0.4",
            found=f"1/a decreases from {1 / a[0]:.2f} at omega = 0.5 through "
            f"{1 / float(limit_amplitude(3.0)):.2f} at 3 to {1 / a[-1]:.2f} at 15; within 10 % of 0.4 for omega from "
            f"{inside[0]:.2f} to {inside[-1]:.2f}",
            verdict=IN_RANGE,
            numbers={"at_0.5": 1 / a[0], "at_3": 1 / float(limit_amplitude(3.0)), "at_15": 1 / a[-1],
                     "omega_from": inside[0], "omega_to": inside[-1]},
        ),
    ]  # fmt: skip


def transcription() -> list[Claim]:
    """Formulas of section 3 that hold only after a correction."""
    omega, a, T = 2.3, 3.4, 1.75
    A0, B0 = ((omega**2 + k * omega * np.sqrt(a * a - 1)) / (omega**2 + 1) for k in (1, -1))
    half = omega * a / (omega**2 + 1)  # (omega/2) C0*
    product = (A0 - half * np.exp(T)) * (B0 + half * np.exp(-T))
    s = np.sqrt(a * a - 1)
    bracket = omega**2 - 2 * a * a + 1 + (s + omega) * a * np.exp(-T) + (s - omega) * a * np.exp(T)
    printed, squared = omega / (omega**2 + 1) * bracket, (omega / (omega**2 + 1)) ** 2 * bracket
    direct = float(case_2_amplitude(3.0))
    return [
        Claim(
            key="d0-second-line",
            place="section 3, (3.9)",
            printed="the two lines of D0* are equal",
            found=f"at omega = {omega}, a = {a}, p T_ex = {T} the first line gives {product:.5f}, the second "
            f"{printed:.5f} as printed and {squared:.5f} with its factor squared",
            verdict=FAILS,
            numbers={"first": product, "second_printed": printed, "second_squared": squared},
        ),
        Claim(
            key="uplift-phase",
            place="section 3, (3.3)",
            printed="sin psi = 1/alpha",
            found=f"sin psi = 1/a by the definition in (3.6); with it the block of omega = 3 overturns without impact "
            f"from a = {direct:.6f}, as integration confirms",
            verdict=FAILS,
            numbers={"case_2_amplitude_at_3": direct},
        ),
    ]
