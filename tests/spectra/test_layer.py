"""Cells of a layer: where all blocks overturn in one way, by the definition, node by node."""

import dataclasses
from itertools import product

import numpy as np
import pytest

from rocking._interpolation.stencils import OVERTURNS, Mesh
from rocking._model.response import Outcome
from rocking._solver.peak_response import peak_response
from rocking._spectra.layer import GridLayer

WAYS = [(Outcome.RECOVERS, 0), (Outcome.RECOVERS, 2), (Outcome.OVERTURNED_DIRECTLY, 0)] + [
    (Outcome.OVERTURNED_AFTER_IMPACT, impacts) for impacts in (1, 2)
]


def overturns_alike(way, i, j):
    """Whether the corners of a cell overturn in one way, and, after more than one impact anywhere around, all nodes."""
    n, m = way.shape
    rows, columns = (np.clip(at + np.arange(-1, 3), 0, size - 1) for at, size in ((i, n), (j, m)))
    around = [way[row, column] for row, column in product(rows, columns)]
    corners = set(way[i : i + 2, j : j + 2].ravel())
    alike = len(corners) == 1 and WAYS[corners.pop()][0] != Outcome.RECOVERS
    return alike and (len(set(around)) == 1 or all(WAYS[one][1] <= 1 for one in around))


@pytest.mark.parametrize("seed", range(5))
def test_cells_that_overturn_in_one_way(seed):
    random = np.random.default_rng(seed)
    n, m = 24, 30
    slenderness, omega = np.linspace(0.2, 0.9, n), np.geomspace(1.0, 6.0, m)
    mesh = Mesh.of(slenderness, omega)
    nodes = peak_response(
        "sine", slenderness=slenderness[:, None, None], frequency_ratio=omega[:, None], restitution=[0.9]
    )
    way = np.kron(random.integers(0, len(WAYS), (n // 6, m // 6)), np.ones((6, 6), int))  # regions of 6 by 6 nodes
    way[random.integers(0, n, 5), random.integers(0, m, 5)] = random.integers(0, len(WAYS), 5)  # and single nodes
    outcome, impacts = np.array(WAYS)[way].transpose(2, 0, 1)[..., None]
    nodes = dataclasses.replace(nodes, outcome=outcome.astype(np.int8), impacts=impacts.astype(np.int32))
    found = GridLayer.of(mesh, nodes, 0, None).stencil == OVERTURNS
    expected = [[overturns_alike(way, i, j) for j in range(m - 1)] for i in range(n - 1)]
    np.testing.assert_array_equal(found, expected)
    assert 50 < found.sum() < found.size - 50
