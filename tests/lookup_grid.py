"""A small grid for the tests of lookup: nodes, cells that boundaries cross, random points."""

import numpy as np

from benchmarks.accuracy.lookup import compare_with_solver
from rocking._boundary.curves import crossed_cells
from rocking._boundary.tracing import overturning_boundary
from rocking._lookup.cube import Points

GRID = {"slenderness": np.linspace(0.05, 0.95, 91), "frequency_ratio": np.geomspace(0.5, 12.0, 91)}


def crossed(eta, alpha):
    window = {name: (axis[0], axis[-1]) for name, axis in GRID.items()}
    curves = overturning_boundary("sine", restitution=eta, alpha=alpha or None, nodes=101, **window)
    curves["alpha"] = "curve", np.full(curves.sizes["curve"], alpha)
    return crossed_cells(curves, alpha, *GRID.values())


def random_points(count, seed=5):
    rng = np.random.default_rng(seed)
    frequency_ratio = np.exp(rng.uniform(np.log(0.5), np.log(12.0), count))
    return {"slenderness": rng.uniform(0.05, 0.95, count), "frequency_ratio": frequency_ratio}


def assert_answers_are_right(cube, groups, tolerance, share, counted=0.0):
    """What a cube answers is right and within its bound; it answers a share, with the number of impacts a share."""
    given = {"restitution": cube.restitutions[0], "alpha": 0.0} | groups
    points, (size,) = Points.of(*(given[name] for name in Points.__dataclass_fields__))
    found = compare_with_solver(cube, points, tolerance)
    assert {name: value for name, value in found.items() if value and name.startswith(("wrong", "bounds"))} == {}
    assert found["answered"] > share * size
    assert found["counted"] >= counted * found["answered"]
    return found
