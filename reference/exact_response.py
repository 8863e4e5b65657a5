"""What a multi-precision integration returns, and the precision that it runs at."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from flint import arb, ctx

NO_UPLIFT, SAFE, OVERTURNED_DIRECTLY, OVERTURNED_AFTER_IMPACT, CAPPED = 0, 1, 2, 3, -1


@dataclass
class ExactResponse:
    """What happened; times are tau = p t, `margin` is how far the deciding quantity is from the barrier (> 0 falls).

    `uplifts` are those from rest; `slowest_impact` is the smallest speed at an impact during the pulse.
    """

    outcome: int = NO_UPLIFT
    peak_rotation: arb | None = None
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
    """Compute with that many bits inside the block."""
    previous = ctx.prec
    ctx.prec = bits
    try:
        yield
    finally:
        ctx.prec = previous
