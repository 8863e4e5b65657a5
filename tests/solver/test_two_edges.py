"""Bodies with two different edges: against samples of a pulse, mirror images, equal edges, under pulses and records."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import rocking
from rocking._solver.bodies import solve
from rocking._solver.records.record_response import solve_bodies
from rocking._solver.records.samples import pulse_samples, sample_rows
from rocking._solver.state import BODY_CELL, block_cells
from tests.solver.records.tables import record, samples

RATES = {"pulse": (1.0, 8.0), "record": (0.005, 0.03)}
"""omega_g/p under a pulse, p dt under a record."""

ACROSS, UP = samples("napa_HNE")[700:3000], samples("napa_HNN")[700:3000]


def solved(kind: str, cells: NDArray[np.void], sign: float = 1.0) -> tuple[NDArray[np.void], NDArray[np.float64]]:
    if kind == "pulse":
        return solve(rocking.pulse("sine" if sign > 0.0 else "-sine"), cells, None, None)
    return solve_bodies(sample_rows(sign * ACROSS / np.abs(ACROSS).max(), None, UP), cells, None, None, each_side=True)


def bodies(kind: str, count: int, seed: int) -> NDArray[np.void]:
    rng = np.random.default_rng(seed)
    found = np.zeros(count, BODY_CELL)
    found["rate"], found["alpha"] = rng.uniform(*RATES[kind], count), rng.uniform(0.1, 0.4, count)
    found["ratio"], found["stiffness"] = rng.uniform(0.6, 1.6, count), rng.uniform(0.8, 1.2, count)
    slope = np.tan(found["alpha"][:, None] * np.stack([np.ones(count), found["ratio"]], axis=1))
    found["slenderness"], found["eta"] = slope / rng.uniform(0.2, 0.8, (count, 1)), rng.uniform(0.5, 0.95, (count, 2))
    if kind == "record":
        found["vertical"] = rng.uniform(0.0, 1.0, count)
    return found


def behind(kind: str, given: NDArray[np.void]) -> NDArray[np.void]:
    """The bodies seen from behind: left is right."""
    found = given.copy()
    found["alpha"], found["ratio"] = given["alpha"] * given["ratio"], 1.0 / given["ratio"]
    found["rate"] = given["rate"] * np.sqrt(given["stiffness"]) ** (-1.0 if kind == "pulse" else 1.0)
    found["stiffness"] = 1.0 / given["stiffness"]
    found["slenderness"], found["eta"] = given["slenderness"][:, ::-1], given["eta"][:, ::-1]
    return found


@pytest.mark.parametrize("name", ["sine", "-cosine", "c1", "ricker"])
def test_bodies_under_a_pulse_are_those_under_its_samples(name: str) -> None:
    """Errors fall with the square of the sample step; the outcomes of most bodies are those of coarse samples."""
    cells, pulse = bodies("pulse", 150, 7), rocking.pulse(name)
    exact, edges = solve(pulse, cells, None, None)
    sides = edges[:, :2]
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


@pytest.mark.parametrize("kind", RATES)
def test_exchanged_edges_under_the_opposite_motion_give_the_same_peaks(kind: str) -> None:
    given = bodies(kind, 300, 3)
    (there, sides), (back, other) = solved(kind, given), solved(kind, behind(kind, given), -1.0)
    np.testing.assert_array_equal(there["outcome"], back["outcome"])
    assert 30 < np.count_nonzero(there["outcome"] == rocking.Outcome.RECOVERS) < 290
    if kind == "pulse":
        np.testing.assert_array_equal(there["impacts"], back["impacts"])
    else:
        np.testing.assert_array_equal(sides[:, 2:], -other[:, 2:])
    angles = sides[:, :2] * given["alpha"][:, None]
    mirrored = (other[:, :2] * behind(kind, given)["alpha"][:, None])[:, ::-1]
    error = np.abs(angles - mirrored) / np.where(angles > 0.0, angles, 1.0)
    assert np.nanmedian(error) < 1e-13
    assert np.nanquantile(error, 0.95) < 1e-9  # the others amplify rounding


@pytest.mark.parametrize("kind", RATES)
def test_equal_edges_are_the_block_bit_by_bit(kind: str) -> None:
    rng = np.random.default_rng(9)
    s, eta, alpha = rng.uniform(0.2, 1.1, 300), rng.uniform(0.0, 1.0, 300), rng.uniform(0.1, 0.5, 300)
    groups = {"slenderness": s, "restitution": eta, "alpha": alpha}
    rate = rng.uniform(1.0, 8.0, 300)
    if kind == "pulse":
        block = rocking.peak_response("sine", frequency_ratio=rate, **groups)
        body, edges = solve(rocking.pulse("sine"), block_cells(rate, s, eta, alpha), None, None)
    else:
        motion = record("synthetic_31", 0.01)
        block = rocking.peak_response(motion, frequency_parameter=rate, **groups)
        body, edges = solve(motion, block_cells(rate * motion.time_step, s, eta, alpha), None, None)
    np.testing.assert_array_equal(body["outcome"], block.outcome)
    np.testing.assert_array_equal(body["peak_rotation"], block.peak_rotation)
    np.testing.assert_array_equal(edges[:, :2].max(axis=1), block.peak_rotation)
