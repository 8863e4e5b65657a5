"""Interpolation kernels: exact for cubics, of fourth order, and blind to nothing that separates fates."""

import numpy as np
import pytest

from rocking.errors import InvalidArgumentError
from rocking.interpolation import (
    cell_index,
    lagrange4,
    lagrange_weights,
    log_index,
    smooth_cells,
    stencil_start,
    uniform_cells,
    uniform_index,
)
from rocking.response import Outcome


def test_weights_add_up_to_one_and_pick_the_nodes():
    local = np.linspace(0.0, 3.0, 31)
    np.testing.assert_allclose(lagrange_weights(local).sum(axis=-1), 1.0, atol=1e-15)
    np.testing.assert_array_equal(lagrange_weights([0.0, 1.0, 2.0, 3.0]), np.eye(4))


def test_cubics_are_interpolated_exactly_edges_included():
    rng = np.random.default_rng(1)
    row, column = rng.uniform(0, 9, 500), rng.uniform(0, 6, 500)
    row[:4], column[:4] = [0.0, 9.0, 0.3, 8.9], [0.0, 6.0, 5.9, 0.1]

    def cubic(x, y):
        return (1 + x - 0.2 * x**2 + 0.03 * x**3) * (2 - y + 0.5 * y**2 - 0.1 * y**3)

    values = cubic(np.arange(10.0)[:, None], np.arange(7.0))
    np.testing.assert_allclose(lagrange4(values, row, column), cubic(row, column), rtol=1e-12, atol=1e-12)


def test_error_falls_with_the_fourth_power_of_the_step():
    rng = np.random.default_rng(2)
    slenderness, frequency = rng.uniform(0.1, 0.9, 2000), np.exp(rng.uniform(0.0, 2.0, 2000))
    errors = []
    for n in (21, 41, 81):
        rows, columns = np.linspace(0.1, 0.9, n), np.geomspace(1.0, np.exp(2.0), n)
        values = np.sin(3 * rows)[:, None] * np.cos(2 * np.log(columns))
        found = lagrange4(values, uniform_index(rows, slenderness), log_index(columns, frequency))
        errors.append(np.abs(found - np.sin(3 * slenderness) * np.cos(2 * np.log(frequency))).max())
    order = np.polyfit(np.log([21 - 1, 41 - 1, 81 - 1]), np.log(errors), 1)[0]
    assert order == pytest.approx(-4.0, abs=0.3)


def test_fractional_index_keeps_the_end_nodes_and_refuses_what_lies_outside():
    rows, columns = np.linspace(0.02, 0.85, 84), np.geomspace(0.5, 12.0, 97)
    np.testing.assert_allclose(uniform_index(rows, rows), np.arange(84), atol=1e-11)
    np.testing.assert_allclose(log_index(columns, columns), np.arange(97), atol=1e-11)
    assert np.isnan(uniform_index(rows, [np.nextafter(0.02, 0), 0.86, np.nan])).all()
    assert np.isnan(log_index(columns, [0.49, np.nextafter(12.0, 13), -1.0, np.nan])).all()


def test_stencil_is_shifted_at_the_edges():
    cells = cell_index(np.array([0.0, 0.9, 1.0, 5.5, 6.0, 6.9, 7.0]), 8)
    np.testing.assert_array_equal(cells, [0, 0, 1, 5, 6, 6, 6])
    np.testing.assert_array_equal(stencil_start(cells, 8), [0, 0, 0, 4, 4, 4, 4])


def test_axis_too_short_for_a_stencil_is_refused():
    with pytest.raises(InvalidArgumentError, match="at least 4 nodes"):
        lagrange4(np.zeros((3, 5)), np.array([1.0]), np.array([1.0]))


def test_uniform_cells_against_a_plain_loop():
    rng = np.random.default_rng(3)
    first, second = ((rng.random((2, 12, 9)) < 0.02).astype(np.int8) for _ in range(2))
    expected = np.zeros((2, 11, 8), dtype=bool)
    for layer, i, j in np.ndindex(2, 11, 8):
        r, c = min(max(i - 1, 0), 8), min(max(j - 1, 0), 5)
        expected[layer, i, j] = all(np.unique(x[layer, r : r + 4, c : c + 4]).size == 1 for x in (first, second))
    assert 0 < expected.sum() < expected.size
    np.testing.assert_array_equal(uniform_cells(first, second), expected)


def test_only_safe_cells_are_smooth():
    outcome = np.full((6, 6), Outcome.SAFE, dtype=np.int8)
    same = np.ones((6, 6), dtype=np.int32)
    assert smooth_cells(outcome, same, same).all()
    assert not smooth_cells(np.full_like(outcome, Outcome.OVERTURNED_DIRECTLY), same, same).any()
    lobe = same.copy()
    lobe[5, 5] = 3  # one node in the corner spoils the stencils that hold it, and no other
    np.testing.assert_array_equal(smooth_cells(outcome, same, lobe), ~np.pad(np.ones((2, 2), bool), ((3, 0), (3, 0))))
