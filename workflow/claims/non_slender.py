"""Claims of section 5 on blocks that are not slender: similar blocks, dependence on alpha, the slender limit."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from rocking._boundary.amplitude import Thresholds, thresholds
from rocking._model.block import STANDARD_GRAVITY, RectangularBlock
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking.paper.overturning import overturning_amplitudes
from workflow.claims.area import Flags, Floats
from workflow.claims.claim import SAME, SMALL, Claim

ANGLES = (5.0, 10.0, 15.0, 20.0, 30.0)  # slenderness angles compared with the slender limit [deg]

FREQUENCY_RATIOS = {"sine": (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0), "cosine": (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)}
"""Frequency ratios before and beyond the tip of the region of overturning after impacts [-]."""


def collapse(figure: xr.Dataset) -> Claim:
    """Figure 9: thresholds of two blocks, each integrated in SI units, on one curve."""
    above = figure.threshold_overturns_above.values
    as_stated = (figure.threshold_falls_above.values == above) & (figure.threshold_falls_below.values == 1 - above)
    return Claim(
        "similar-blocks",
        float(as_stated.mean()),
        {"thresholds": as_stated.size, "on the curve": int(as_stated.sum())},
        identity=True,
    )


def other_slenderness(restitution: float) -> dict[float, Floats]:
    """Blocks with equal groups of (5.3) but cos(alpha): relative differences of g theta_max/a_g from 10 degrees."""
    alpha = np.radians([10.0, *(angle for angle in ANGLES if angle != 10.0)])[:, None, None]
    s, omega = np.linspace(0.05, 0.95, 60)[:, None], np.geomspace(0.5, 10.0, 60)
    by_pulse = [
        peak_response(pulse, slenderness=s, frequency_ratio=omega, restitution=restitution, alpha=alpha).peak_rotation
        for pulse in FREQUENCY_RATIOS
    ]
    peaks = np.stack(by_pulse, axis=1) * (alpha / np.tan(alpha))[:, None]
    differences = np.abs(peaks[1:] / peaks[0] - 1)
    angles = np.degrees(alpha.ravel()[1:])
    return {float(angle): row[np.isfinite(row)] for angle, row in zip(angles, differences, strict=True)}


def only_if_similar(differences: Mapping[float, Floats]) -> Claim:
    """Blocks that are not geometrically similar have other responses although their other groups are equal."""
    together = np.concatenate(list(differences.values()))
    numbers = {f"median at {angle:.0f} degrees": float(np.median(row)) for angle, row in differences.items()}
    return Claim("only-if-similar", float((together > SAME).mean()), numbers | {"smallest": float(together.min())})


class Case(NamedTuple):
    """The amplitudes at which the outcome changes, by angle [deg], 0 for the slender limit."""

    pulse: str
    frequency_ratio: float
    thresholds: Mapping[float, Thresholds]


def threshold_cases(restitution: float) -> list[Case]:
    """Thresholds of all angles at the frequency ratios of both pulses."""
    return [
        Case(pulse, omega, {angle: _thresholds(pulse, omega, restitution, angle) for angle in (0.0, *ANGLES)})
        for pulse, ratios in FREQUENCY_RATIOS.items()
        for omega in ratios
    ]


def _thresholds(pulse: str, omega: float, restitution: float, angle: float) -> Thresholds:
    return thresholds(pulse, frequency_ratio=omega, restitution=restitution, alpha=float(np.radians(angle)) or None)


def _change(case: Case, angle: float) -> float:
    """Largest relative change of a threshold from the slender limit; inf if there is another sequence of outcomes."""
    slender, rigid = case.thresholds[0.0], case.thresholds[angle]
    if not np.array_equal(slender.overturns_above, rigid.overturns_above):
        return np.inf
    return float(np.abs(rigid.amplitude / slender.amplitude - 1).max())


def contours(cases: Sequence[Case]) -> Claim:
    """Collapse of the first thresholds in the groups of (6.1)."""
    angles = [angle for angle in (0.0, *ANGLES) if angle <= 20]
    first = np.array([[case.thresholds[angle].amplitude[0] for angle in angles] for case in cases])
    variation = np.ptp(first, axis=1) / first[:, 0]
    together = float((variation <= SMALL).mean())
    return Claim("contours-collapse", together > 0.5, {"share of cases": together})


def dependence_on_alpha(cases: Sequence[Case], tips: Mapping[str, Mapping[float, float]]) -> Claim:
    """Thresholds and tips of figure 10 compared with those of the slender limit."""
    numbers = {}
    for angle in ANGLES:
        change = np.array([_change(case, angle) for case in cases])
        numbers[f"share at {angle:.0f} degrees"] = float((change <= SMALL).mean())
        numbers[f"other number at {angle:.0f} degrees"] = int(np.isinf(change).sum())
    for pulse, by_angle in tips.items():
        numbers |= {f"tip of the {pulse} at {angle:.0f} degrees": tip for angle, tip in by_angle.items()}
    return Claim("dependence-on-alpha", None, numbers)


def tips(restitution: float) -> dict[str, dict[float, float]]:
    """Largest omega at which the block overturns after an impact at some amplitude [-], to 0.05, by pulse and angle."""
    return {
        pulse: {angle: _tip(pulse, angle, restitution) for angle in (0.0, 5.0, 10.0, 15.0)}
        for pulse in FREQUENCY_RATIOS
    }


def _tip(pulse: str, angle: float, restitution: float) -> float:
    omega = np.arange(2.0, 8.0, 0.05)
    found = peak_response(
        pulse,
        slenderness=np.linspace(0.02, 0.6, 100)[:, None],
        frequency_ratio=omega,
        restitution=restitution,
        alpha=float(np.radians(angle)),
    )
    return float(omega[(found.outcome == Outcome.OVERTURNED_AFTER_IMPACT).any(axis=0)].max())


CONVERGENCE_ANGLES = (8.0, 4.0, 2.0)
"""Angles, each half the one before, at which the distance from the closed forms is measured [deg]."""


def distances_from_closed_forms(restitution: float) -> Floats:
    """Relative distances of thresholds under the sine from the closed forms, (angle, threshold)."""
    return np.array([list(_distances(angle, restitution)) for angle in CONVERGENCE_ANGLES])


def _distances(angle: float, restitution: float) -> Iterator[float]:
    for omega in (3.0, 4.0):
        closed = overturning_amplitudes(omega, restitution)
        rigid = _thresholds("sine", omega, restitution, angle)
        slender = np.array([closed.overturns_from, closed.survives_again, closed.direct], dtype=np.float64)
        yield from np.abs(rigid.amplitude / slender - 1)


def convergence(distances: Floats) -> Claim:
    """Convergence of the thresholds under the sine to the closed forms of section 3 as alpha decreases."""
    orders = np.log2(distances[:-1] / distances[1:])
    return Claim(
        "slender-limit",
        float((np.abs(orders - 2) < 0.2).mean()),
        {"lowest power": orders.min(), "highest power": orders.max(), "largest": distances[-1].max()},
    )


STEP = 1e-9  # relative distance from g tan(alpha) at which it is tested whether a block uplifts [-]


def uplifts() -> tuple[Floats, Flags, Flags]:
    """Angles [rad], and whether blocks uplift just below and just above g tan(alpha).

    Decided by the moments of inertia and weight about the corner, h m a_g and b m g, of blocks of given sides.
    """
    blocks = [RectangularBlock(2 * float(b), 2.0) for b in np.linspace(0.02, 5.0, 80)]
    angles = np.array([block.alpha for block in blocks])
    height = np.array([block.half_height for block in blocks])
    weight = STANDARD_GRAVITY * np.array([block.half_width for block in blocks])
    below, above = (STANDARD_GRAVITY * np.tan(angles) * (1 + step) * height > weight for step in (-STEP, STEP))
    return angles, below, above


def uplift(angles: Floats, below: Flags, above: Flags) -> Claim:
    """The condition of uplift of a block that is not slender."""
    exact = ~below & above
    twenty = np.radians(20.0)
    return Claim(
        "uplift",
        float(exact.mean()),
        {
            "angles": angles.size,
            "exact": int(exact.sum()),
            "error of g alpha at 20 degrees": float(np.tan(twenty) / twenty - 1),
        },
        identity=True,
    )
