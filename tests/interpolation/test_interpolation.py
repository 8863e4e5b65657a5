"""Interpolation: exact for cubics, fourth order, beside nodes that are not valid, and between uneven slices."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rocking._base.errors import InvalidArgumentError
from rocking._interpolation.slices import STENCIL_SIZE, slice_window
from rocking._interpolation.stencils import (
    PEAK,
    Mesh,
    cell_of,
    interpolate_cells,
    interpolated_cells,
)

UNEVEN = np.cumsum([0.1, 0.1, 0.1, 0.05, 0.05, 0.02, 0.02, 0.3, 0.1, 0.1, 0.2, 0.1])


def interpolate(values, mesh, cells, codes, fractions):
    interpolated = np.empty(cells[0].size)
    interpolate_cells(values, *cells, codes, *mesh.within(cells, fractions), mesh, interpolated)
    return interpolated


def cubic(x, y):
    return (1 + x - 0.2 * x**2 + 0.03 * x**3) * (2 - y + 0.5 * y**2 - 0.1 * y**3)


def test_cubics_are_interpolated_exactly():
    mesh = Mesh.of(UNEVEN, np.exp(UNEVEN[:9]))
    values = cubic(mesh.rows[:, None], mesh.logs)
    valid = np.random.default_rng(1).random(values.shape) < 0.97
    values[~valid] = np.nan
    cells = np.nonzero(interpolated_cells(valid))
    assert cells[0].size > 10
    codes = np.full(cells[0].size, PEAK)
    for fractions in ((0.0, 0.0), (0.3, 0.9), (1.0, 0.5)):
        interpolated = interpolate(values, mesh, cells, codes, fractions)
        np.testing.assert_allclose(interpolated, cubic(*mesh.within(cells, fractions)), rtol=1e-12, atol=1e-12)


def test_error_decreases_with_the_fourth_power_of_the_step_on_uneven_axes():
    errors = []
    counts = np.array([20, 40, 80])
    for n in counts:
        axis = 0.1 + 0.8 * np.linspace(0.0, 1.0, n + 1) ** 1.5
        mesh = Mesh.of(axis, np.exp(axis))
        cells = np.nonzero(interpolated_cells(np.ones((n + 1, n + 1), dtype=bool)))
        codes = np.full(cells[0].size, PEAK)
        interpolated = interpolate(np.sin(3 * axis)[:, None] * np.cos(2 * axis), mesh, cells, codes, (0.5, 0.5))
        x, y = mesh.within(cells, (0.5, 0.5))
        errors.append(np.abs(interpolated - np.sin(3 * x) * np.cos(2 * y)).max())
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-4.0, abs=0.3)


def cells_of(axis, values):
    return [cell_of(axis, x) for x in values]


@given(st.lists(st.floats(1e-9, 1e3), min_size=4, max_size=30), st.lists(st.floats(0.0, 1e4), min_size=1, max_size=20))
def test_cells_are_those_of_a_binary_search(steps, fractions):
    axis = 0.01 + np.cumsum(steps)
    assume((np.diff(axis) > 0.0).all() and (np.diff(np.log(axis)) > 0.0).all())
    values = np.concatenate([axis, np.nextafter(axis, 0.0), axis[0] + np.minimum(fractions, axis[-1] - axis[0])])
    inside = values[(values >= axis[0]) & (values <= axis[-1])]
    expected = np.minimum(np.searchsorted(axis, inside, side="right") - 1, axis.size - 2)
    assert cells_of(axis, inside) == expected.tolist()


def test_grid_with_fewer_nodes_than_a_stencil_is_refused():
    with pytest.raises(InvalidArgumentError, match="at least 4 nodes"):
        Mesh.of(UNEVEN[:3], UNEVEN)


@pytest.mark.parametrize("count", range(2, 8))
def test_slice_window_is_the_nearest_four_slices(count):
    for lower in range(count - 1):
        first, size = slice_window(count, lower)
        assert size == min(count, STENCIL_SIZE)
        assert 0 <= first <= lower
        assert lower + 1 < first + size <= count
        below, above = lower + 1 - first, first + size - lower - 1
        assert below == above == 2 or first == 0 or first + size == count
