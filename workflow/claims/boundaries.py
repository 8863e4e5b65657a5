"""Claims of section 3 on the overturning curves: closed forms compared with the solver."""

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from rocking._history.time_history import time_history
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking.paper.overturning import limit_amplitude, overturning_amplitudes
from workflow.claims.area import Flags, Floats, node_areas, share_of_area
from workflow.claims.claim import SAME, SMALL, Claim, holding_range

CASES = ("case-2", "case-1.2", "case-1.1")


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
        for case, part in zip(CASES, (direct, once & above, once & ~above), strict=True):
            count[case] += int(part.sum())
            worst[case] = max(worst[case], float(difference[part].max(initial=0.0)))
    for case in CASES:
        yield Claim(
            f"curve-{case}",
            count[case] > 0 and worst[case] < SAME,
            {"largest difference": worst[case], "points": count[case]},
        )


def completeness(cubes: Sequence[xr.Dataset]) -> Claim:
    """Whether the closed forms give the outcome of every slender block of the spectrum cubes of the sine."""
    s, omega = cubes[0].slenderness.values, cubes[0].frequency_ratio.values
    areas, linear = node_areas(s, omega), node_areas(s, omega, logarithmic=False)
    a = 1 / s[:, None]
    outcomes, numbers, missed, missed_linear = [], {}, [], []
    for cube in cubes:
        slender = cube.sel(alpha=0.0)
        closed = overturning_amplitudes(omega, float(cube.restitution))
        predicted = ((a > closed.overturns_from) & (a < closed.survives_again)) | (a > closed.direct)
        wrong = predicted != (slender.outcome.values >= Outcome.OVERTURNED_DIRECTLY)
        outcomes.append(~wrong)
        everywhere = np.ones_like(wrong)
        missed.append(share_of_area(wrong, everywhere, areas))
        missed_linear.append(share_of_area(wrong, everywhere, linear))
        numbers[f"missed at eta {float(cube.restitution):.2f}"] = missed[-1]
    i, j = np.nonzero(~np.all(outcomes, axis=0))
    if i.size:
        numbers |= {"missed from 1/a": s[i].min(), "omega from": omega[j].min(), "to": omega[j].max()}
    numbers |= {"missed": float(np.mean(missed)), "missed, linear in omega": float(np.mean(missed_linear))}
    return Claim(
        "complete",
        1.0 - float(np.mean(missed)),
        numbers,
        within=holding_range(outcomes, {"1/a": s[:, None], "omega": omega}, weights=areas),
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


def limit_separates(omega: Floats, impact_below: Flags, impact_above: Flags) -> Claim:
    """(3.31): the curve on which the first impact coincides with the end of the pulse."""
    separates = impact_below & ~impact_above
    return Claim("limit-separates", float(separates.mean()), within=holding_range(separates, {"omega": omega}))


def limit_value(omega: Floats, slenderness: Floats) -> Claim:
    """How far the curve (3.31), 1/a over equidistant omega, is a line at 0.4."""
    rounds_to = (slenderness >= 0.35) & (slenderness < 0.45)
    return Claim(
        "limit-0.4",
        float(rounds_to.mean()),
        {"first": slenderness[0], "last": slenderness[-1]},
        within=holding_range(rounds_to, {"omega": omega}),
    )


def time_near_equilibrium(restitution: Sequence[float]) -> Floats:
    """For how long after the pulse blocks just above their threshold stay close to alpha, p t [-].

    The thresholds are those of the closed forms at several omega; a block is `STEP` above or, where it survives again,
    below. Negative if it has left alpha for good before the pulse ended.
    """
    times = []
    for eta in restitution:
        for omega in (1.0, 2.0, 3.0, 4.0):
            closed = overturning_amplitudes(omega, eta)
            for a in (
                closed.overturns_from * (1 + STEP),
                closed.survives_again * (1 - STEP),
                closed.direct * (1 + STEP),
            ):
                history = time_history(
                    "sine", slenderness=1 / a, frequency_ratio=omega, restitution=eta, duration=60.0, samples=6001
                )
                close = np.abs(np.abs(history.rotation.values) - 1) < SMALL
                last = history.tau.values[close].max(initial=-np.inf)
                times.append(float(last) - history.attrs["pulse_end"])
    return np.array(times)


def overturning_in_free_rocking(time_close: Floats) -> Claim:
    """(3.8): at the smallest amplitude that overturns, the block overturns after the pulse, slowing down near alpha."""
    after = time_close > 0.0
    return Claim(
        "free-rocking", float(after.mean()), {"thresholds": after.size, "shortest p t": float(time_close.min())}
    )
