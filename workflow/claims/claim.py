"""What was measured for a claim of the paper, and the verdict.

The paper states most of its claims in words. The thresholds below, which say what each word is taken to mean, and the
rule of the verdict are the same for all claims and do not depend on what is found. A word that names no number is not
judged: its row gives the measured numbers.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

IDENTITY = "identity"
HOLDS = "holds"
IN_RANGE = "holds within stated range"
MIXED = "mixed"
FAILS = "does not hold"
MEASURED = "measured, not judged"
VERDICTS = (IDENTITY, HOLDS, IN_RANGE, MIXED, FAILS, MEASURED)

PART = 0.5  # least share of what was tested that a stated range covers, and that meets a "mixed" claim [-]
SAME = 1e-9  # difference, relative or in 1/a, up to which two results are the same: "exact", "equal", "collapse" [-]
CLOSE = 0.01  # relative difference up to which two results "coincide" [-]
SMALL = 0.05  # relative difference that is "small", "excellent", or none "in practice" [-]
ABOUT = 0.25  # relative growth beyond which a peak "grows" [-]


class Range(NamedTuple):
    """A range in which all that was tested meets the claim."""

    text: str
    share: float  # of what was tested [-]


@dataclass(frozen=True)
class Claim:
    """What was measured for one row of `statements.md`, which says what the paper states and what is measured."""

    key: str  # that of the row
    share: float | None  # share of what was tested that meets the measure [-]; nan if nothing was, None: not judged
    numbers: Mapping[str, float] = field(default_factory=dict)  # the measured numbers [-]
    within: Range | None = None  # largest range in which all that was tested meets the measure
    identity: bool = False  # whether the claim is algebra, which can only hold

    @property
    def verdict(self) -> str:
        """One of `VERDICTS`."""
        if self.share is None:
            return MEASURED
        if self.share >= 1.0 - 1e-12:
            return IDENTITY if self.identity else HOLDS
        if self.identity or not self.share > 0.0:
            return FAILS
        if self.within is not None and self.within.share >= PART:
            return IN_RANGE
        return MIXED if self.share >= PART else FAILS

    def record(self) -> dict[str, Any]:
        """Mapping for JSON; numbers have six digits, so that rounding on other machines does not change them."""
        stated = self.within is not None and self.verdict in (IN_RANGE, MIXED)
        return asdict(self) | {
            "share": None if self.share is None else rounded(self.share),
            "numbers": {name: rounded(value) for name, value in self.numbers.items()},
            "within": self.within.text if self.within is not None and stated else None,
            "verdict": self.verdict,
        }


def rounded(value: float) -> float:
    """Return a number with six digits."""
    return float(f"{value:.6g}")


def holding_range(
    good: ArrayLike, parameters: Mapping[str, ArrayLike], *, tested: ArrayLike = True, weights: ArrayLike = 1.0
) -> Range | None:
    """Interval of one parameter in which all that was tested is good, the one that covers most; None without any.

    `parameters`: values by name, of shapes that broadcast to that of `good`, like `tested` and `weights`.
    """
    met = np.asarray(good, dtype=bool)
    here = np.broadcast_to(tested, met.shape)
    weight = np.broadcast_to(weights, met.shape)[here].astype(np.float64)
    best: Range | None = None
    for name, values in parameters.items():
        nodes, index = np.unique(np.broadcast_to(values, met.shape)[here], return_inverse=True)
        covered = np.bincount(index, weight, minlength=nodes.size)
        failing = np.bincount(index, ~met[here], minlength=nodes.size) > 0
        for run in np.split(np.arange(nodes.size), np.flatnonzero(failing)):
            kept = run[~failing[run]]
            share = covered[kept].sum() / max(covered.sum(), 1e-300)
            if kept.size and (best is None or share > best.share):
                best = Range(f"{name} {nodes[kept[0]]:.4g} to {nodes[kept[-1]]:.4g}", float(share))
    return best


def percent(share: float) -> str:
    """Share as text with two significant digits; only 0 and 1 are 0 % and 100 %."""
    digits = 2
    text = f"{100 * share:.{digits}g}"
    while share < 1.0 and float(text) == 100.0:
        digits += 1
        text = f"{100 * share:.{digits}g}"
    return f"{float(text):g} %"
