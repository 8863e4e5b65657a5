"""A quantitative claim of the paper, the criterion that decides it, what was found, and the verdict.

The paper states most of its claims in words. The thresholds below, which say what each word is taken to mean, and the
rule of the verdict are the same for all claims and do not depend on what is found.
"""

from dataclasses import asdict, dataclass, field
from typing import Any

HOLDS = "holds"
IN_RANGE = "holds within stated range"
FAILS = "does not hold"
VERDICTS = (HOLDS, IN_RANGE, FAILS)

PART = 0.5  # share of what was tested from which a claim is said to hold within a stated range [-]
SAME = 1e-9  # difference, relative or in 1/a, up to which two results are the same: "exact", "equal", "collapse" [-]
CLOSE = 0.01  # relative difference up to which two results "coincide" or are in "excellent" agreement [-]
SMALL = 0.05  # relative difference that is "small", "weak", "practically" nothing, or "accurate" [-]
FAIR = 0.20  # relative difference that is "satisfactory" [-]
ABOUT = 0.25  # relative difference up to which a number is "about" or "approximately" another [-]


@dataclass(frozen=True)
class Claim:
    """One row of the table of claims."""

    key: str  # short unique name
    place: str  # section and equation of the paper
    printed: str  # the statement of the paper, in short or with its numbers
    criterion: str  # what is tested, over which range, and the threshold; stated without looking at the result
    found: str  # what we found, with the range where it holds
    verdict: str  # one of `VERDICTS`
    numbers: dict[str, float] = field(default_factory=dict)  # the measured numbers behind `found` [-]

    def __post_init__(self) -> None:
        if self.verdict not in VERDICTS:
            raise ValueError(f"{self.key}: verdict {self.verdict!r} is none of {VERDICTS}")

    def record(self) -> dict[str, Any]:
        """A mapping for JSON; numbers with six digits, so that rounding on other machines does not change them."""
        return asdict(self) | {"numbers": {name: float(f"{value:.6g}") for name, value in self.numbers.items()}}


def verdict_of(share: float) -> str:
    """The verdict from the share of the tested cases, or of the tested area, that meets the criterion [-], [0, 1].

    `HOLDS` if all of it does, `IN_RANGE` from `PART` on, else `FAILS`. A criterion that is met or not is a share of 1
    or 0. Nothing tested, a share of nan, is `FAILS`.
    """
    return HOLDS if share >= 1.0 - 1e-12 else IN_RANGE if share >= PART else FAILS


def percent(share: float, digits: int = 2) -> str:
    """A share as text with `digits` significant digits; 100 % and 0 % are exact."""
    if 0.0 < share < 1.0:
        text = f"{100 * share:.{digits}g}"
        while float(text) == 100.0:
            digits += 1
            text = f"{100 * share:.{digits}g}"
        return f"{float(text):g} %"
    return f"{100 * share:.{digits}g} %" if share not in (0.0, 1.0) else f"{100 * share:.0f} %"
