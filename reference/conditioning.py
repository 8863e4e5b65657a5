"""Conditioning of the response: the part of an error that the rounding of the inputs explains.

The conditioning of a quantity is its change when an input changes by one unit in the last place of a double, the
largest over all inputs, by differences in multi-precision arithmetic with a relative step of 1e-30.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from flint import arb

from reference.exact_response import ExactResponse, working_precision
from reference.multiprecision import integrate

STEP = "1e-30"
MAX_IMPACTS = 100_000


class Conditioning(NamedTuple):
    """Change per unit in the last place: relative for peak and times, absolute for the margin; inf if events differ."""

    peak_rotation: float
    uplift_time: float
    first_impact_time: float
    margin: float


def integrate_with_conditioning(
    pulse: str,
    slenderness: float,
    frequency_ratio: float,
    restitution: float,
    alpha: float | None = None,
    bits: int = 192,
) -> tuple[ExactResponse, Conditioning]:
    """Return the response of a block and its conditioning [inputs as in `integrate`, exact doubles]."""
    inputs = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "restitution": restitution}
    if alpha is not None:
        inputs["alpha"] = alpha
    with working_precision(bits):
        response = integrate(pulse, **inputs, max_impacts=MAX_IMPACTS)
        worst = Conditioning(0.0, 0.0, 0.0, 0.0)
        for name, value in inputs.items():
            if value == 0.0:  # its last place is the smallest double: no change
                continue
            changed = {**inputs, name: arb(value) * (1 - arb(STEP))}
            moved = integrate(pulse, **changed, max_impacts=MAX_IMPACTS)
            places = math.ulp(value) / value
            worst = Conditioning(
                *(max(old, places * new) for old, new in zip(worst, _changes(response, moved), strict=True))
            )
    return response, worst


def _changes(response: ExactResponse, moved: ExactResponse) -> Conditioning:
    """Return the differences divided by the step."""
    if (response.outcome, response.first_impact_time is None) != (moved.outcome, moved.first_impact_time is None):
        return Conditioning(math.inf, math.inf, math.inf, math.inf)
    return Conditioning(
        _change(response.peak_rotation, moved.peak_rotation, relative=True),
        _change(response.uplift_time, moved.uplift_time, relative=True),
        _change(response.first_impact_time, moved.first_impact_time, relative=True),
        _change(response.margin, moved.margin, relative=False),
    )


def _change(before: arb | None, after: arb | None, *, relative: bool) -> float:
    if before is None or after is None or before == after:
        return 0.0
    change = abs(after - before) / arb(STEP)
    return float((change / abs(before) if relative else change).mid())
