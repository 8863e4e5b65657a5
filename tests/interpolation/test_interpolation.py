"""Interpolation: exact for cubics, of fourth order, next to nodes that may not serve, and between uneven levels."""

import numpy as np
import pytest

from rocking.errors import InvalidArgumentError
from rocking.interpolation.selection import choose_stencils, interpolate_cells
from rocking.interpolation.stencils import (
    SLICE_STENCILS,
    SQUARED,
    STENCIL_SHIFTS,
    STENCIL_SIZE,
    Mesh,
    cell_index,
    first_valid_stencils,
    lagrange_weight,
    lagrange_weights,
    slice_index,
)

UNEVEN = np.cumsum([0.1, 0.1, 0.1, 0.05, 0.05, 0.02, 0.02, 0.3, 0.1, 0.1, 0.2, 0.1])


def interpolate(values, mesh, cells, codes, place):
    """At one place within each of some cells."""
    found = np.empty(cells[0].size)
    interpolate_cells(values, *cells, codes, *mesh.within(cells, place), mesh, found)
    return found


def test_weights_add_up_to_one_and_pick_the_nodes():
    mesh = Mesh.of(UNEVEN, UNEVEN)
    for first in range(UNEVEN.size - 3):
        for x in np.linspace(UNEVEN[first], UNEVEN[first + 3], 31):
            assert sum(lagrange_weights(mesh.rows, mesh.row_products, first, x)) == pytest.approx(1.0, abs=1e-14)
        for k in range(4):
            at_node = lagrange_weights(mesh.rows, mesh.row_products, first, UNEVEN[first + k])
            np.testing.assert_array_equal(at_node, np.eye(4)[k])


def cubic(x, y):
    return (1 + x - 0.2 * x**2 + 0.03 * x**3) * (2 - y + 0.5 * y**2 - 0.1 * y**3)


def test_cubics_are_interpolated_exactly_whichever_nodes_serve():
    rng = np.random.default_rng(1)
    mesh = Mesh.of(UNEVEN, np.exp(UNEVEN[:9]))
    values = cubic(mesh.rows[:, None], mesh.columns)
    serves = rng.random(values.shape) < 0.93
    codes = first_valid_stencils(serves)
    values[~serves] = np.nan
    assert len(np.unique(codes)) == len(STENCIL_SHIFTS) + 1  # each of them, and none
    cells = np.nonzero(codes >= 0)
    for place in ((0.0, 0.0), (0.3, 0.9), (1.0, 0.5)):
        found = interpolate(values, mesh, cells, codes[cells], place)
        np.testing.assert_allclose(found, cubic(*mesh.within(cells, place)), rtol=1e-12, atol=1e-12)


def test_every_stencil_holds_its_cell():
    """Between the first and the last of four nodes: a cell beside them would be extrapolated."""
    assert {shift for both in STENCIL_SHIFTS for shift in both} == set(range(STENCIL_SIZE - 1))
    assert len(set(STENCIL_SHIFTS)) == len(STENCIL_SHIFTS)
    for count, below in SLICE_STENCILS:
        assert 0 <= below <= count - 2


def test_error_falls_with_the_fourth_power_of_the_step_on_uneven_axes_too():
    errors = []
    counts = np.array([20, 40, 80])
    for n in counts:
        axis = 0.1 + 0.8 * np.linspace(0.0, 1.0, n + 1) ** 1.5
        mesh = Mesh.of(axis, np.exp(axis))
        cells = tuple(index.ravel() for index in np.indices((n, n)))
        codes = first_valid_stencils(np.ones((n + 1, n + 1), dtype=bool))[cells]
        found = interpolate(np.sin(3 * axis)[:, None] * np.cos(2 * axis), mesh, cells, codes, (0.5, 0.5))
        x, y = mesh.within(cells, (0.5, 0.5))
        errors.append(np.abs(found - np.sin(3 * x) * np.cos(2 * y)).max())
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-4.0, abs=0.3)


