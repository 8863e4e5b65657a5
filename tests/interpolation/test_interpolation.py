"""Interpolation: exact for cubics, fourth order, beside nodes that are not valid, and between uneven slices."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rocking._base.errors import InvalidArgumentError
from rocking._interpolation.kernel import Found, prepare
from rocking._interpolation.slices import STENCIL_SIZE, slice_index, slice_window
from rocking._interpolation.stencils import (
    PEAK,
    SQUARED,
    AngleAxis,
    Mesh,
    cell_of,
    interpolate_cells,
    interpolated_cells,
    lagrange_weight,
    lagrange_weights,
)

UNEVEN = np.cumsum([0.1, 0.1, 0.1, 0.05, 0.05, 0.02, 0.02, 0.3, 0.1, 0.1, 0.2, 0.1])


def interpolate(values, mesh, cells, codes, place):
    found = np.empty(cells[0].size)
    interpolate_cells(values, *cells, codes, *mesh.within(cells, place), mesh, found)
    return found


def test_weights_sum_to_one_and_are_unit_vectors_at_the_nodes():
    mesh = Mesh.of(UNEVEN, UNEVEN)
    for first in range(UNEVEN.size - 3):
        for x in np.linspace(UNEVEN[first], UNEVEN[first + 3], 31):
            assert sum(lagrange_weights(mesh.rows, first, x)) == pytest.approx(1.0, abs=1e-14)
        for k in range(4):
            at_node = lagrange_weights(mesh.rows, first, UNEVEN[first + k])
            np.testing.assert_array_equal(at_node, np.eye(4)[k])


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
    for place in ((0.0, 0.0), (0.3, 0.9), (1.0, 0.5)):
        found = interpolate(values, mesh, cells, codes, place)
        np.testing.assert_allclose(found, cubic(*mesh.within(cells, place)), rtol=1e-12, atol=1e-12)


def test_squared_cells_interpolate_the_square_of_one_minus_the_value():
    mesh = Mesh.of(UNEVEN, np.exp(UNEVEN))
    root = np.sqrt(0.1 + 0.2 * mesh.rows[:, None] * mesh.logs)
    cells = np.nonzero(interpolated_cells(np.ones(root.shape, dtype=bool)))
    found = interpolate(1.0 - root, mesh, cells, np.full(cells[0].size, SQUARED), (0.3, 0.6))
    x, y = mesh.within(cells, (0.3, 0.6))
    np.testing.assert_allclose(found, 0.1 + 0.2 * x * y, rtol=1e-12)


def test_error_decreases_with_the_fourth_power_of_the_step_on_uneven_axes():
    errors = []
    counts = np.array([20, 40, 80])
    for n in counts:
        axis = 0.1 + 0.8 * np.linspace(0.0, 1.0, n + 1) ** 1.5
        mesh = Mesh.of(axis, np.exp(axis))
        cells = np.nonzero(interpolated_cells(np.ones((n + 1, n + 1), dtype=bool)))
        codes = np.full(cells[0].size, PEAK)
        found = interpolate(np.sin(3 * axis)[:, None] * np.cos(2 * axis), mesh, cells, codes, (0.5, 0.5))
        x, y = mesh.within(cells, (0.5, 0.5))
        errors.append(np.abs(found - np.sin(3 * x) * np.cos(2 * y)).max())
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-4.0, abs=0.3)


def cells_of(axis, values):
    return [cell_of(axis, x) for x in values]


def test_cells_inside_and_outside_of_the_axis():
    assert cells_of(UNEVEN, UNEVEN) == [*range(11), 10]
    assert cells_of(UNEVEN, 0.5 * (UNEVEN[1:] + UNEVEN[:-1])) == list(range(11))
    assert cells_of(UNEVEN, [np.nextafter(UNEVEN[0], 0), np.nextafter(UNEVEN[-1], 9), np.nan, np.inf]) == [-1] * 4


@given(st.lists(st.floats(1e-9, 1e3), min_size=4, max_size=30), st.lists(st.floats(0.0, 1e4), min_size=1, max_size=20))
def test_cells_are_those_of_a_binary_search(steps, fractions):
    axis = 0.01 + np.cumsum(steps)
    assume((np.diff(axis) > 0.0).all() and (np.diff(np.log(axis)) > 0.0).all())
    values = np.concatenate([axis, np.nextafter(axis, 0.0), axis[0] + np.minimum(fractions, axis[-1] - axis[0])])
    inside = values[(values >= axis[0]) & (values <= axis[-1])]
    expected = np.minimum(np.searchsorted(axis, inside, side="right") - 1, axis.size - 2)
    assert cells_of(axis, inside) == expected.tolist()


def test_interpolated_cells_against_a_plain_loop():
    valid = np.random.default_rng(3).random((12, 9)) < 0.96
    expected = np.zeros((11, 8), dtype=bool)
    for i, j in np.ndindex(9, 6):
        expected[i + 1, j + 1] = valid[i : i + 4, j : j + 4].all()
    assert 0 < expected.sum() < 54
    np.testing.assert_array_equal(interpolated_cells(valid), expected)
    assert not interpolated_cells(np.ones((4, 4), dtype=bool))[[0, 2]].any()  # edges of the grid


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


@pytest.mark.parametrize("count", [2, 3, 4])
def test_slices_are_interpolated_exactly_up_to_their_degree(count):
    slices = np.sort(np.random.default_rng(4).uniform(0.5, 1.0, 7))
    for x in np.linspace(slices[2], slices[3], 7):
        weights = [lagrange_weight(slices, 2, count, k, x) for k in range(count)]
        found = np.dot(weights, slices[2 : 2 + count] ** (count - 1))
        assert found == pytest.approx(x ** (count - 1), rel=1e-12)


@pytest.mark.parametrize("count", [1, 15, 16, 17, 601])
def test_points_are_grouped_by_the_slices_that_they_need(count):
    rng = np.random.default_rng(6)
    slices = np.array([0.80, 0.85, 0.90, 0.94])
    eta = rng.permutation(np.concatenate([rng.uniform(0.75, 1.0, 500), rng.choice(slices, 100), [np.nan]]))[:count]
    slenderness, found = rng.uniform(0.5, 1.5, count), Found.zeros(count)
    groups, present = np.full(eta.size, -7), np.zeros(9, dtype=bool)
    assert prepare(slenderness, eta, slices, groups, present, found) == (slenderness >= 1.0).sum()
    np.testing.assert_array_equal(found.known, slenderness >= 1.0)
    below, on_slice = slice_index(slices, eta)
    np.testing.assert_array_equal(groups, np.where(below < 0, -1, 2 * below + ~on_slice))
    np.testing.assert_array_equal(np.flatnonzero(present[:-1]), np.unique(groups[groups >= 0]))
    assert present[-1] == (groups < 0).any()


def test_without_slices_all_points_are_outside():
    groups, present = np.zeros(20, dtype=np.int64), np.zeros(1, dtype=bool)
    prepare(np.full(20, 0.5), np.linspace(0.0, 1.0, 20), np.empty(0), groups, present, Found.zeros(20))
    assert present.all()
    assert (groups == -1).all()


@pytest.mark.parametrize("count", range(1, 8))
def test_angles_of_each_group(count):
    axis = AngleAxis.of(np.linspace(0.0, 0.5, count))
    assert axis.windows[::2].tolist() == [[k, 1] for k in range(count)]
    assert axis.windows[1::2].tolist() == [[*slice_window(count, k)] for k in range(count - 1)]


def test_value_on_a_slice():
    assert lagrange_weight(np.array([0.85]), 0, 1, 0, 0.85) == 1.0
    index, on_slice = slice_index(np.array([0.80, 0.85, 0.90]), [0.79, 0.80, 0.82, 0.85, 0.90, 0.91])
    np.testing.assert_array_equal(index, [-1, 0, 0, 1, 2, -1])
    np.testing.assert_array_equal(on_slice, [False, True, False, True, True, False])
    index, on_slice = slice_index(np.empty(0), [0.8, 0.9])
    np.testing.assert_array_equal(index, [-1, -1])
    assert not on_slice.any()
