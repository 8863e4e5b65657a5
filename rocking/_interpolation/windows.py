"""The slices of restitution and of slenderness angle from which points are interpolated.

Points on slice k form group 2 k, those between it and the next one group 2 k + 1: the points of a group are
interpolated from the same slices.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking._interpolation.slices import STENCIL_SIZE, slice_window
from rocking._interpolation.stencils import slice_products
from rocking._numba.compilation import FloatArray, SimdVector, contiguous_array, entry, kernel
from rocking._numba.simd import LANES, load, load_elements, select, splat, store

SLICE_WINDOW = np.dtype(
    [
        ("restitutions", np.float64, STENCIL_SIZE),
        ("products", np.float64, STENCIL_SIZE),
        ("lower", np.int64),
        ("size", np.int64),
        ("cells", np.int64, STENCIL_SIZE),
        ("peaks", np.int64, STENCIL_SIZE),
    ]
)
"""The slices of restitution from which points on one slice, or between the same two, are interpolated.

`restitutions` are those of the slices [-], `products` the denominators of their Lagrange weights; `lower` is the slice
at or below the restitutions of the points, `size` the number of slices used. `cells` and `peaks` are addresses of the
tables of each slice: of the array (n - 1, m - 1, angles) of `CELL_RECORD`, and of the peaks [-] in strips
(`rocking._interpolation.strips`); those from `size` on are not read.
"""


class AngleAxis(NamedTuple):
    """The slenderness angles of a cube.

    Attributes
    ----------
    angles, squares : float arrays (angles,)
        Ascending [rad], and their squares [rad2], the variable of interpolation: the equation of motion depends on the
        square of the angle only.
    products : float array (windows, STENCIL_SIZE)
        Denominators of the Lagrange weights of the windows that start at each angle.
    windows : int64 array (groups, 2)
        First angle and number of angles of each group of points.
    """

    angles: NDArray[np.float64]
    squares: NDArray[np.float64]
    products: NDArray[np.float64]
    windows: NDArray[np.int64]

    @classmethod
    def of(cls, angles: NDArray[np.float64]) -> AngleAxis:
        """The axis of some ascending angles [rad]."""
        size, squares = angles.size, angles**2
        windows = [slice_window(size, k // 2) if k % 2 else (k // 2, 1) for k in range(2 * size - 1)]
        return cls(contiguous_array(angles), squares, slice_products(squares), np.array(windows))


@entry
def group_points(
    values: FloatArray, slices: FloatArray, groups: FloatArray, present: FloatArray, lanes: FloatArray
) -> None:
    """Find the slices from which points are interpolated.

    Parameters
    ----------
    values : float array (points,)
        Restitutions [-] or angles [rad] of the points.
    slices : float array (n,)
        Those of the slices, ascending.
    groups : int32 array (points,), filled
        Groups of the points; -1 outside of the slices.
    present : bool array (2 n + 1,)
        Set to True for the groups of the points; the last element if some are outside of the slices.
    lanes : float array (LANES,)
        Working memory.
    """
    for start in range(0, len(values), LANES):
        size = min(LANES, len(values) - start)
        store(lanes, 0, groups_of(load_some(values, start, lanes), slices))
        for k in range(size):
            group = int(lanes[k])
            groups[start + k] = group
            present[group] = True


@kernel
def load_some(values: FloatArray, start: int, lanes: FloatArray) -> Any:
    """The values from `start` on in a vector; beyond the last of them those in `lanes`, which are overwritten."""
    if start + LANES <= len(values):
        return load_elements(values, start)
    for k in range(start, len(values)):
        lanes[k - start] = values[k]
    return load(lanes, 0)


@kernel
def groups_of(x: SimdVector, slices: FloatArray) -> Any:
    """The groups of points, -1 outside of the slices; slices at or below a point and slices below it are counted."""
    found, below = splat(-1.0), splat(0.0)
    for one in slices:
        found = select(x >= one, found + 1.0, found)
        below = select(x > one, below + 1.0, below)
    found += below
    return select(found < 2.0 * len(slices) - 1.0, found, splat(-1.0))
