"""Claims on earlier work: hyperbolic forms, restitution by (2.4) and measured, time of the closed forms."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from rocking._history.contact import PRACTICAL_FRICTION
from rocking._model.block import RectangularBlock
from rocking._model.reactions import impulse_ratio
from rocking.paper.motion import pulse_end
from rocking.paper.overturning import case_2_amplitude, limit_amplitude
from workflow.claims.area import Flags, Floats
from workflow.claims.claim import SAME, Claim, holding_range

OMEGA = np.linspace(0.5, 15.0, 581)


def hyperbolic_residuals() -> dict[str, Floats]:
    """On the curves of (3.10) and (3.31): their conditions in hyperbolic functions, relative to a term of them."""
    residuals = {}
    for equation, a in (("3.10", case_2_amplitude(OMEGA)), ("3.31", limit_amplitude(OMEGA))):
        T, square = pulse_end(a, OMEGA), OMEGA**2 + 1
        cosh = OMEGA**2 / square  # of the motion from rest about the left corner, theta < 0
        sinh = -OMEGA * np.sqrt(a**2 - 1) / square
        rotation = -1 + cosh * np.cosh(T) + sinh * np.sinh(T)
        velocity = cosh * np.sinh(T) + sinh * np.cosh(T) + a * OMEGA / square
        unstable = rotation + velocity + 1  # theta/alpha + theta'/(p alpha) + 1 = 0 leads to the unstable equilibrium
        condition = unstable if equation == "3.10" else rotation
        residuals[equation] = condition / (cosh * np.cosh(T))
    return residuals


def earlier_forms(residuals: dict[str, Floats]) -> Iterator[Claim]:
    """(3.10) and (3.31) and the forms in hyperbolic functions of the earlier papers."""
    for equation, residual in residuals.items():
        yield Claim(
            f"earlier-form-{equation}",
            float((np.abs(residual) < SAME).mean()),
            {"largest residual": float(np.abs(residual).max())},
            identity=True,
        )


class Specimen(NamedTuple):
    """Restitution that was fitted to the tests of a specimen, with 95 % intervals."""

    name: str
    alpha: tuple[float, float, float]  # best value and interval [rad]
    restitution: tuple[float, float, float]


SPECIMENS = (
    Specimen("1", (0.061, 0.052, 0.075), (0.74, 0.71, 0.83)),
    Specimen("2", (0.110, 0.088, 0.124), (0.83, 0.77, 0.89)),
)
"""The two granite specimens of docs/shaking-table.md, 490 tests; a test compares the page."""


def measured_restitution(specimens: Sequence[Specimen]) -> Claim:
    """Measured values of restitution against (2.4)."""
    outside, numbers = [], {}
    for specimen in specimens:
        best, low, high = specimen.restitution
        by_geometry = [RectangularBlock.from_slenderness_angle(a, 1.0).momentum_restitution for a in specimen.alpha]
        outside += [not low <= eta <= high for eta in by_geometry]
        numbers |= {f"specimen {specimen.name}": best, f"by (2.4), specimen {specimen.name}": by_geometry[0]}
    return Claim("restitution-not-of-geometry", float(np.mean(outside)), numbers)


def impact_conditions() -> tuple[Floats, Floats, Flags]:
    """Slenderness angles [rad], the friction coefficient that the impact of (2.4) needs, and whether (2.4) is possible.

    It is not where (2.4) is negative: the impulse at the new corner would drive the old one into the ground.
    """
    alpha = np.radians(np.linspace(1.0, 89.0, 881))
    restitution = 1 - 1.5 * np.sin(alpha) ** 2  # (2.4)
    possible = restitution >= 0.0
    friction = [
        impulse_ratio(max(float(eta), 0.0), float(angle)) for eta, angle in zip(restitution, alpha, strict=True)
    ]
    return alpha, np.array(friction), possible


def slender_and_rough(alpha: Floats, friction: Floats, possible: Flags) -> Claim:
    """The two assumptions that the paper names for (2.4)."""
    valid = possible & (friction <= PRACTICAL_FRICTION)
    return Claim(
        "restitution-conditions",
        float(valid.mean()),
        {
            f"friction at {angle} degrees": float(np.interp(np.radians(angle), alpha, friction))
            for angle in (5, 15, 30, 45)
        },
        within=holding_range(valid, {"alpha [degrees]": np.degrees(alpha)}),
    )


CLOSED_FORMS, TRACING = 99, 300
"""Processor time [ms] of the curves of one restitution, docs/benchmarks.md; a test compares the page."""


def quick_method(closed_forms: float, tracing: float) -> Claim:
    """The closed forms against tracing with the solver."""
    return Claim("quick-method", tracing > closed_forms, {"closed forms [ms]": closed_forms, "tracing [ms]": tracing})
