"""One integer for the way in which a block overturns: outcome and number of impacts, and back.

The code is 0 where the block survives, and 4 impacts + outcome where it overturns: 2 without an impact, 7 after one
impact, 11 after two.
"""

import numpy as np
from numpy.typing import NDArray

from rocking._model.outcome import Outcome

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
