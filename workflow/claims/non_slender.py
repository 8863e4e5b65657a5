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
from workflow.claims.claim import SAME, SMALL, Claim, holding_range, percent

ANGLES = (5.0, 10.0, 15.0, 20.0, 30.0)  # slenderness angles compared with the slender limit [deg]
LESS_THAN_15 = 15.0  # the angle up to which the paper calls the dependence on alpha relatively small [deg]

FREQUENCY_RATIOS = {"sine": (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0), "cosine": (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)}
"""Frequency ratios before and beyond the tip of the region of overturning after impacts [-]."""


def collapse(figure: xr.Dataset) -> Iterator[Claim]:
    """Figure 9: thresholds of two blocks, each integrated in SI units, on one curve."""
    above = figure.threshold_overturns_above.values
    as_stated = (figure.threshold_falls_above.values == above) & (figure.threshold_falls_below.values == 1 - above)
    sizes = " and ".join(f"{R:g}" for R in figure.half_diagonal.values)
    step = float(figure.attrs["step"])
    yield Claim(
        key="similar-blocks",
        fails_if="only by an error of an integration: the groups are a change of variables in (2.2)",
        identity=True,
        place="section 5, (5.3), figure 9",
        printed="overturning plots of geometrically similar blocks of different size collapse to one curve",
        criterion=f"blocks of R = {sizes} m at alpha = {np.degrees(figure.attrs['alpha']):.0f} degrees, integrated in "
        f"SI units by (2.2), change their outcome within a relative {step:.0e} of the one curve",
        found=f"at {int(as_stated.sum())} of {as_stated.size} thresholds",
        share=float(as_stated.mean()),
        numbers={"thresholds": as_stated.size, "on_the_curve": int(as_stated.sum()), "step": step},
    )


def other_slenderness(restitution: float) -> dict[float, Floats]:
    """Blocks with equal groups of (5.3) but cos(alpha): relative differences of g theta_max/a_g from 10 degrees."""
    alpha = np.radians([10.0, *(angle for angle in ANGLES if angle != 10.0)])[:, None, None]
    found = [
        peak_response(
            pulse,
            slenderness=np.linspace(0.05, 0.95, 60)[:, None],
            frequency_ratio=np.geomspace(0.5, 10.0, 60),
            restitution=restitution,
            alpha=alpha,
        ).peak_rotation
        * alpha
        / np.tan(alpha)
        for pulse in FREQUENCY_RATIOS
    ]
    differences = np.abs(np.stack(found, axis=1) / np.array(found)[:, 0] - 1)
    return {
        float(np.degrees(angle)): one[np.isfinite(one)]
        for angle, one in zip(alpha.ravel()[1:], differences[1:], strict=True)
    }


def only_if_similar(differences: Mapping[float, Floats]) -> Iterator[Claim]:
    """Blocks that are not geometrically similar have other responses although their other groups are equal."""
    together = np.concatenate(list(differences.values()))
    yield Claim(
        key="only-if-similar",
        fails_if="cos(alpha) has no effect of its own",
        place="section 5, below (5.3)",
        printed="non-slender blocks can be self-similar only if they are geometrically similar",
        criterion="with equal omega, g tan(alpha)/a_g and eta, g theta_max/a_g of blocks of other angles differs from "
        f"that at 10 degrees by more than a relative {SAME:.0e} where both survive; sine and cosine, 60 x 60 blocks, "
        "1/a 0.05 to 0.95, omega 0.5 to 10",
        found=f"for {int((together > SAME).sum())} of {together.size}; median difference "
        + ", ".join(f"{percent(float(np.median(one)))} ({angle:.0f} degrees)" for angle, one in differences.items()),
        share=float((together > SAME).mean()),
        numbers={f"median_{angle:.0f}_deg": float(np.median(one)) for angle, one in differences.items()}
        | {"smallest": float(together.min())},
    )


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


def dependence_on_alpha(cases: Sequence[Case]) -> Iterator[Claim]:
    """Thresholds of figure 10 compared with those of the slender limit, and their collapse in the groups of (6.1)."""
    change = {angle: np.array([_change(case, angle) for case in cases]) for angle in ANGLES}
    tested = np.array([values for angle, values in change.items() if angle <= LESS_THAN_15])
    angles = np.array([angle for angle in ANGLES if angle <= LESS_THAN_15])[:, None]
    listed = "; ".join(
        f"{angle:.0f} degrees: {int((values <= SMALL).sum())} of {values.size}, median "
        f"{percent(float(np.median(values)))}, {int(np.isinf(values).sum())} with another number of thresholds"
        for angle, values in change.items()
    )
    first = np.array(
        [[case.thresholds[angle].amplitude[0] for angle in (0.0, *ANGLES) if angle <= 20] for case in cases]
    )
    together = np.ptp(first, axis=1) / first[:, 0] <= SMALL
    ratios = "; ".join(f"{pulse}, omega {w[0]:g} to {w[-1]:g}" for pulse, w in FREQUENCY_RATIOS.items())
    yield Claim(
        key="alpha-thresholds",
        fails_if="thresholds appear, vanish or move with alpha",
        place="section 5, figure 10",
        printed="the dependence of overturning on alpha is relatively small for alpha < 15 degrees",
        criterion="at 5, 10 and 15 degrees as many amplitudes change the outcome as for the slender block, and each "
        f"differs by at most {percent(SMALL)}; {ratios}; share of cases",
        found=f"for {int((tested <= SMALL).sum())} of {tested.size} cases. By angle: {listed}",
        share=float((tested <= SMALL).mean()),
        within=holding_range(
            tested <= SMALL, {"alpha [degrees]": angles, "omega": [case.frequency_ratio for case in cases]}
        ),
        numbers={f"share_{angle:.0f}_deg": float((values <= SMALL).mean()) for angle, values in change.items()}
        | {f"other_number_{angle:.0f}_deg": int(np.isinf(values).sum()) for angle, values in change.items()},
    )
    yield Claim(
        key="contours-collapse",
        fails_if="the thresholds move with alpha in half of the cases or more",
        place="section 6, below figure 13",
        printed="in most cases the overturning contours for different alpha collapse to a single curve in the "
        "groups of (6.1)",
        criterion=f"the smallest amplitude a_g/(g tan alpha) that overturns varies by at most {percent(SMALL)} from 0 "
        f"to 20 degrees in more than half of the cases; {ratios}",
        found=f"in {int(together.sum())} of {together.size} cases; median "
        f"{percent(float(np.median(np.ptp(first, axis=1) / first[:, 0])))}",
        share=bool(together.mean() > 0.5),
        numbers={"share of cases": float(together.mean())},
    )


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


