"""The final outcome of a block, and the code of the way in which it overturns."""

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray


class Outcome(IntEnum):
    """Final outcome of a block. A block that passes theta = alpha need not overturn: the ground can bring it back."""

    NO_UPLIFT = 0
    RECOVERS = 1
    OVERTURNED_DIRECTLY = 2
    OVERTURNED_AFTER_IMPACT = 3

    @property
    def sentence(self) -> str:
        """The outcome in words, without a subject."""
        return _SENTENCES[self]

    @property
    def plural(self) -> str:
        """The outcome of several blocks in words."""
        return _PLURALS[self]


_SENTENCES = {
    Outcome.NO_UPLIFT: "never uplifts",
    Outcome.RECOVERS: "rocks and comes to rest",
    Outcome.OVERTURNED_DIRECTLY: "overturns without impact",
    Outcome.OVERTURNED_AFTER_IMPACT: "overturns after one or more impacts",
}

_PLURALS = {
    Outcome.NO_UPLIFT: "never uplift",
    Outcome.RECOVERS: "rock and come to rest",
    Outcome.OVERTURNED_DIRECTLY: "overturn without impact",
    Outcome.OVERTURNED_AFTER_IMPACT: "overturn after one or more impacts",
}


SURVIVES = 0  # code of a block that comes to rest or does not uplift


def outcome_codes(outcome: NDArray[np.int8], impacts: NDArray[np.int32]) -> NDArray[np.int64]:
    """Codes of arrays of outcomes and impacts of one shape."""
    codes = 4 * impacts.astype(np.int64) + outcome
    return np.asarray(np.where(outcome >= Outcome.OVERTURNED_DIRECTLY, codes, SURVIVES))


def impacts_of_code(codes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Impacts before overturning; 0 where the block survives, -1 of a negative code."""
    return codes // 4


def decode_outcomes(codes: NDArray[np.int64]) -> tuple[NDArray[np.int8], NDArray[np.int32]]:
    """Outcomes (RECOVERS where the block survives) and impacts of codes."""
    outcomes = np.where(codes == SURVIVES, Outcome.RECOVERS, codes % 4)
    return outcomes.astype(np.int8), impacts_of_code(codes).astype(np.int32)
