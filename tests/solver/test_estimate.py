"""Estimated outcomes of bodies under a record, beside those of the solver."""

import numpy as np
import pytest

import rocking
from rocking._model.outcome import Outcome
from rocking._solver.records.estimate import FAR, estimate_outcomes
from rocking._solver.records.record_response import solve_bodies
from rocking._solver.records.samples import motion_samples
from rocking._solver.state import BODY_CELL
from tests.suites.motions import noise


def bodies(size: int, seed: int, **changed: float) -> np.ndarray:
    rng = np.random.default_rng(seed)
    cells = np.zeros(size, BODY_CELL)
    cells["rate"], cells["alpha"] = rng.uniform(0.02, 0.2, size), rng.uniform(0.05, 0.4, size)
    cells["ratio"] = cells["stiffness"] = 1.0
    cells["vertical"] = 0.0
    cells["eta"], cells["slenderness"] = rng.uniform(0.7, 0.95, (size, 1)), rng.uniform(0.15, 1.2, (size, 1))
    for name, value in changed.items():
        cells[name] = value
    return cells


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"alpha": 0.0},
        {"ratio": 0.7, "stiffness": 1.2},
        {"vertical": 0.5},
        {"eta": 1.0},
        {"eta": 0.0},
        {"rate": 5.0},
    ],
    ids=str,
)
def test_nearly_all_outcomes_are_those_of_the_solver(changed: dict[str, float]) -> None:
    one = noise(3, 800, 0.02)
    motion = rocking.Record(one.acceleration, one.time_step, "m/s2", vertical=0.5 * one.acceleration[::-1])
    cells, samples = bodies(400, 5, **changed), motion_samples(motion)
    cells["slenderness"][:, 1] *= np.tan(cells["alpha"] * cells["ratio"]) / np.tan(np.maximum(cells["alpha"], 1e-9))
    if changed == {"alpha": 0.0}:
        cells["slenderness"][:, 1] = cells["slenderness"][:, 0]
    records, _ = solve_bodies(samples, cells, 1, None, True)
    overturned, ends = estimate_outcomes(samples, cells, 1)
    reach = ends[:, :2]
    expected = records["outcome"] >= Outcome.OVERTURNED_DIRECTLY
    assert 0 < expected.sum() < cells.size
    assert (overturned != expected).mean() < 0.01
    assert (reach >= 0.0).all()
    still = records["outcome"] == Outcome.NO_UPLIFT
    assert (reach[still] > 0.5 * FAR).all()
    again = estimate_outcomes(samples, cells[::-1].copy(), 2)
    np.testing.assert_array_equal(again[0], overturned[::-1])
    np.testing.assert_array_equal(again[1], ends[::-1])


@pytest.mark.parametrize("blocked", [0, 1])
def test_nearly_all_outcomes_of_walls_are_those_of_the_solver(blocked: int) -> None:
    one = noise(3, 800, 0.02)
    motion = rocking.Record(one.acceleration, one.time_step, "m/s2", vertical=0.5 * one.acceleration[::-1])
    cells, samples = bodies(400, 5, vertical=0.3), motion_samples(motion)
    cells["eta"] -= 0.3
    cells["slenderness"][:, blocked] = np.inf
    records, _ = solve_bodies(samples, cells, 1, None, True)
    expected = records["outcome"] >= Outcome.OVERTURNED_DIRECTLY
    assert 0 < expected.sum() < cells.size
    assert (estimate_outcomes(samples, cells, 1)[0] != expected).mean() < 0.01


def test_the_reach_is_the_distance_to_overturning_where_the_peak_depends_on_the_strength_smoothly() -> None:
    samples = motion_samples(rocking.Record(np.sin(np.linspace(0.0, 2.0 * np.pi, 101)), 0.01, "m/s2"))
    cells = bodies(200, 1, rate=0.05, alpha=0.2, eta=0.8)
    cells["slenderness"] = 1.0 / np.linspace(1.0, 2.0, 200)[:, None]
    overturned, (reach, _, squares, slope) = (each.T for each in estimate_outcomes(samples, cells, 1))
    first = int(overturned.argmax())
    factor = 1.0 / cells["slenderness"][:, 0]
    distance = np.log(factor[first] / factor[first - 4 : first - 1])
    assert first > 10
    assert (np.abs(np.log(reach[first - 4 : first - 1] / distance)) < 1.2).all()
    rise = np.diff(squares[6:14]) / np.diff(np.log(factor[6:14]))  # taken at the end of the step of a peak
    np.testing.assert_allclose(0.5 * (slope[6:13] + slope[7:14]), rise, rtol=0.7)
