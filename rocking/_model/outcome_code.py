"""One integer for the way in which a block overturns: outcome and number of impacts, and back.

The code is 0 where the block survives, and 4 impacts + outcome where it overturns: 2 without an impact, 7 after one
impact, 11 after two. The functions work on numpy arrays and inside compiled kernels.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking._model.outcome import Outcome
from rocking._numba.compilation import jitable

SURVIVES = 0  # code of a block that comes to rest or does not uplift

_DIRECTLY = int(Outcome.OVERTURNED_DIRECTLY)
_RECOVERS = int(Outcome.RECOVERS)


@jitable
def overturning_code(outcome: Any, impacts: Any) -> Any:
    """Code of a block, or of arrays of them of type int64."""
    return (4 * impacts + outcome) * (outcome >= _DIRECTLY)


@jitable
def outcome_of_code(code: Any) -> Any:
    """Code of `Outcome`; RECOVERS where the block survives."""
    return code % 4 + _RECOVERS * (code == SURVIVES)


@jitable
def impacts_of_code(code: Any) -> Any:
    """Impacts before overturning; 0 where the block survives."""
    return code // 4


def outcome_codes(outcome: NDArray[np.int8], impacts: NDArray[np.int32]) -> NDArray[np.int64]:
    """Codes of arrays of outcomes and impacts of one shape."""
    return np.asarray(overturning_code(outcome.astype(np.int64), impacts.astype(np.int64)))


def decode_outcomes(codes: NDArray[np.int64]) -> tuple[NDArray[np.int8], NDArray[np.int32]]:
    """Outcomes (RECOVERS where the block survives) and impacts of codes."""
    return outcome_of_code(codes).astype(np.int8), impacts_of_code(codes).astype(np.int32)
