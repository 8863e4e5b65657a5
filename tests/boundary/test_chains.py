"""Chains of points: put together from joins, divided, and without those that are no curve."""

import numpy as np

from rocking._boundary.chains import Chains, chains_of
from rocking._boundary.columns import Column


def chains(numbers):
    """Chains of these numbers, the points told apart by their 1/a."""
    numbers = np.array(numbers)
    x = np.linspace(0.1, 0.9, numbers.size)
    code = np.full(numbers.size, 7)
    return Chains(numbers, 0 * x, x, x.copy(), code, 0 * code, 0 * code, x.copy())


def test_a_chain_is_divided_before_a_point():
    divided = chains([0, 0, 0, 1, 1]).divide(np.array([1]))
    assert divided.chain.tolist() == [0, 1, 1, 2, 2]


def test_chains_of_one_point_are_left_out():
    before = chains([0, 1, 1, 2, 3, 3])
    after = before.without_points()
    assert after.chain.tolist() == [0, 0, 1, 1]
    assert after.slenderness.tolist() == before.slenderness[[1, 2, 4, 5]].tolist()


def test_a_region_on_one_line_only_is_no_chain():
    column = Column(0.9, 0.0, np.array([0.5, 0.51]), np.array([0.5, 0.51]), [0, 7, 0], 0.0, 1.0)
    further = Column(0.9, 0.01, np.array([0.5, 0.51]), np.array([0.5, 0.51]), [0, 7, 0], 0.0, 1.0)
    closed = [((column, 0, 1), (column, 1, 0))]
    assert chains_of(closed).chain.size == 0
    goes_on = [*closed, ((column, 0, 1), (further, 0, 1)), ((column, 1, 0), (further, 1, 0))]
    assert chains_of(goes_on).slenderness.tolist() == [0.5, 0.5, 0.51, 0.51]
