"""Claims of section 5 on blocks that are not slender: similar blocks, dependence on alpha, the slender limit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rocking.boundary.amplitude import critical_amplitude
from rocking.closed_form import overturning_amplitudes
from rocking.model.response import Outcome
from rocking.solver.peak_response import peak_response
from workflow.claims.claim import Claim, verdict

ANGLES = (5, 10, 15, 20, 30)
"""Slenderness angles compared with the slender limit [deg]."""

TIP_ANGLES = (0, 5, 10, 15, 20)
"""Slenderness angles at which the tip of the overturning region is determined [deg]."""

SMALL = 0.05
"""Relative change that is considered small [-]; the paper gives no number."""

BEFORE_TIP = {"sine": (1.0, 2.0, 3.0, 4.0), "cosine": (1.0, 1.5, 2.0, 2.5)}
"""Frequency ratios well before the tip of the region of overturning after impacts [-]."""

BEYOND = {"sine": (5.0, 6.0, 8.0), "cosine": (3.0, 4.0, 5.0)}
"""Frequency ratios around the tip and beyond it [-]."""


def collapse(figure: xr.Dataset) -> list[Claim]:
    """Figure 9: thresholds of two blocks, each integrated in SI units, on one curve."""
    above = figure.threshold_overturns_above.values
    as_stated = (figure.threshold_falls_above.values == above) & (figure.threshold_falls_below.values == 1 - above)
    sizes = " and ".join(f"{R:g}" for R in figure.half_diagonal.values)
    step = float(figure.attrs["step"])
    return [
        Claim(
            key="similar-blocks",
            place="section 5, (5.3), figure 9",
            printed="overturning plots of geometrically similar blocks of different size collapse to one curve",
            found=f"blocks of R = {sizes} m at alpha = {np.degrees(figure.attrs['alpha']):.0f} degrees, integrated "
            f"with their dimensions by (2.2), change their outcome within a relative {step:.0e} of the one curve at "
            f"{int(as_stated.sum())} of {as_stated.size} thresholds",
            verdict=verdict(bool(as_stated.all()), somewhere=bool(as_stated.any())),
            numbers={"thresholds": as_stated.size, "on_the_curve": int(as_stated.sum()), "step": step},
        )
    ]


def dependence_on_alpha(restitution: float) -> list[Claim]:
    """Thresholds and tips of figure 10 compared with those of the slender limit."""
    before = {pulse: _changes(pulse, BEFORE_TIP[pulse], restitution) for pulse in BEFORE_TIP}
    beyond = {pulse: _changes(pulse, BEYOND[pulse], restitution) for pulse in BEYOND}
    small = all(found[angle] < SMALL for found in before.values() for angle in ANGLES if angle <= 15)
    tips = {pulse: {angle: _tip(pulse, angle, restitution) for angle in TIP_ANGLES} for pulse in BEFORE_TIP}
    return [
        Claim(
            key="alpha-thresholds",
            place="section 5, figure 10",
            printed="the dependence on alpha is relatively small for alpha < 15 degrees",
            found="largest relative change of a threshold from the slender limit, where there are as many: "
            + "; ".join(f"{pulse}, {_window(BEFORE_TIP[pulse])}: {_listed(before[pulse])}" for pulse in before)
            + ". Around the tip of the loop and beyond it more: "
            + "; ".join(f"{pulse}, {_window(BEYOND[pulse])}: {_listed(beyond[pulse])}" for pulse in beyond),
            verdict=verdict(
                small and all(found[15] < SMALL for found in beyond.values()),
                somewhere=small,
            ),
            numbers={
                f"{pulse}_{place}_{angle}_deg": change
                for place, found in (("before_tip", before), ("beyond", beyond))
                for pulse, changes in found.items()
                for angle, change in changes.items()
            },
        ),
        Claim(
            key="alpha-tip",
            place="section 5, figure 10",
            printed="the dependence on alpha is relatively small for alpha < 15 degrees",
            found="largest omega at which the block overturns after an impact: "
            + "; ".join(
                f"{pulse}: " + ", ".join(f"{tip:.2f} ({angle} degrees)" for angle, tip in found.items())
                for pulse, found in tips.items()
            ),
            verdict=verdict(
                all(abs(found[a] / found[0] - 1) < SMALL for found in tips.values() for a in found if a <= 15),
            ),
            numbers={f"{pulse}_{angle}_deg": tip for pulse, found in tips.items() for angle, tip in found.items()},
        ),
    ]


def _changes(pulse: str, omegas: tuple[float, ...], restitution: float) -> dict[int, float]:
    """Largest relative change of the thresholds by angle, where there are as many as in the slender limit."""
    worst = dict.fromkeys(ANGLES, 0.0)
    for omega in omegas:
        slender = critical_amplitude(pulse, frequency_ratio=omega, restitution=restitution)
        for angle in ANGLES:
            rigid = critical_amplitude(
                pulse, frequency_ratio=omega, restitution=restitution, alpha=float(np.radians(angle))
            )
            if np.array_equal(rigid.overturns_above, slender.overturns_above):
                change = float(np.abs(rigid.amplitude / slender.amplitude - 1).max())
                worst[angle] = max(worst[angle], change)
    return worst


def _tip(pulse: str, angle: float, restitution: float) -> float:
    """Largest frequency ratio at which the block overturns after an impact at some amplitude [-], to 0.05."""
    omega = np.arange(2.0, 8.0, 0.05)
    found = peak_response(
        pulse,
        slenderness=np.linspace(0.02, 0.6, 100)[:, None],
        frequency_ratio=omega,
        restitution=restitution,
        alpha=float(np.radians(angle)),
    )
    return float(omega[(found.outcome == Outcome.OVERTURNED_AFTER_IMPACT).any(axis=0)].max())


def _window(omegas: tuple[float, ...]) -> str:
    return f"omega {omegas[0]:g} to {omegas[-1]:g}"


def _listed(changes: Mapping[int, float]) -> str:
    return ", ".join(f"{100 * change:.2g} % ({angle} degrees)" for angle, change in changes.items())


def convergence(restitution: float) -> list[Claim]:
    """Convergence of the thresholds under the sine to the closed forms of section 3 as alpha decreases."""
    angles = (8.0, 4.0, 2.0)
    differences = np.array([list(_differences(angle, restitution)) for angle in angles])
    orders = np.log2(differences[:-1] / differences[1:])
    return [
        Claim(
            key="slender-limit",
            place="section 5, figure 10",
            printed="as alpha decreases the curves of the sine converge to the closed forms for slender blocks",
            found="the distance of the thresholds from (3.10), (3.18) and (3.20) with (3.21) decreases with alpha to "
            f"the power {orders.min():.3f} to {orders.max():.3f} between {angles[0]:g} and {angles[-1]:g} degrees; at "
            f"{angles[-1]:g} degrees it is at most {100 * differences[-1].max():.2g} %",
            verdict=verdict(bool(np.all(np.abs(orders - 2) < 0.2)), somewhere=bool(np.all(orders > 0))),
            numbers={"lowest_order": orders.min(), "highest_order": orders.max(), "largest": differences[-1].max()},
        )
    ]


def _differences(angle: float, restitution: float) -> Iterator[float]:
    """Relative distances of the three thresholds from the closed forms at some frequency ratios."""
    for omega in (3.0, 4.0):
        closed = overturning_amplitudes(omega, restitution)
        rigid = critical_amplitude(
            "sine", frequency_ratio=omega, restitution=restitution, alpha=float(np.radians(angle))
        )
        slender = np.array([closed.falls_from, closed.safe_again, closed.direct], dtype=np.float64)
        yield from np.abs(rigid.amplitude / slender - 1)


def uplift(restitution: float) -> list[Claim]:
    """Condition of uplift of a block that is not slender."""
    angles = np.radians(np.arange(1, 81))
    step = 1e-12

    def lifts(acceleration: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether a block at rest uplifts by (2.2), for a pulse to the right: about O, theta < 0."""
        return np.sin(angles) - acceleration * np.cos(angles) < 0

    exact = ~lifts(np.tan(angles) * (1 - step)) & lifts(np.tan(angles) * (1 + step))
    groups = {"frequency_ratio": 3.0, "restitution": restitution, "alpha": angles}
    for pulse in BEFORE_TIP:
        starts = [peak_response(pulse, slenderness=1 + sign * step, **groups).outcome for sign in (-1, 1)]
        exact &= (starts[0] != Outcome.NO_UPLIFT) & (starts[1] == Outcome.NO_UPLIFT)
    slender = float(np.tan(angles[19]) / angles[19] - 1)
    return [
        Claim(
            key="uplift",
            place="section 5, below (5.3)",
            printed="g tan(alpha)/a_g is exactly what decides whether a block starts to rock",
            found=f"so at {int(exact.sum())} of {exact.size} angles from 1 to 80 degrees, by the sign of (2.2) and by "
            f"the solver a relative {step:.0e} on either side; g alpha/a_g would be off by {100 * slender:.1f} % at "
            "20 degrees",
            verdict=verdict(bool(exact.all()), somewhere=bool(exact.any())),
            numbers={"angles": exact.size, "exact": int(exact.sum()), "slender_error_at_20_deg": slender},
        )
    ]


def expanded_equation() -> list[Claim]:
    """The second line of (5.1) compared with (2.2)."""
    alpha, theta, u = 0.3, -0.1, 0.2
    exact = np.sin(alpha + theta) - u * np.cos(alpha + theta)  # (2.2), theta < 0

    def expanded(last: float) -> float:
        return float(np.cos(alpha) * ((u * np.tan(alpha) + 1) * np.sin(theta) + last * np.cos(theta)))

    printed, corrected = expanded(u - np.tan(alpha)), expanded(np.tan(alpha) - u)
    return [
        Claim(
            key="expanded-equation",
            place="section 5, (5.1)",
            printed="for theta < 0 the equation of motion has (u/g - tan alpha) cos theta",
            found=f"at alpha = {alpha}, theta = {theta}, u/g = {u} (2.2) gives theta''/p^2 = {exact:.5f}, (5.1) as "
            f"printed {printed:.5f}, with (tan alpha - u/g) {corrected:.5f}",
            verdict=verdict(abs(printed - exact) < 1e-9, somewhere=False),
            numbers={"equation_of_motion": float(exact), "printed": printed, "corrected": corrected},
        )
    ]
