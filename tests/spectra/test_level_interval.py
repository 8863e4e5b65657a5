"""Intervals between slices of restitution or angle: kinds of cells, and errors measured in the middle."""

import numpy as np
import pytest

from rocking._interpolation.stencils import OVERTURNS, SQUARED, Mesh
from rocking._model.outcome import SURVIVES
from rocking._model.response import Outcome
from rocking._spectra.cubes import BESIDE
from rocking._spectra.layer import CELL_CENTRE, UNKNOWN, GridLayer, largest_in_neighbourhood
from rocking._spectra.level_interval import LevelInterval

MESH = Mesh.of(np.linspace(0.3, 0.4, 6), np.geomspace(5.0, 6.0, 6))
ETAS = np.array([0.80, 0.82, 0.84, 0.86, 0.88, 0.90])
CELLS = np.array([1, 2]), np.array([3, 2])
CELL_SHAPE = (5, 5)


def layer(peak, kind=None, form=0):
    """A layer with the same peak at all nodes, or overturned in the way `kind` (outcome, impacts)."""
    nodes, overturned = np.full((6, 6), float(peak)), kind is not None
    outcome, impacts = kind or (Outcome.RECOVERS, 1)
    stencil = np.full(CELL_SHAPE, OVERTURNS if overturned else form, np.int8)
    whole = {"outcome": np.full((6, 6), outcome, np.int8), "impacts": np.full((6, 6), impacts, np.int32)}
    return GridLayer(MESH, nodes, whole["outcome"], whole["impacts"], nodes > 1.0, whole["impacts"], stencil)


def interval_of(layers, lower, levels=ETAS, power=1):
    return LevelInterval.of(layers, [one.kinds() for one in layers], levels, power, lower)


def errors(interval, law, share=0.5):
    """Errors against peaks that follow `law` of the restitution or angle."""
    return interval.errors(share, CELLS, CELL_CENTRE, np.full(2, law(interval.level(share))))


@pytest.mark.parametrize("lower", range(5))
def test_interpolation_is_exact_for_cubics_in_every_interval(lower):
    law = lambda eta: 0.2 + 0.1 * eta**3 - eta**2  # noqa: E731
    interval = interval_of([layer(law(eta)) for eta in ETAS], lower)
    assert interval.level(0.5) == pytest.approx(ETAS[lower : lower + 2].mean())
    assert errors(interval, law) == pytest.approx(0.0, abs=1e-14)


def test_error_in_the_middle_shows_a_crease():
    creased = lambda eta: 0.2 + max(0.0, eta - 0.833)  # noqa: E731
    layers = [layer(creased(eta)) for eta in ETAS]
    assert errors(interval_of(layers, 3), creased) == pytest.approx(0.0, abs=1e-14)  # from 0.84 on
    assert (errors(interval_of(layers, 2), creased) > 1e-4).all()  # from 0.82 on


@pytest.mark.parametrize("at", [0.125, 0.875])
def test_a_crease_at_an_eighth_shows_beside_the_middle_only(at):
    crease = 0.82 + at * 0.02
    creased = lambda eta: 0.2 + max(0.0, eta - crease)  # noqa: E731
    interval = interval_of([layer(creased(eta)) for eta in ETAS], 1)
    largest = max(errors(interval, creased, share)[0] for share in np.linspace(0.0, 1.0, 81))
    assert errors(interval, creased, 0.5) == pytest.approx(0.0, abs=1e-12)
    beside = max(errors(interval, creased, share)[0] for share in BESIDE)
    assert 1.0 < largest / beside < 3.0


@pytest.mark.parametrize("count", [2, 3])
def test_fewer_than_four_slices_are_all_used(count):
    law = lambda eta: eta ** (count - 1)  # noqa: E731
    interval = interval_of([layer(law(eta)) for eta in ETAS[:count]], 0, ETAS[:count])
    assert len(interval.layers) == count
    assert errors(interval, law) == pytest.approx(0.0, abs=1e-14)


def test_cells_whose_slices_differ_in_kind_are_not_interpolated():
    overturned = (Outcome.OVERTURNED_AFTER_IMPACT, 1)
    layers = [layer(0.3)] * 4 + [layer(np.nan, overturned)] * 2
    kinds = [interval_of(layers, lower).kind for lower in range(5)]
    assert all((kind == SURVIVES).all() for kind in kinds[:2])  # from the first four slices
    assert all((kind == UNKNOWN).all() for kind in kinds[2:])


def test_ways_of_overturning_are_different_kinds():
    ways = [(Outcome.OVERTURNED_DIRECTLY, 0), (Outcome.OVERTURNED_AFTER_IMPACT, 1)]
    interval = interval_of([layer(np.nan, ways[0])] * 3 + [layer(np.nan, ways[1])] * 3, 2)
    assert (interval.kind == UNKNOWN).all()
    same = interval_of([layer(np.nan, ways[1])] * 6, 2)
    assert (same.kind == 7).all()  # the code of overturning after one impact


def test_angles_are_interpolated_in_their_squares():
    angles = np.radians([0.0, 5.0, 10.0, 15.0, 20.0])
    law = lambda angle: 0.4 + angle**2 - angle**6  # noqa: E731
    interval = interval_of([layer(law(angle)) for angle in angles], 1, angles, power=2)
    assert errors(interval, law) == pytest.approx(0.0, abs=1e-14)


def test_the_square_is_interpolated_only_if_all_layers_have_it():
    law = lambda eta: 1.0 - np.sqrt(eta)  # noqa: E731  (1 - peak)^2 is linear
    both = interval_of([layer(law(eta), form=SQUARED) for eta in ETAS], 2)
    assert errors(both, law) == pytest.approx(0.0, abs=1e-14)
    mixed = interval_of([layer(law(eta), form=SQUARED * (eta > 0.8)) for eta in ETAS[:4]], 1, ETAS[:4])
    assert (errors(mixed, law) > 1e-10).all()


def test_largest_in_neighbourhood_spreads_errors_and_keeps_nan():
    values = np.zeros((1, 5, 6))
    values[0, 2, 3], values[0, 2, 4] = 7.0, np.nan
    found = largest_in_neighbourhood(values)[0]
    expected = np.zeros((5, 6))
    expected[1:4, 2:5] = 7.0
    expected[2, 4] = np.nan
    np.testing.assert_array_equal(found, expected)
