"""A quantitative claim of the paper, the criterion that decides it, what was found, and the verdict.

The paper states most of its claims in words. The thresholds below, which say what each word is taken to mean, and the
rule of the verdict are the same for all claims and do not depend on what is found.
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
VERDICTS = (IDENTITY, HOLDS, IN_RANGE, MIXED, FAILS)

PART = 0.5  # least share of what was tested that a stated range covers, and that meets a "mixed" claim [-]
SAME = 1e-9  # difference, relative or in 1/a, up to which two results are the same: "exact", "equal", "collapse" [-]
CLOSE = 0.01  # relative difference up to which two results "coincide" or are in "excellent" agreement [-]
SMALL = 0.05  # relative difference that is "small", "weak", "practically" nothing, or "accurate" [-]
FAIR = 0.20  # relative difference that is "satisfactory" [-]
ABOUT = 0.25  # relative difference up to which a number is "about" or "approximately" another [-]


class Range(NamedTuple):
    """A range in which all that was tested meets the criterion."""

    text: str
    share: float  # of what was tested [-]


@dataclass(frozen=True)
class Claim:
    """One row of the table of claims."""

    key: str  # short unique name
    place: str  # section and equation of the paper
    printed: str  # the statement of the paper, in short or with its numbers
    criterion: str  # what is tested, over which range, and the threshold; stated without looking at the result
    fails_if: str  # how the claim could have failed
    found: str  # what we found
    share: float  # share of what was tested, cases or area, that meets the criterion [-]; nan if nothing was
    within: Range | None = None  # largest range in which all of it does
    identity: bool = False  # whether the claim is algebra, which can only hold
    numbers: dict[str, float] = field(default_factory=dict)  # the measured numbers behind `found` [-]

    @property
    def verdict(self) -> str:
        """One of `VERDICTS`."""
        if self.share >= 1.0 - 1e-12:
            return IDENTITY if self.identity else HOLDS
        if self.identity or not self.share > 0.0:
            return FAILS
        if self.within is not None and self.within.share >= PART:
            return IN_RANGE
        return MIXED if self.share >= PART else FAILS

    def record(self) -> dict[str, Any]:
        """A mapping for JSON; numbers with six digits, so that rounding on other machines does not change them."""
        stated = self.within.text if self.within is not None and self.verdict in (IN_RANGE, MIXED) else None
        numbers = {name: rounded(value) for name, value in self.numbers.items()}
        judged = {"share": rounded(self.share), "within": stated, "numbers": numbers, "verdict": self.verdict}
        return asdict(self) | judged


def rounded(value: float) -> float:
    """A number with six digits."""
    return float(f"{value:.6g}")


def holding_range(
    good: ArrayLike, parameters: Mapping[str, ArrayLike], *, tested: ArrayLike = True, weights: ArrayLike = 1.0
) -> Range | None:
    """The interval of one parameter in which all that was tested is good, the one that covers most; None without any.

    `parameters`: values by name, of shapes that broadcast to that of `good`, like `tested` and `weights`.
    """
    met = np.asarray(good, dtype=bool)
    here = np.broadcast_to(tested, met.shape)
    weight = np.broadcast_to(weights, met.shape)[here].astype(np.float64)
    best: Range | None = None
    for name, values in parameters.items():
        nodes, place = np.unique(np.broadcast_to(values, met.shape)[here], return_inverse=True)
        covered = np.bincount(place, weight, minlength=nodes.size)
        failing = np.bincount(place, ~met[here], minlength=nodes.size) > 0
        for run in np.split(np.arange(nodes.size), np.flatnonzero(failing)):
            kept = run[~failing[run]]
            share = covered[kept].sum() / max(covered.sum(), 1e-300)
            if kept.size and (best is None or share > best.share):
                best = Range(f"{name} {nodes[kept[0]]:.4g} to {nodes[kept[-1]]:.4g}", float(share))
    return best


def percent(share: float, digits: int = 2) -> str:
    """A share as text with `digits` significant digits; 100 % and 0 % are exact."""
    if 0.0 < share < 1.0:
        text = f"{100 * share:.{digits}g}"
        while float(text) == 100.0:
            digits += 1
            text = f"{100 * share:.{digits}g}"
        return f"{float(text):g} %"
    return f"{100 * share:.{digits}g} %" if share not in (0.0, 1.0) else f"{100 * share:.0f} %"