def tip_of_the_loop(found: Mapping[str, Mapping[float, float]]) -> Iterator[Claim]:
    """The tip of the region of overturning after an impact by alpha."""
    changes = {
        (pulse, angle): abs(tips[angle] / tips[0.0] - 1) for pulse, tips in found.items() for angle in tips if angle > 0
    }
    small = [change <= SMALL for change in changes.values()]
    yield Claim(
        key="alpha-tip",
        fails_if="the tip moves with alpha",
        place="section 5, figure 10",
        printed="the dependence of overturning on alpha is relatively small for alpha < 15 degrees",
        criterion="the largest omega at which a block overturns after an impact differs from that of the slender block "
        f"by at most {percent(SMALL)} at 5, 10 and 15 degrees, sine and cosine; share of cases",
        found=f"in {sum(small)} of {len(small)} cases; largest omega: "
        + "; ".join(
            f"{pulse}: " + ", ".join(f"{tip:.2f} ({angle:.0f} degrees)" for angle, tip in tips.items())
            for pulse, tips in found.items()
        ),
        share=float(np.mean(small)),
        within=holding_range(small, {"alpha [degrees]": [angle for _, angle in changes]}),
        numbers={f"{pulse}_{angle:.0f}_deg": tip for pulse, tips in found.items() for angle, tip in tips.items()},
    )


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


def convergence(distances: Floats) -> Iterator[Claim]:
    """Convergence of the thresholds under the sine to the closed forms of section 3 as alpha decreases."""
    orders = np.log2(distances[:-1] / distances[1:])
    halved = np.abs(orders - 2) < 0.2
    yield Claim(
        key="slender-limit",
        fails_if="the closed forms are not the limit, so that the distance stops falling",
        place="section 5, figure 10",
        printed="as alpha decreases the curves of the sine converge to the closed forms for slender blocks",
        criterion="their distance falls with the square of alpha, as the terms that the linearisation drops: by a "
        f"power of 1.8 to 2.2 from {CONVERGENCE_ANGLES[0]:g} to {CONVERGENCE_ANGLES[-1]:g} degrees; six thresholds at "
        "omega 3 and 4",
        found=f"by a power of {orders.min():.3f} to {orders.max():.3f}; at {CONVERGENCE_ANGLES[-1]:g} degrees the "
        f"distance is at most {percent(float(distances[-1].max()))}",
        share=float(halved.mean()),
        numbers={"lowest_order": orders.min(), "highest_order": orders.max(), "largest": distances[-1].max()},
    )


STEP = 1e-9  # relative distance from g tan(alpha) at which it is tested whether a block uplifts [-]


def uplifts() -> tuple[Floats, Flags, Flags]:
    """Angles [rad], and whether blocks uplift just below and just above g tan(alpha).

    Decided by the moments of inertia and weight about the corner, h m a_g and b m g, of blocks of given sides.
    """
    blocks = [RectangularBlock(2 * float(b), 2.0) for b in np.linspace(0.02, 5.0, 80)]
    angles = np.array([block.alpha for block in blocks])
    below, above = (
        STANDARD_GRAVITY * np.tan(angles) * (1 + step) * [block.half_height for block in blocks]
        > STANDARD_GRAVITY * np.array([block.half_width for block in blocks])
        for step in (-STEP, STEP)
    )
    return angles, below, above


def uplift(angles: Floats, below: Flags, above: Flags) -> Iterator[Claim]:
    """The condition of uplift of a block that is not slender."""
    exact = ~below & above
    twenty = np.radians(20.0)
    slender = float(np.tan(twenty) / twenty - 1)
    yield Claim(
        key="uplift",
        fails_if="only by a slip: both sides are moments about the corner",
        identity=True,
        place="section 5, below (5.3)",
        printed="g tan(alpha)/a_g is exactly what decides whether a block enters rocking",
        criterion=f"a ground acceleration a relative {STEP:.0e} above g tan(alpha) has a larger moment about the "
        f"corner than the weight of the block, one below it has not; {angles.size} angles from "
        f"{np.degrees(angles[0]):.0f} to {np.degrees(angles[-1]):.0f} degrees",
        found=f"so at {int(exact.sum())} of them; with g alpha the condition would be off by {percent(slender)} "
        f"at 20 degrees",
        share=float(exact.mean()),
        numbers={"angles": angles.size, "exact": int(exact.sum()), "slender_error_at_20_deg": slender},
    )
