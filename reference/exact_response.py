"""Result of a multi-precision integration, and the working precision."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from flint import arb, ctx

NO_UPLIFT, RECOVERS, OVERTURNED_DIRECTLY, OVERTURNED_AFTER_IMPACT, CAPPED = 0, 1, 2, 3, -1


@dataclass
class ExactResponse:
    """Response of a block; times are tau = p t. Of a body with two edges p and alpha belong to the right one.

    `margin` is the distance of the deciding quantity from the barrier (> 0 overturns), `uplifts` counts uplifts from
    rest, `slowest_impact` is the smallest speed at an impact during the pulse. `peaks` are the largest |theta|/alpha on
    the right and the left edge, `peak_rotation` is the larger of |theta|/alpha_s.
    """

    outcome: int = NO_UPLIFT
    peak_rotation: arb | None = None
    peaks: tuple[arb, arb] | None = None
    impacts: int = 0
    chatter: bool = False
    exceeded_alpha: bool = False
    uplift_time: arb | None = None
    first_impact_time: arb | None = None
    first_impact_velocity: arb | None = None
    margin: arb | None = None
    uplifts: int = 0
    slowest_impact: arb | None = None

    @property
    def overturned(self) -> bool:
        return self.outcome >= OVERTURNED_DIRECTLY


@contextmanager
def working_precision(bits: int) -> Iterator[None]:
    """Compute with `bits` bits inside the with block."""
    previous = ctx.prec
    ctx.prec = bits
    try:
        yield
    finally:
        ctx.prec = previous
