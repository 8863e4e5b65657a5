"""Levels around a gap of restitution or alpha: which of them serve a cell, by what the solver says between them."""

import numpy as np
import pytest

from rocking.interpolation.stencils import NO_STENCIL, OVERTURNS, SLICE_STENCILS, SQUARED, Mesh
from rocking.model.response import Outcome
from rocking.spectra.between_levels import LevelInterval
from rocking.spectra.layer import CELL_CENTRE, GridLayer, outcome_codes

MESH = Mesh.of(np.linspace(0.3, 0.4, 6), np.geomspace(5.0, 6.0, 6))
ETAS = np.array([0.80, 0.82, 0.84, 0.86, 0.88, 0.90])
CELLS = np.array([1, 2]), np.array([3, 2])
SIDE = (5, 5)
HALF = 0.5


def layer(peak, kind=None, form=0):
    """All nodes of one peak; or overturned in the way `kind` (outcome, impacts)."""
    nodes, fallen = np.full((6, 6), float(peak)), kind is not None
    outcome, impacts = kind or (Outcome.SAFE, 1)
    stencil = np.full(SIDE, OVERTURNS if fallen else form, np.int8)
    whole = {"outcome": np.full((6, 6), outcome, np.int8), "impacts": np.full((6, 6), impacts, np.int32)}
    return GridLayer(MESH, nodes, whole["outcome"], whole["impacts"], nodes > 1.0, whole["impacts"], stencil)


def gap_of(layers, lower, levels=ETAS, power=1):
    return LevelInterval.of(layers, [one.kinds() for one in layers], levels, power, lower)


def probe(gap, law, share=HALF):
    return (CELL_CENTRE, share), np.full(2, law(gap.at(share)))


def creased(eta):
    return 0.2 + max(0.0, eta - 0.833) + 0.1 * eta**3


def test_levels_beyond_a_crease_do_not_serve():
    gap = gap_of([layer(creased(eta)) for eta in ETAS], 3)  # the crease lies below the one before the gap
    assert SLICE_STENCILS[gap.choice[1, 3]] == (4, 1)
    assert gap.errors(CELLS, probe(gap, creased)) == pytest.approx(0.0, abs=1e-14)
    gap = gap_of([layer(creased(eta)) for eta in ETAS], 2)
    assert (gap.errors(CELLS, probe(gap, creased)) > 1e-4).all()
    least = gap.choose(CELLS, [probe(gap, creased), probe(gap, creased, 0.25)])
    assert least == pytest.approx(0.0, abs=1e-14)
    assert {SLICE_STENCILS[code] for code in gap.choice[CELLS]} == {(4, 0)}
    assert SLICE_STENCILS[gap.choice[0, 0]] == (4, 1)  # no other cell


def test_beside_a_change_of_fate_those_of_one_side_serve():
    fallen = (Outcome.OVERTURNED_AFTER_IMPACT, 1)
    law = np.square
    expected = {0: (4, 0), 1: (4, 1), 2: (4, 2), 3: None, 4: None}
    for lower, choice in expected.items():
        gap = gap_of([layer(law(eta)) for eta in ETAS[:4]] + [layer(np.nan, fallen)] * 2, lower)
        if choice is None:
            assert (gap.choice == NO_STENCIL).all()  # no fate is told from two levels
            assert (gap.kind == 0).all()
        else:
            assert {SLICE_STENCILS[code] for code in gap.choice.ravel()} == {choice}
            assert gap.errors(CELLS, probe(gap, law)) == pytest.approx(0.0, abs=1e-14)


def test_three_and_two_levels_serve_where_there_are_no_more():
    fallen = (Outcome.OVERTURNED_DIRECTLY, 0)
    for count, choice in ((3, (3, 1)), (2, (2, 0))):
        layers = [layer(np.nan, fallen)] * (4 - count) + [layer(eta) for eta in ETAS[4 - count : 4]]
        gap = gap_of([*layers, layer(np.nan, fallen)], 2, ETAS[:5])
        assert {SLICE_STENCILS[code] for code in gap.choice.ravel()} == {choice}
        assert gap.errors(CELLS, probe(gap, float)) == pytest.approx(0.0, abs=1e-14)


def test_where_a_block_overturns_at_a_probe_none_serve():
    gap = gap_of([layer(0.3)] * 6, 2)
    assert np.isinf(gap.choose(CELLS, [((CELL_CENTRE, HALF), np.full(2, np.nan))])).all()


def test_levels_are_judged_by_their_largest_error():
    gap = gap_of([layer(0.3)] * 6, 2)
    probes = [
        ((CELL_CENTRE, share), np.full(2, 0.3 + error)) for share, error in ((0.5, 0.0), (0.25, 0.1), (0.75, -0.02))
    ]
    assert gap.choose(CELLS, probes) == pytest.approx(0.1)


def test_blocks_that_overturn_in_different_ways_are_of_no_kind():
    ways = [(Outcome.OVERTURNED_DIRECTLY, 0), (Outcome.OVERTURNED_AFTER_IMPACT, 1)]
    gap = gap_of([layer(np.nan, ways[0])] * 3 + [layer(np.nan, ways[1])] * 3, 2)
    assert (gap.kind == 0).all()
    alike = gap_of([layer(np.nan, ways[1])] * 6, 2)
    assert (alike.kind == outcome_codes(np.int8(ways[1][0]), np.int32(1))).all()


def test_angles_are_interpolated_in_their_squares():
    angles = np.radians([0.0, 5.0, 10.0, 15.0, 20.0])
    law = lambda angle: 0.4 + angle**2 - angle**6  # noqa: E731
    gap = gap_of([layer(law(angle)) for angle in angles], 1, angles, power=2)
    assert gap.errors(CELLS, probe(gap, law)) == pytest.approx(0.0, abs=1e-14)


def test_the_square_is_interpolated_only_if_all_have_it():
    law = lambda eta: 1.0 - np.sqrt(eta)  # noqa: E731  (1 - peak)^2 is linear
    both = gap_of([layer(law(eta), form=SQUARED) for eta in ETAS], 2)
    assert both.errors(CELLS, probe(both, law)) == pytest.approx(0.0, abs=1e-14)
    mixed = gap_of([layer(law(eta), form=SQUARED * (eta > 0.8)) for eta in ETAS[:4]], 1, ETAS[:4])
    assert (mixed.errors(CELLS, probe(mixed, law)) > 1e-10).all()
