"""Interpolation: exact for cubics, of fourth order, next to nodes that may not serve, and between uneven levels."""

import numpy as np
import pytest

from rocking.errors import InvalidArgumentError
from rocking.interpolation import (
    SHIFTS,
    cell_index,
    interpolate,
    lagrange_weights,
    level_weights,
    log_index,
    stencils,
    uniform_index,
)


def test_weights_add_up_to_one_and_pick_the_nodes():
    local = np.linspace(0.0, 3.0, 31)
    np.testing.assert_allclose(lagrange_weights(local).sum(axis=-1), 1.0, atol=1e-15)
    np.testing.assert_array_equal(lagrange_weights([0.0, 1.0, 2.0, 3.0]), np.eye(4))


def cubic(x, y):
    return (1 + x - 0.2 * x**2 + 0.03 * x**3) * (2 - y + 0.5 * y**2 - 0.1 * y**3)


def test_cubics_are_interpolated_exactly_whichever_nodes_serve():
    rng = np.random.default_rng(1)
    values = cubic(np.arange(10.0)[:, None], np.arange(7.0))
    serves = rng.random((10, 7)) < 0.95
    codes = stencils(serves)
    values[~serves] = np.nan
    assert len(np.unique(codes)) == len(SHIFTS) + 1  # each of them, and none
    cells = np.nonzero(codes >= 0)
    for place in ((0.0, 0.0), (0.3, 0.9), (1.0, 0.5)):
        found = interpolate(values, cells, codes[cells], place)
        np.testing.assert_allclose(found, cubic(cells[0] + place[0], cells[1] + place[1]), rtol=1e-12, atol=1e-12)


def test_error_falls_with_the_fourth_power_of_the_step():
    errors = []
    for n in (21, 41, 81):
        rows, columns = np.linspace(0.1, 0.9, n), np.linspace(0.0, 2.0, n)
        codes = stencils(np.ones((n, n), dtype=bool))
        cells = np.nonzero(codes >= 0)
        found = interpolate(np.sin(3 * rows)[:, None] * np.cos(2 * columns), cells, codes[cells], (0.5, 0.5))
        middle = [axis[:-1] + 0.5 * (axis[1] - axis[0]) for axis in (rows, columns)]
        true = np.sin(3 * middle[0])[:, None] * np.cos(2 * middle[1])
        errors.append(np.abs(found.reshape(true.shape) - true).max())
    order = np.polyfit(np.log([21 - 1, 41 - 1, 81 - 1]), np.log(errors), 1)[0]
    assert order == pytest.approx(-4.0, abs=0.3)


def test_fractional_index_keeps_the_end_nodes_and_refuses_what_lies_outside():
    rows, columns = np.linspace(0.02, 0.85, 84), np.geomspace(0.5, 12.0, 97)
    np.testing.assert_allclose(uniform_index(rows, rows), np.arange(84), atol=1e-11)
    np.testing.assert_allclose(log_index(columns, columns), np.arange(97), atol=1e-11)
    assert np.isnan(uniform_index(rows, [np.nextafter(0.02, 0), 0.86, np.nan])).all()
    assert np.isnan(log_index(columns, [0.49, np.nextafter(12.0, 13), -1.0, np.nan])).all()
    np.testing.assert_array_equal(cell_index(np.array([0.0, 0.9, 1.0, 5.5, 6.0, 6.9, 7.0]), 8), [0, 0, 1, 5, 6, 6, 6])


def test_stencils_against_a_plain_loop():
    serves = np.random.default_rng(3).random((12, 9)) < 0.96
    expected = np.full((11, 8), -1)
    for i, j in np.ndindex(11, 8):
        for code, (up, left) in enumerate(SHIFTS):
            block = serves[max(i - up, 0) : i - up + 4, max(j - left, 0) : j - left + 4]
            if block.shape == (4, 4) and i >= up and j >= left and block.all():
                expected[i, j] = code
                break
    assert -1 in expected
    np.testing.assert_array_equal(stencils(serves), expected)


def test_a_grid_too_small_for_a_stencil_is_refused():
    with pytest.raises(InvalidArgumentError, match="at least 4 nodes"):
        stencils(np.ones((3, 5), dtype=bool))


@pytest.mark.parametrize("count", [2, 3, 4, 7])
def test_levels_are_interpolated_exactly_up_to_their_degree(count):
    levels = np.sort(np.random.default_rng(4).uniform(0.5, 1.0, count))
    value = np.concatenate([np.linspace(levels[0], levels[-1], 41), levels])
    gap, first, weights = level_weights(levels, value)
    degree = min(count, 4) - 1
    padded = np.concatenate([levels, np.zeros(4)])
    found = (weights * padded[first[:, None] + np.arange(4)] ** degree).sum(axis=-1)
    np.testing.assert_allclose(found, value**degree, rtol=1e-12)
    between = gap >= 0
    assert (~between).sum() >= count  # on a level that level alone serves
    np.testing.assert_array_equal(weights[~between], [[1, 0, 0, 0]] * int((~between).sum()))
    assert ((levels[gap[between]] < value[between]) & (value[between] < levels[gap[between] + 1])).all()
    assert ((first[between] <= gap[between]) & (gap[between] + 1 < first[between] + 4)).all()


def test_a_single_level_serves_itself():
    gap, first, weights = level_weights(np.array([0.85]), [0.85])
    assert (gap, first) == (-1, 0)
    np.testing.assert_array_equal(weights, [[1, 0, 0, 0]])
