"""Claims of section 3 on the overturning curves: closed forms compared with the solver."""

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from rocking._history.time_history import time_history
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking.paper.overturning import limit_amplitude, overturning_amplitudes
from workflow.claims.area import MEASURE, Flags, Floats, node_areas, share_of_area
from workflow.claims.claim import SAME, SMALL, Claim, holding_range, percent

CASES = {
    "case 2": ("(3.10)", "bounds overturning without impact, for any restitution"),
    "case 1.2": ("(3.18)", "is the exact envelope of overturning after an impact that follows the pulse"),
    "case 1.1": ("(3.20), (3.21)", "give the curve of overturning after an impact while the pulse acts"),
}


def exact_curves(boundaries: Sequence[xr.Dataset]) -> Iterator[Claim]:
    """(3.10), (3.18), (3.20) with (3.21) against the traced points of their own mode: slender blocks, sine."""
    worst = dict.fromkeys(CASES, 0.0)
    count = dict.fromkeys(CASES, 0)
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
    for case, (equation, text) in CASES.items():
        yield Claim(
            key=f"curve-{case.replace(' ', '-')}",
            fails_if="the solver finds a boundary of this mode elsewhere, as with another root for the impact",
            place=f"section 3, {equation}",
            printed=f"{equation} {text}",
            criterion="each point of the boundary that the solver finds lies on the curve, within "
            f"{SAME:.0e} in 1/a; omega 0.2 to 15, eta {min(eta):.2f} to {max(eta):.2f}",
            found=f"largest distance {worst[case]:.0e} at {count[case]} points",
            share=count[case] > 0 and worst[case] < SAME,
            numbers={"largest_difference": worst[case], "points": count[case]},
        )


def completeness(cubes: Sequence[xr.Dataset]) -> Iterator[Claim]:
    """Whether the closed forms give the outcome of every slender block of the spectrum cubes of the sine."""
    missed, missed_linear, numbers, outcomes = [], [], {}, []
    place, at_edge = np.empty((0, 2)), False
    impacts: set[int] = set()
    for cube in cubes:
        one = cube.sel(alpha=0.0)
        s, omega = one.slenderness.values, one.frequency_ratio.values
        closed = overturning_amplitudes(omega, float(cube.restitution))
        a = 1 / s[:, None]
        predicted = ((a > closed.overturns_from) & (a < closed.survives_again)) | (a > closed.direct)
        wrong = predicted != (one.outcome.values >= Outcome.OVERTURNED_DIRECTLY)
        outcomes.append(~wrong)
        everywhere = np.ones_like(wrong)
        missed.append(share_of_area(wrong, everywhere, node_areas(s, omega)))
        missed_linear.append(share_of_area(wrong, everywhere, node_areas(s, omega, logarithmic=False)))
        i, j = np.nonzero(wrong)
        impacts |= {int(n) for n in np.unique(one.impacts.values[wrong])}
        place = np.vstack([place, np.column_stack([s[i], omega[j]])])
        at_edge |= bool(wrong[-1].any())
        numbers[f"missed_eta_{float(cube.restitution):.2f}"] = missed[-1]
    share = float(np.mean(missed))
    where = "none is missed"
    if share > 0.0:
        (s0, w0), (s1, w1) = place.min(axis=0), place.max(axis=0)
        upper = f"{s1:.2f}, the edge of the grid," if at_edge else f"{s1:.3f}"
        where = (
            f"wrong on {percent(share)} of it ({percent(float(np.mean(missed_linear)))} if omega is measured "
            f"linearly), all of it between 1/a = {s0:.3f} and {upper} and below omega = {w1:.2f}, where the block "
            f"overturns after {min(impacts)} and more impacts"
        )
        numbers |= {"slenderness_from": s0, "omega_from": w0, "omega_to": w1}
    numbers |= {"missed": share, "missed_linear_in_omega": float(np.mean(missed_linear))}
    s, omega = cubes[0].slenderness.values, cubes[0].frequency_ratio.values
    yield Claim(
        key="complete",
        fails_if="the solver finds overturning outside of the curves, or survival inside",
        place="section 3, (3.10), (3.18), (3.20), (3.21), (3.31)",
        printed="the closed-form expressions describe overturning under one sine completely",
        criterion=f"they give the final outcome everywhere; {MEASURE}, 1/a {s[0]:.2f} to {s[-1]:.2f}, omega "
        f"{omega[0]:.1f} to {omega[-1]:.0f}, mean over eta",
        found=where,
        share=1.0 - share,
        within=holding_range(outcomes, {"1/a": s[:, None], "omega": omega}, weights=node_areas(s, omega)),
        numbers=numbers,
    )


