"""Points of the control space: checked, broadcast and flattened arguments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._model.checks import broadcast_groups
from rocking._numba.compilation import contiguous_array

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Points:
    """Arguments of a response, all float arrays (points,); alpha in rad, 0 for the slender limit."""

    slenderness: Array
    frequency_ratio: Array
    restitution: Array
    alpha: Array

    @classmethod
    def of(
        cls, slenderness: ArrayLike, frequency_ratio: ArrayLike, restitution: ArrayLike, alpha: ArrayLike | None
    ) -> tuple[Points, tuple[int, ...]]:
        """The checked, broadcast and flattened arguments, and the broadcast shape.

        Raises
        ------
        InvalidArgumentError
            If a value is out of range, or the shapes do not broadcast.
        """
        full = broadcast_groups(slenderness, frequency_ratio, restitution, alpha)
        return cls(*(contiguous_array(group).ravel() for group in full)), full[0].shape

    def __getitem__(self, index: Any) -> Points:
        return Points(*(getattr(self, name)[index] for name in self.__dataclass_fields__))