def test_cells_hold_their_nodes_and_nothing_outside():
    np.testing.assert_array_equal(cell_index(UNEVEN, UNEVEN), [*range(11), 10])
    np.testing.assert_array_equal(cell_index(UNEVEN, 0.5 * (UNEVEN[1:] + UNEVEN[:-1])), np.arange(11))
    outside = [np.nextafter(UNEVEN[0], 0), np.nextafter(UNEVEN[-1], 9), -1.0, np.nan, np.inf]
    np.testing.assert_array_equal(cell_index(UNEVEN, outside), -1)


@pytest.mark.parametrize("form", ["peak", "squared"])
def test_beside_a_crease_the_stencil_on_the_same_side_is_chosen(form):
    """The crease lies on a row: stencils that do not cross it are exact, as each side is a cubic in what is best."""
    axis = np.arange(12.0) / 12
    mesh = Mesh.of(axis, np.exp(axis))

    def value(x, y):
        smooth = np.where(x < axis[6], 0.2 + 0.1 * x * y, 0.2 + 0.1 * axis[6] * y + 0.5 * (x - axis[6]))
        return smooth if form == "peak" else 1.0 - np.sqrt(smooth)

    values = value(axis[:, None], axis)
    i, j = (index.ravel() for index in np.indices((11, 11)))
    places = ((0.5, 0.5), (0.2, 0.3), (0.7, 0.9))
    x, y = (np.array(parts) for parts in zip(*(mesh.within((i, j), place) for place in places), strict=True))
    codes, errors = first_valid_stencils(np.ones(values.shape, dtype=bool))[i, j], np.empty(i.size)
    choose_stencils(values, i, j, x, y, value(x, y), mesh, codes, errors)
    assert errors.max() < 1e-14
    expected = value(*mesh.within((i, j), (0.4, 0.6)))
    squared = codes >= SQUARED
    assert form == "peak" or squared.all()
    found = interpolate(values, mesh, (i, j), codes, (0.4, 0.6))
    np.testing.assert_allclose(found, np.where(squared, (1.0 - expected) ** 2, expected), rtol=1e-12)


def test_a_block_that_overturns_within_a_cell_leaves_it_without_a_promise():
    axis = np.arange(6.0)
    mesh = Mesh.of(axis, np.exp(axis))
    values = np.ones((6, 6))
    values[0, 0] = np.nan
    i = j = np.array([0, 1, 2, 4])
    x, y = (part[None] for part in mesh.within((i, j), (0.5, 0.5)))
    truth = np.array([[1.0, 1.0, np.nan, 1.25]])
    codes, errors = np.zeros(4, dtype=np.int8), np.empty(4)
    choose_stencils(values, i, j, x, y, truth, mesh, codes, errors)
    np.testing.assert_array_equal(errors, [np.inf, 0.0, np.inf, 0.25])


@pytest.mark.parametrize("best", range(len(STENCIL_SHIFTS)))
def test_the_only_stencil_without_a_spoilt_node_is_found(best):
    """From whichever the cell had before."""
    axis = np.arange(8.0)
    mesh = Mesh.of(axis, np.exp(axis))
    i = j = np.array([3])
    row, column = 3 - STENCIL_SHIFTS[best][0], 3 - STENCIL_SHIFTS[best][1]
    peaks = 0.3 + 0.01 * axis[:, None] - 0.02 * axis
    spoilt = np.ones(peaks.shape, dtype=bool)
    spoilt[row : row + 4, column : column + 4] = False
    x, y = (part[None] for part in mesh.within((i, j), (0.4, 0.6)))
    truth = 0.3 + 0.01 * x - 0.02 * y
    for before in range(len(STENCIL_SHIFTS)):
        codes, errors = np.array([before], dtype=np.int8), np.empty(1)
        choose_stencils(peaks + 0.1 * spoilt, i, j, x, y, truth, mesh, codes, errors)
        assert codes[0] == best
        assert errors[0] < 1e-14


