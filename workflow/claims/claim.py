"""A quantitative claim of the paper, the result, and the verdict."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

HOLDS = "holds"
IN_RANGE = "holds within stated range"
FAILS = "does not hold"
VERDICTS = (HOLDS, IN_RANGE, FAILS)


@dataclass(frozen=True)
class Claim:
    """One row of the table of claims.

    Attributes
    ----------
    key : str
        Short unique name.
    place : str
        Section and equation of the paper.
    printed : str
        The statement of the paper, in short or with its numbers.
    found : str
        What we found, with the range where it holds.
    verdict : str
        One of `VERDICTS`.
    numbers : mapping of str to float
        The measured numbers behind `found` [-].
    """

    key: str
    place: str
    printed: str
    found: str
    verdict: str
    numbers: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.verdict not in VERDICTS:
            raise ValueError(f"{self.key}: verdict {self.verdict!r} is none of {VERDICTS}")

    def record(self) -> dict[str, Any]:
        """A mapping for JSON; numbers with six digits, so that rounding on other machines does not change them."""
        return asdict(self) | {"numbers": {name: float(f"{value:.6g}") for name, value in self.numbers.items()}}


def verdict(everywhere: bool, somewhere: bool = True) -> str:
    """`HOLDS` if it holds everywhere that was examined, `IN_RANGE` if it holds in a part that `found` states."""
    return HOLDS if everywhere else IN_RANGE if somewhere else FAILS
