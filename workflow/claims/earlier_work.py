"""Claims on earlier work: forms in hyperbolic functions, measured restitution, and the time of the closed forms."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from rocking._model.block import RectangularBlock
from rocking.paper.motion import pulse_end
from rocking.paper.overturning import case_2_amplitude, limit_amplitude
from workflow.claims.area import Floats
from workflow.claims.claim import SAME, Claim

OMEGA = np.linspace(0.5, 15.0, 581)


def hyperbolic_residuals() -> dict[str, Floats]:
    """On the curves of (3.10) and (3.31): their conditions in hyperbolic functions, relative to a term of them."""
    found = {}
    for equation, a in (("(3.10)", case_2_amplitude(OMEGA)), ("(3.31)", limit_amplitude(OMEGA))):
        T, square = pulse_end(a, OMEGA), OMEGA**2 + 1
        cosh = OMEGA**2 / square  # of the motion from rest about the left corner, theta < 0
        sinh = -OMEGA * np.sqrt(a**2 - 1) / square
        rotation = -1 + cosh * np.cosh(T) + sinh * np.sinh(T)
        velocity = cosh * np.sinh(T) + sinh * np.cosh(T) + a * OMEGA / square
        unstable = rotation + velocity + 1  # theta/alpha + theta'/(p alpha) + 1 = 0 leads to the unstable equilibrium
        found[equation] = (unstable if equation == "(3.10)" else rotation) / (cosh * np.cosh(T))
    return found


def earlier_forms(residuals: dict[str, Floats]) -> Iterator[Claim]:
    """(3.10) and (3.31) and the forms in hyperbolic functions of the earlier papers."""
    printed = {
        "(3.10)": "(3.10) differs from the earlier equations only by exponential in place of hyperbolic functions",
        "(3.31)": "(3.31) is also offered by Anooshehpour et al. (1999)",
    }
    for equation, residual in residuals.items():
        largest = float(np.abs(residual).max())
        yield Claim(
            key=f"earlier-form-{equation[1:-1]}",
            place=f"section 3{'a' if equation == '(3.10)' else 'd'}, {equation}",
            printed=printed[equation],
            criterion="the motion from rest in hyperbolic functions, as the earlier papers write it, meets the same "
            f"condition on the curve of {equation}, within {SAME:.0e} of its largest term; {residual.size} frequency "
            f"ratios from {OMEGA[0]:g} to {OMEGA[-1]:g}. The form is derived here; the papers were not at hand",
            fails_if="only by a slip in one of the forms",
            found=f"largest residual {largest:.0e}",
            share=float((np.abs(residual) < SAME).mean()),
            identity=True,
            numbers={"largest_residual": largest},
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


def measured_restitution(specimens: Sequence[Specimen]) -> Iterator[Claim]:
    """Measured values of restitution against (2.4)."""
    by_geometry = {
        one.name: [RectangularBlock.from_slenderness_angle(alpha, 1.0).momentum_restitution for alpha in one.alpha]
        for one in specimens
    }
    outside = [
        not one.restitution[1] <= eta <= one.restitution[2] for one in specimens for eta in by_geometry[one.name]
    ]
    yield Claim(
        key="restitution-not-of-geometry",
        place="section 2b, below (2.4)",
        printed="the coefficient of restitution is not a function of the geometry solely",
        criterion="the value that fits the shaking-table tests of two granite specimens best, with its 95 % interval, "
        "excludes that of (2.4) at the slenderness angle that fits best and at the ends of its interval; share of "
        "these angles",
        fails_if="(2.4) is within the measured interval",
        found="; ".join(
            f"specimen {one.name}: {one.restitution[0]:.2f} ({one.restitution[1]:.2f} to {one.restitution[2]:.2f}), by "
            f"(2.4) {by_geometry[one.name][0]:.3f}"
            for one in specimens
        ),
        share=float(np.mean(outside)),
        numbers={f"by (2.4), specimen {name}": etas[0] for name, etas in by_geometry.items()},
    )


CLOSED_FORMS, TRACING = 99, 300
"""Processor time [ms] of the curves of one restitution, docs/benchmarks.md; a test compares the page."""


def quick_method(closed_forms: float, tracing: float) -> Iterator[Claim]:
    """The closed forms against tracing with the solver."""
    ratio = tracing / closed_forms
    yield Claim(
        key="quick-method",
        place="section 7",
        printed="the closed forms are a quick method for plotting overturning curves without extensive repeated "
        "simulation",
        criterion="at equal numbers of points they take less processor time than tracing the same curves with the "
        "solver; one restitution, slender block under the sine",
        fails_if="the searches for roots in the closed forms cost as much as the simulations that they replace",
        found=f"{closed_forms:g} ms against {tracing:g} ms, {ratio:.2g} times as fast, as measured in the benchmarks; "
        "SciPy's integrators, in place of the solver, take thousands of times as long for a block",
        share=ratio > 1,
        numbers={"closed_forms_ms": closed_forms, "tracing_ms": tracing},
    )