@pytest.mark.parametrize("along", ["rows", "columns"])
def test_no_stencil_reaches_beyond_the_grid(along):
    """Also where memory goes on with values that would fit better than those of the grid."""
    n, wider = 8, np.arange(12.0)
    memory = Mesh.of(wider, np.exp(wider))
    mesh = Mesh(memory.rows[:n], memory.columns[:n], memory.row_products[: n - 3], memory.column_products[: n - 3])
    plane = 0.01 * np.arange(12.0 * n)  # linear in rows and columns, across the ends of rows too
    peaks = plane.copy().reshape(12, n)[:n]
    peaks[(n - 4, slice(None)) if along == "rows" else (slice(None), n - 4)] += 0.1
    i, j = (np.array([k]) for k in ((n - 2, 2) if along == "rows" else (2, n - 2)))
    x, y = (part[None] for part in mesh.within((i, j), (0.5, 0.5)))
    codes, errors = np.array([STENCIL_SHIFTS.index((2, 1) if along == "rows" else (1, 2))], dtype=np.int8), np.empty(1)
    choose_stencils(peaks, i, j, x, y, 0.01 * (n * x + y), mesh, codes, errors)
    row, column = i[0] - STENCIL_SHIFTS[codes[0] % SQUARED][0], j[0] - STENCIL_SHIFTS[codes[0] % SQUARED][1]
    assert 0 <= row <= n - 4
    assert 0 <= column <= n - 4
    assert errors[0] > 1e-3


def test_stencils_against_a_plain_loop():
    serves = np.random.default_rng(3).random((12, 9)) < 0.96
    expected = np.full((11, 8), -1)
    for i, j in np.ndindex(11, 8):
        for code, (up, left) in enumerate(STENCIL_SHIFTS):
            block = serves[max(i - up, 0) : i - up + 4, max(j - left, 0) : j - left + 4]
            if block.shape == (4, 4) and i >= up and j >= left and block.all():
                expected[i, j] = code
                break
    assert -1 in expected
    np.testing.assert_array_equal(first_valid_stencils(serves), expected)


def test_a_grid_too_small_for_a_stencil_is_refused():
    with pytest.raises(InvalidArgumentError, match="at least 4 nodes"):
        Mesh.of(UNEVEN[:3], UNEVEN)


@pytest.mark.parametrize("choice", SLICE_STENCILS)
def test_levels_are_interpolated_exactly_up_to_their_degree(choice):
    count, below = choice
    levels = np.sort(np.random.default_rng(4).uniform(0.5, 1.0, 7))
    for x in np.linspace(levels[2], levels[3], 7):
        weights = [lagrange_weight(levels, 2 - below, count, k, x) for k in range(count)]
        found = np.dot(weights, levels[2 - below :][:count] ** (count - 1))
        assert found == pytest.approx(x ** (count - 1), rel=1e-12)


def test_every_choice_of_levels_holds_the_gap():
    for count, below in SLICE_STENCILS:
        assert 0 <= below <= count - 2
        assert count <= STENCIL_SIZE
    assert len(set(SLICE_STENCILS)) == len(SLICE_STENCILS)


def test_a_level_serves_itself():
    assert lagrange_weight(np.array([0.85]), 0, 1, 0, 0.85) == 1.0
    level, on_level = slice_index(np.array([0.80, 0.85, 0.90]), [0.79, 0.80, 0.82, 0.85, 0.90, 0.91])
    np.testing.assert_array_equal(level, [-1, 0, 0, 1, 2, -1])
    np.testing.assert_array_equal(on_level, [False, True, False, True, True, False])
    level, on_level = slice_index(np.empty(0), [0.8, 0.9])
    np.testing.assert_array_equal(level, [-1, -1])
    assert not on_level.any()
