"""Thresholds of neighbouring columns: matched along their slopes; regions that end or divide are closed."""

import numpy as np
import pytest

from rocking._boundary.columns import Column
from rocking._boundary.matching import join_sides, learn_slopes, match_thresholds

STEP = 0.01


def column(thresholds, codes, log_omega=0.0):
    """A column from 0 to 1 whose thresholds have no width."""
    x = np.array(thresholds, dtype=float)
    return Column(0.9, log_omega, x, x.copy(), codes, 0.0, 1.0)


def matched(left, right):
    """The matched thresholds as pairs of indices."""
    return [tuple(pair) for pair in match_thresholds(left, right).tolist()]


def ends(joins):
    """The joins as pairs of (log_omega, threshold, side)."""
    return {frozenset((side[0].log_omega, side[1], side[2]) for side in join) for join in joins}


def test_equal_columns_match_one_by_one():
    left, right = column([0.2, 0.5, 0.7], [2, 0, 7, 0]), column([0.2005, 0.4995, 0.7], [2, 0, 7, 0], STEP)
    assert matched(left, right) == [(0, 0), (1, 1), (2, 2)]


def test_a_region_that_one_column_lacks_has_no_partner():
    left = column([0.2, 0.5, 0.5001, 0.7], [2, 0, 11, 0, 7])
    right = column([0.2005, 0.7], [2, 0, 7], STEP)
    assert matched(left, right) == [(0, 0), (3, 1)]


def test_equal_codes_far_apart_are_not_one_curve():
    # the first of two tongues is missing in one column, the second one in the other
    left, right = column([0.3, 0.31], [0, 7, 0]), column([0.6, 0.61], [0, 7, 0], STEP)
    assert matched(left, right) == []


def test_slopes_lead_to_the_right_one_of_two_tongues():
    first = column([0.50, 0.51], [0, 7, 0], -STEP)
    left = column([0.52, 0.53], [0, 7, 0])
    learn_slopes(first, left, np.array([(0, 0), (1, 1)]))
    # a tongue of the same kind lies where this one was, and this one lies a step further
    right = column([0.52, 0.53, 0.54, 0.55], [0, 7, 0, 7, 0], STEP)
    assert matched(left, right) == [(0, 2), (1, 3)]


def test_a_region_that_ends_is_closed():
    left, right = column([0.2, 0.5, 0.51], [2, 0, 7, 0]), column([0.2], [2, 0], STEP)
    assert ends(join_sides(left, right)) == {
        frozenset({(0.0, 0, 0), (STEP, 0, 0)}),  # the region 2 goes on
        frozenset({(0.0, 1, 1), (0.0, 2, 0)}),  # the lower and the upper end of the region 7
    }


def test_a_region_that_divides_keeps_its_outer_ends():
    left, right = column([0.3, 0.7], [0, 7, 0]), column([0.3, 0.49, 0.51, 0.7], [0, 7, 0, 7, 0], STEP)
    assert ends(join_sides(left, right)) == {
        frozenset({(0.0, 0, 1), (STEP, 0, 1)}),
        frozenset({(0.0, 1, 0), (STEP, 3, 0)}),
        frozenset({(STEP, 1, 0), (STEP, 2, 1)}),  # the tip of the surviving band between the two parts
    }


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_surviving_band_between_two_regions_ends(mirrored):
    left, right = column([0.4, 0.41], [2, 0, 7]), column([0.405], [2, 7], STEP)
    if mirrored:
        left, right = (column(c.middle, c.codes, STEP - c.log_omega) for c in (right, left))
    joined = ends(join_sides(left, right))
    assert len(joined) == 2  # both regions go on, with another neighbour
    assert all({end[0] for end in join} == {0.0, STEP} for join in joined)
