"""Bodies with two different edges under named pulses: against samples of the pulse, symmetry, equal edges."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import rocking
from rocking._solver.bodies import solve_motion
from rocking._solver.records.record_response import solve_bodies
from rocking._solver.records.samples import pulse_samples
from rocking._solver.state import BODY_CELL, block_cells


def under_pulse(name: str, cells: NDArray[np.void]) -> tuple[NDArray[np.void], NDArray[np.float64]]:
    records, edges = solve_motion(rocking.pulse(name), cells, None, None)
    return records, edges[:, :2]


def bodies(count: int, seed: int) -> NDArray[np.void]:
    rng = np.random.default_rng(seed)
    found = np.zeros(count, BODY_CELL)
    found["rate"], found["alpha"] = rng.uniform(1.0, 8.0, count), rng.uniform(0.1, 0.4, count)
    found["ratio"], found["stiffness"] = rng.uniform(0.6, 1.6, count), rng.uniform(0.8, 1.2, count)
    slope = np.tan(found["alpha"][:, None] * np.stack([np.ones(count), found["ratio"]], axis=1))
    found["slenderness"], found["eta"] = slope / rng.uniform(0.2, 0.8, (count, 1)), rng.uniform(0.5, 0.95, (count, 2))
    return found


@pytest.mark.parametrize("name", ["sine", "-cosine", "c1", "ricker"])
def test_bodies_under_a_pulse_are_those_under_its_samples(name: str) -> None:
    """Errors fall with the square of the sample step; the outcomes of most bodies are those of coarse samples."""
    cells, pulse = bodies(150, 7), rocking.pulse(name)
    exact, sides = under_pulse(name, cells)
    errors = []
    for count in (2000, 4000):
        phases = np.union1d(np.linspace(pulse.start, pulse.end, count + 1), pulse.stationary)  # the peak among them
        rows = pulse_samples(rocking.SampledPulse(pulse.shape(phases), phases, 2.0 * np.pi))
        sampled = cells.copy()
        sampled["rate"] = 1.0 / cells["rate"]
        found, edges = solve_bodies(rows, sampled, 1, None, each_side=True)
        other = edges[:, :2]
        same = found["outcome"] == exact["outcome"]
        assert np.count_nonzero(~same) <= 2
        rocks = same & (exact["outcome"] == rocking.Outcome.RECOVERS)
        assert np.count_nonzero(rocks) > 30
        errors.append(np.median(np.abs(other - sides)[rocks].max(axis=1)))
    assert errors[1] < 1e-5
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.3)


def test_exchanged_edges_under_the_opposite_pulse_give_the_same_peaks() -> None:
    given = bodies(400, 8)
    behind = given.copy()
    behind["alpha"], behind["ratio"] = given["alpha"] * given["ratio"], 1.0 / given["ratio"]
    behind["rate"], behind["stiffness"] = given["rate"] / np.sqrt(given["stiffness"]), 1.0 / given["stiffness"]
    behind["slenderness"], behind["eta"] = given["slenderness"][:, ::-1], given["eta"][:, ::-1]
    (there, sides), (back, other) = under_pulse("sine", given), under_pulse("-sine", behind)
    np.testing.assert_array_equal(there["outcome"], back["outcome"])
    np.testing.assert_array_equal(there["impacts"], back["impacts"])
    angles, mirrored = sides * given["alpha"][:, None], (other * behind["alpha"][:, None])[:, ::-1]
    rocks = there["outcome"] == rocking.Outcome.RECOVERS
    assert np.count_nonzero(rocks) > 50
    np.testing.assert_allclose(angles[rocks], mirrored[rocks], rtol=1e-8, atol=1e-12)


def test_equal_edges_are_the_block_bit_by_bit() -> None:
    rng = np.random.default_rng(9)
    w, s, eta, alpha = (
        rng.uniform(1, 8, 300),
        rng.uniform(0.2, 1.1, 300),
        rng.uniform(0, 1, 300),
        rng.uniform(0.1, 0.5, 300),
    )
    block = rocking.peak_response("sine", slenderness=s, frequency_ratio=w, restitution=eta, alpha=alpha)
    body, sides = under_pulse("sine", block_cells(w, s, eta, alpha))
    np.testing.assert_array_equal(body["outcome"], block.outcome)
    np.testing.assert_array_equal(body["peak_rotation"], block.peak_rotation)
    np.testing.assert_array_equal(sides.max(axis=1), block.peak_rotation)