STEP = 1e-9  # relative distance from a curve at which blocks are tested on either side [-]


def sides_of_limit() -> tuple[Floats, Flags, Flags]:
    """Frequency ratios, and whether there is an impact within the pulse just below and just above (3.31)."""
    omega = np.linspace(0.5, 15.0, 581)
    a = limit_amplitude(omega)
    below, above = (
        np.isfinite(
            peak_response("sine", slenderness=1 / (a * (1 + step)), frequency_ratio=omega, restitution=0.5)
            .first_impact_time
        )
        for step in (-STEP, STEP)
    )  # fmt: skip
    return omega, below, above


def limit_separates(omega: Floats, impact_below: Flags, impact_above: Flags) -> Iterator[Claim]:
    """(3.31): the curve on which the first impact coincides with the end of the pulse."""
    separates = impact_below & ~impact_above
    yield Claim(
        key="limit-separates",
        fails_if="an impact comes within the pulse above the curve, or after it below the curve",
        place="section 3d, (3.31)",
        printed="below (3.31) the first impact is within the pulse, above it after the pulse",
        criterion=f"the first impact leaves the pulse within a relative {STEP:.0e} of the curve; "
        f"{omega.size} frequency ratios from {omega[0]:g} to {omega[-1]:g}",
        found=f"at {int(separates.sum())} of them",
        share=float(separates.mean()),
        within=holding_range(separates, {"omega": omega}),
    )


def limit_value(omega: Floats, slenderness: Floats) -> Iterator[Claim]:
    """How far the curve (3.31), 1/a over equidistant omega, is a line at 0.4."""
    rounds_to = (slenderness >= 0.35) & (slenderness < 0.45)
    yield Claim(
        key="limit-0.4",
        fails_if="the curve leaves the band within the range of figure 8",
        place="section 4a, below (4.13)",
        printed="(3.31) roughly corresponds to g alpha/a_g = 0.4",
        criterion=f"1/a on (3.31) rounds to 0.4, 0.35 to 0.45; omega {omega[0]:g} to {omega[-1]:g}, as in figure 8",
        found=f"1/a falls from {slenderness[0]:.2f} to {slenderness[-1]:.2f}",
        share=float(rounds_to.mean()),
        within=holding_range(rounds_to, {"omega": omega}),
        numbers={"first": slenderness[0], "last": slenderness[-1]},
    )


def time_near_equilibrium(restitution: Sequence[float]) -> Floats:
    """For how long after the pulse blocks just above their threshold stay close to alpha, p t [-].

    The thresholds are those of the closed forms at several omega; a block is `STEP` above or, where it survives again,
    below. Negative if it has left alpha for good before the pulse ended.
    """
    found = []
    for eta in restitution:
        closed = overturning_amplitudes(np.array([1.0, 2.0, 3.0, 4.0]), eta)
        for omega, low, high, direct in zip(
            (1.0, 2.0, 3.0, 4.0), closed.overturns_from, closed.survives_again, closed.direct, strict=True
        ):
            for a in (low * (1 + STEP), high * (1 - STEP), direct * (1 + STEP)):
                history = time_history(
                    "sine", slenderness=1 / a, frequency_ratio=omega, restitution=eta, duration=60.0, samples=6001
                )
                close = np.abs(np.abs(history.rotation.values) - 1) < SMALL
                last = history.tau.values[close].max(initial=-np.inf)
                found.append(float(last) - history.attrs["pulse_end"])
    return np.array(found)


def overturning_in_free_rocking(time_close: Floats) -> Iterator[Claim]:
    """(3.8): at the smallest amplitude that overturns, the block overturns after the pulse, slowing down near alpha."""
    after = time_close > 0.0
    yield Claim(
        key="free-rocking",
        fails_if="a block at its threshold passes alpha for good while the pulse acts",
        place="section 3, (3.8)",
        printed="at the smallest amplitude that overturns, overturning takes place in free rocking, where the "
        "velocity tends to a minimum",
        criterion=f"a block within a relative {STEP:.0e} of its threshold leaves alpha, the unstable equilibrium, "
        f"by {percent(SMALL)} only after the pulse; thresholds of cases 1.1, 1.2 and 2, omega 1 to 4",
        found=f"at {int(after.sum())} of {after.size} thresholds; it stays there until p t = {time_close.min():.1f} "
        "after the pulse or longer",
        share=float(after.mean()),
        numbers={"thresholds": after.size, "shortest": float(time_close.min())},
    )
