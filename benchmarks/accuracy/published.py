"""Numbers that others have published, and ours: `python -m benchmarks.accuracy.published` prints the table of
docs/published-results.md.

Formulas are evaluated here as printed, and compared with what the solver finds by bisection.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

import rocking


class Comparison(NamedTuple):
    """A published number, as `text` if it is a range.

    `tolerance` is the accuracy with which it is printed or was read off a figure, or that of the search.
    """

    source: str
    quantity: str
    published: float
    tolerance: float
    ours: Callable[[], float]
    text: str = ""


def amplitude(number: int, pulse: str, frequency_ratio: float, restitution: float, alpha: float | None = None) -> float:
    """The amplitude a_g/(g tan alpha) at which the outcome changes for the first, second, ... time."""
    found = rocking.thresholds(pulse, frequency_ratio=frequency_ratio, restitution=restitution, alpha=alpha)
    return float(found.amplitude[number - 1])


def rectangular_limit(duration: float) -> float:
    """Housner (1963): cosh(p t) = 1 + 1/(2 a (a - 1)) for a constant acceleration of the duration p t."""
    return brentq(lambda a: math.cosh(duration) - 1.0 - 0.5 / (a * (a - 1.0)), 1.0 + 1e-9, 1e3, xtol=1e-12)


def half_sine_limit(omega: float) -> float:
    """Shi et al. (1996): omega sin psi - cos psi = exp(-(pi - psi)/omega) at uplift, a = 1/sin psi."""
    psi = brentq(lambda x: omega * math.sin(x) - math.cos(x) - math.exp(-(math.pi - x) / omega), 1e-9, 0.5 * math.pi)
    return 1.0 / math.sin(psi)


def acceleration_of_cosine() -> float:
    """Peak acceleration [g] of a cosine pulse of 2 s from which a block of 15 degrees and p = 2 rad/s overturns."""
    alpha = math.radians(15.0)
    eta = 1.0 - 1.5 * math.sin(alpha) ** 2
    return amplitude(1, "cosine", 0.5 * math.pi, eta, alpha) * math.tan(alpha)


def sine_over_double_impulse(height_over_width: float) -> float:
    """The factor on the sine that is equivalent to the critical double impulse at which the sine overturns the block.

    Nabeshima et al. (2016): two equal and opposite velocities of the ground, the second one at the impact, overturn the
    block if its energy then suffices. The sine has the period of twice the interval and the same largest Fourier
    amplitude. Angular velocities are over p.
    """
    alpha = math.atan(1.0 / height_over_width)
    eta = 1.0 - 1.5 * math.sin(alpha) ** 2
    velocity = math.sqrt(2.0 * (1.0 - math.cos(alpha))) / (1.0 + eta)  # after each impulse, theta'/p
    peak = alpha - math.acos(math.cos(alpha) + 0.5 * velocity**2)

    def time(s: float) -> float:  # of the flight up to the peak, theta = peak - s^2
        return 2.0 * s / math.sqrt(2.0 * (math.cos(alpha - peak) - math.cos(alpha - peak + s * s)))

    interval = 2.0 * quad(time, 0.0, math.sqrt(peak))[0]
    spectrum = -minimize_scalar(lambda x: -math.sin(math.pi * x) / (1 - x * x), bounds=(0.3, 0.99)).fun
    omega = math.pi / interval
    equivalent = 0.5 * omega * (2.0 / spectrum) * velocity / math.sin(alpha)  # a_g/(g tan alpha)
    return amplitude(1, "sine", omega, eta, alpha) / equivalent


def half_sine_rule(omega: float) -> float:
    """How far sqrt(1 + (omega/p)^2) is above the amplitude at which half a sine overturns [-]."""
    return math.hypot(1.0, omega) / amplitude(1, "half_sine", omega, 0.9) - 1.0


def energy_kept(alpha: float) -> float:
    """Share of the energy that an impact of a block leaves."""
    return float(rocking.Block.from_slenderness_angle(alpha, 1.0).momentum_restitution ** 2)


ZHANG_MAKRIS = "Zhang & Makris (2001)"
COMPARISONS = (
    Comparison(
        ZHANG_MAKRIS, "one sine, omega/p = 5, eta 0.9: a overturns from", 3.01, 0.015,
        partial(amplitude, 1, "sine", 5, 0.9),
    ),
    Comparison(
        ZHANG_MAKRIS, "the same: survives again from", 6.33, 0.015, partial(amplitude, 2, "sine", 5, 0.9)
    ),
    Comparison(
        ZHANG_MAKRIS, "the same: without impact from", 7.18, 0.015, partial(amplitude, 3, "sine", 5, 0.9)
    ),
    Comparison(
        "Makris & Konstantinidis (2003)",
        "cosine of 2 s, alpha 15 deg, p 2 rad/s: peak acceleration [g] between standing and overturning",
        0.3155, 0.0005, acceleration_of_cosine, "0.315 to 0.316",
    ),
    *(
        Comparison(
            "Housner (1963)", f"constant acceleration, p t = {duration:g}: a overturns from",
            rectangular_limit(duration), 1e-6, partial(amplitude, 1, "rectangular", math.pi / duration, 0.9),
        )
        for duration in (0.5, 1.0, 2.0)
    ),
    *(
        Comparison(
            "Housner (1963)", f"alpha {alpha:g} rad: (1 - m R^2/I_0 (1 - cos 2 alpha))^2 of the energy after an impact",
            (1.0 - 0.75 * (1.0 - math.cos(2.0 * alpha))) ** 2, 1e-12, partial(energy_kept, alpha),
        )
        for alpha in (0.1, 0.3)
    ),
    *(
        Comparison(
            "Shi et al. (1996)", f"half a sine, omega/p = {omega:g}: a overturns from",
            half_sine_limit(omega), 1e-6, partial(amplitude, 1, "half_sine", omega, 0.9),
        )
        for omega in (1.0, 2.0, 3.0)
    ),
    *(
        Comparison(
            "Nabeshima et al. (2016)",
            f"one sine over the one equivalent to the critical double impulse, H/B = {ratio:g}: overturns from",
            1.535, 0.01, partial(sine_over_double_impulse, ratio), "1.53 to 1.54",
        )
        for ratio in (10.0, 5.0, 3.0)
    ),
)  # fmt: skip


def table() -> str:
    """The comparisons as rows of Markdown."""
    lines = ["| source | quantity | published | ours |", "|---|---|---|---|"]
    for one in COMPARISONS:
        digits = max(2, min(6, round(-math.log10(one.tolerance))))
        published = one.text or f"{one.published:.{digits}f}"
        found = f"{one.ours():.{digits + (digits < 6)}f}"
        lines.append(f"| {one.source} | {one.quantity} | {published} | {found} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
