"""Cells that curves cross: every cell that a chord crosses, none far from it, whatever the spacing of the grid."""

from itertools import pairwise

import numpy as np
import pytest
import xarray as xr

from rocking._boundary.curves import crossed_cells
from tests.sampling import but_long

ROWS = np.sort(np.concatenate([np.linspace(0.1, 0.5, 9), np.linspace(0.52, 0.9, 21)]))  # of uneven spacing
COLUMNS = np.geomspace(0.5, 12.0, 25)
AXES = ROWS, np.log(COLUMNS)


def curves(polylines, alpha=0.0):
    points = np.concatenate(polylines)
    return xr.Dataset(
        {
            "slenderness": ("point", points[:, 0]),
            "frequency_ratio": ("point", np.exp(points[:, 1])),
            "row_size": ("curve", [len(line) for line in polylines]),
            "alpha": ("curve", np.full(len(polylines), alpha)),
        }
    )


def indices(points):
    """Row and column of the cells that hold points (points, 2), and which of these lie on the grid."""
    cell = np.stack([np.searchsorted(axis, x, side="right") - 1 for axis, x in zip(AXES, points.T, strict=True)])
    inside = ((cell >= 0) & (cell < np.array([[ROWS.size - 1], [COLUMNS.size - 1]]))).all(axis=0)
    return cell, inside


def cells_on_the_line(line):
    """Cells that hold one of very many points of a polyline."""
    share = np.linspace(0.0, 1.0, 200)[:, None]
    dense = np.concatenate([a + share * (b - a) for a, b in pairwise(line)])
    (i, j), inside = indices(dense)
    held = np.zeros((ROWS.size - 1, COLUMNS.size - 1), dtype=bool)
    held[i[inside], j[inside]] = True
    return held


def grown(cells):
    padded = np.pad(cells, 1)
    n, m = cells.shape
    return np.any([padded[i : i + n, j : j + m] for i in range(3) for j in range(3)], axis=0)


def wavy_line(rng):
    """A smooth polyline of chords shorter than a cell, partly outside the grid."""
    t = np.linspace(0.0, 1.0, 400)[:, None]
    wave = sum(rng.uniform(-0.3, 0.3, 2) * np.sin(k * np.pi * t + rng.uniform(0, 6, 2)) for k in (1, 2, 3))
    low, high = np.array([axis[0] for axis in AXES]), np.array([axis[-1] for axis in AXES])
    return 0.5 * (low + high) + (high - low) * wave


@pytest.mark.parametrize("seed", but_long(range(20), 0, 1, 2, 3))
def test_cells_of_a_curve(seed):
    rng = np.random.default_rng(seed)
    lines = [wavy_line(rng) for _ in range(2)]
    crossed = crossed_cells(curves(lines), 0.0, ROWS, COLUMNS)
    held = [cells_on_the_line(line) for line in lines]
    assert min(cells.sum() for cells in held) > 10
    for cells in held:
        assert not (cells & ~crossed).any()
    assert not (crossed & ~grown(held[0] | held[1])).any()  # in particular none between one curve and the next


def test_curves_of_other_angles_do_not_count():
    line = np.array([[0.3, 0.0], [0.7, 2.0]])
    assert not crossed_cells(curves([line], alpha=0.2), 0.0, ROWS, COLUMNS).any()
    assert crossed_cells(curves([line], alpha=0.2), 0.2, ROWS, COLUMNS).any()
