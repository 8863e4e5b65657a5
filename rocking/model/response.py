"""What a solver returns: fate, peak and events of one block or of a whole array of them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray


class Outcome(IntEnum):
    """Final fate of a block; not the same as passing theta = alpha, from where the ground can bring it back."""

    NO_UPLIFT = 0
    SAFE = 1
    OVERTURNED_DIRECTLY = 2
    OVERTURNED_AFTER_IMPACT = 3

    @property
    def sentence(self) -> str:
        """The fate in words."""
        return _SENTENCES[self]


_SENTENCES = {
    Outcome.NO_UPLIFT: "never uplifts",
    Outcome.SAFE: "rocks and comes to rest",
    Outcome.OVERTURNED_DIRECTLY: "overturns without impact",
    Outcome.OVERTURNED_AFTER_IMPACT: "overturns after one or more impacts",
}


@dataclass(frozen=True)
class Response:
    """Responses of blocks to a pulse; every field is an array of the broadcast shape of the question.

    Attributes
    ----------
    peak_rotation : float array [-]
        max |theta|/alpha over the whole response, free rocking included; 0 without uplift, nan where overturned.
    outcome : int8 array
        Code of `Outcome`.
    impacts : int32 array
        Impacts before the pulse ends, and the one after it upon which the block overturns. Impacts that chatter
        sums as a limit are not counted (`chatter`).
    chatter : bool array
        Impacts accumulated to rest within the pulse: `impacts` counts only those before the sum took over.
    exceeded_alpha : bool array
        |theta| passed alpha at some time.
    uplift_time : float array [-]
        tau = p t from the pulse's start to the first uplift; nan without uplift.
    first_impact_time : float array [-]
        tau from uplift to the first impact if that falls inside the pulse, else nan.
    first_impact_velocity : float array [-]
        d(theta/alpha)/d tau just before it, with its sign; nan likewise.
    peak_mode : int32 array
        Which lobe holds the peak: 2 x (impacts before it) + (1 if reached in free rocking), counted anew with every
        uplift from rest after the first, each of which adds 65536; -1 where there is none. Within one mode the peak
        is a smooth function of the groups.
    end_rotation, end_velocity : float arrays [-]
        |theta|/alpha and its rate with respect to tau at the end of the pulse, or when the block was known to overturn.
    """

    peak_rotation: NDArray[np.float64]
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]
    chatter: NDArray[np.bool_]
    exceeded_alpha: NDArray[np.bool_]
    uplift_time: NDArray[np.float64]
    first_impact_time: NDArray[np.float64]
    first_impact_velocity: NDArray[np.float64]
    peak_mode: NDArray[np.int32]
    end_rotation: NDArray[np.float64]
    end_velocity: NDArray[np.float64]

    @property
    def overturned(self) -> NDArray[np.bool_]:
        """Final fate: True where the block overturns."""
        return np.asarray(self.outcome >= Outcome.OVERTURNED_DIRECTLY)

    @property
    def shape(self) -> tuple[int, ...]:
        return self.peak_rotation.shape
