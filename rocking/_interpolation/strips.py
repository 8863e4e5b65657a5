"""Tables of peaks in strips of columns, so that the nodes of a stencil lie in four adjacent cache lines.

A strip holds `STRIP_SIZE` columns, those of one cache line, for all rows; the next one starts `STRIP_STEP` columns
further. So each stencil lies in one strip. In a table without strips its four rows are in four places, and three of
eight rows cross the end of a cache line.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rocking._interpolation.slices import STENCIL_SIZE
from rocking._numba.compilation import jitable

NODE_BYTES, ROW_BYTES = 8, 64
"""Size of a value, and of a row of a strip, which is that of a cache line."""

STRIP_SIZE = ROW_BYTES // NODE_BYTES
"""Columns of a strip."""

STRIP_STEP = STRIP_SIZE - STENCIL_SIZE + 1
"""Columns from the first one of a strip to the first one of the next."""


@jitable
def strip_count(columns: int) -> int:
    """Strips of a table."""
    return (columns - STENCIL_SIZE) // STRIP_STEP + 1


def strips_of(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The strips (angles, strips, rows, STRIP_SIZE) of a table (angles, rows, columns).

    They are aligned to cache lines. Columns beyond those of the table are 0.
    """
    angles, rows, columns = values.shape
    shape = angles, strip_count(columns), rows, STRIP_SIZE
    size = NODE_BYTES * int(np.prod(shape))
    memory = np.zeros(size + ROW_BYTES, np.uint8)
    start = -memory.ctypes.data % ROW_BYTES
    strips = memory[start : start + size].view(np.float64).reshape(shape)
    for k in range(shape[1]):
        part = values[:, :, k * STRIP_STEP : k * STRIP_STEP + STRIP_SIZE]
        strips[:, k, :, : part.shape[2]] = part
    return strips
