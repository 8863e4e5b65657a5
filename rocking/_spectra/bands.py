"""Bands of rows into which spectrum cubes are divided.

A band is computed with a halo of rows that is cut off afterwards, so that its values are those of the whole cube bit
for bit. What is stored for cell i depends on the errors measured in the cells i - 1 to i + 1 (largest error of the
neighbourhood). Which probes are used in a cell depends on the errors at the first probes in the cells around it, hence
on the cells i - 2 to i + 2, and the stencil of a cell reaches from one node below its lower node to two above: nodes
i - 3 to i + 4. Cells at the edge of a grid are not interpolated; these are i - 3 and i + 3 here, which are not used.
"""

from __future__ import annotations

import math
from itertools import pairwise

HALO_BELOW, HALO_ABOVE = 3, 4
"""Rows of nodes that are computed besides those of a band, on either side."""


def bands(rows: int, height: int) -> list[tuple[int, int]]:
    """Bands of at most `height` rows that cover all rows, of nearly equal height.

    Parameters
    ----------
    rows, height : int
        At least 1.

    Returns
    -------
    list of (int, int)
        First row of each band, and the one after its last.
    """
    count = math.ceil(rows / height)
    starts = [rows * k // count for k in range(count + 1)]
    return list(pairwise(starts))


def rows_with_halo(band: tuple[int, int], rows: int) -> slice:
    """The rows, of `rows` in all, that are computed for a band."""
    first, last = band
    return slice(max(first - HALO_BELOW, 0), min(last + HALO_ABOVE, rows))
