"""Bodies with two different edges and a vertical component: reference table, symmetries, equal edges."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest
from numpy.typing import NDArray

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._solver.records.record_response import solve_bodies
from rocking._solver.records.samples import motion_samples, sample_rows
from rocking._solver.state import BODY_CELL, block_cells
from tests.solver.records.tables import TABLE, record, samples

ROUNDING = 2.2e-16
ROWS = list(csv.DictReader((TABLE.parent / "bodies.csv").read_text(encoding="utf-8").splitlines()))


def edge(b: float, other: float, height: float, gyration: float) -> tuple[float, float, float]:
    """alpha, p and the restitution by angular momentum of an impact that leaves the edge."""
    square = gyration**2 + height**2
    p = math.sqrt(STANDARD_GRAVITY * math.hypot(height, b) / (square + b * b))
    return math.atan2(b, height), p, (square - b * other) / (square + other * other)


def cell(row: dict[str, str], peak: float) -> NDArray[np.void]:
    left, right, height, gyration = (float(row[name]) for name in ("b_left", "b_right", "height", "gyration"))
    (alpha, p, eta), (left_alpha, left_p, left_eta) = (
        edge(right, left, height, gyration),
        edge(left, right, height, gyration),
    )
    if row["restitution"]:
        eta = left_eta = float(row["restitution"])
    found = np.zeros(1, BODY_CELL)
    found["rate"], found["alpha"], found["vertical"] = p * float(row["time_step"]), alpha, bool(row["vertical"])
    found["slenderness"], found["eta"] = (math.tan(alpha) / peak, math.tan(left_alpha) / peak), (eta, left_eta)
    found["ratio"], found["stiffness"] = left_alpha / alpha, (left_p / p) ** 2
    return found


@pytest.mark.parametrize("row", ROWS, ids=[str(k) for k in range(len(ROWS))])
def test_outcome_and_peaks_of_each_case(row: dict[str, str]) -> None:
    part = slice(*map(int, row["n"].split(":")))
    horizontal = float(row["scale"]) * samples(row["record"])[part]
    vertical = float(row["vertical_scale"]) * samples(row["vertical"])[part] if row["vertical"] else None
    peak = float(np.abs(horizontal).max())
    body = cell(row, peak)
    found, edges = solve_bodies(sample_rows(horizontal / peak, None, vertical), body, 1, None, each_side=True)
    sides = edges[:, :2]
    assert (found["outcome"][0] > rocking.Outcome.RECOVERS) == (row["overturned"] == "1")
    if row["overturned"] == "1":
        assert np.isnan(sides).all()
        return
    allowed = 1000 * ROUNDING * max(1.0, float(row["amplification"]))
    for name, z in zip(("peak_right", "peak_left"), sides[0], strict=True):
        assert z * body["alpha"][0] == pytest.approx(float(row[name]), rel=allowed)


def bodies(count: int, seed: int) -> NDArray[np.void]:
    """Random bodies with different edges under a record of 5 ms."""
    rng = np.random.default_rng(seed)
    found = np.zeros(count, BODY_CELL)
    found["rate"], found["alpha"] = rng.uniform(0.005, 0.03, count), rng.uniform(0.1, 0.5, count)
    found["ratio"], found["stiffness"] = rng.uniform(0.6, 1.6, count), rng.uniform(0.8, 1.2, count)
    slope = np.tan(found["alpha"][:, None] * np.stack([np.ones(count), found["ratio"]], axis=1))
    found["slenderness"] = slope / rng.uniform(0.2, 1.0, (count, 1))
    found["eta"], found["vertical"] = rng.uniform(0.5, 0.95, (count, 2)), rng.uniform(0.0, 1.0, count)
    return found


def exchanged(given: NDArray[np.void]) -> NDArray[np.void]:
    """The bodies seen from behind: left is right."""
    found = given.copy()
    found["alpha"], found["ratio"] = given["alpha"] * given["ratio"], 1.0 / given["ratio"]
    found["rate"], found["stiffness"] = given["rate"] * np.sqrt(given["stiffness"]), 1.0 / given["stiffness"]
    found["slenderness"], found["eta"] = given["slenderness"][:, ::-1], given["eta"][:, ::-1]
    return found


def test_exchanged_edges_under_the_opposite_motion_give_the_same_peaks() -> None:
    f, w = samples("napa_HNE")[700:3000], samples("napa_HNN")[700:3000]
    f = f / np.abs(f).max()
    given = bodies(300, 3)
    there, sides = solve_bodies(sample_rows(f, None, w), given, None, None, each_side=True)
    back, other = solve_bodies(sample_rows(-f, None, w), exchanged(given), None, None, each_side=True)
    same = there["outcome"] == back["outcome"]
    assert np.count_nonzero(~same) == 0
    assert 30 < np.count_nonzero(there["outcome"] == rocking.Outcome.RECOVERS) < 290
    np.testing.assert_array_equal(sides[:, 2:], -other[:, 2:])
    angles = sides[:, :2] * given["alpha"][:, None]
    mirrored = (other[:, :2] * exchanged(given)["alpha"][:, None])[:, ::-1]
    error = np.abs(angles - mirrored) / np.where(angles > 0.0, angles, 1.0)
    assert np.nanmedian(error) < 1e-13
    assert np.nanquantile(error, 0.95) < 1e-9  # the others amplify rounding


def test_equal_edges_are_the_block_bit_by_bit() -> None:
    motion = record("napa_HNE", 0.005)
    rng = np.random.default_rng(4)
    p, s, eta, alpha = (
        rng.uniform(1, 5, 200),
        rng.uniform(0.2, 1.1, 200),
        rng.uniform(0.5, 1, 200),
        rng.uniform(0.1, 0.5, 200),
    )
    block = rocking.peak_response(motion, frequency_parameter=p, slenderness=s, restitution=eta, alpha=alpha)
    cells = block_cells(p * motion.time_step, s, eta, alpha)
    body, sides = solve_bodies(motion_samples(motion), cells, None, None, each_side=True)
    np.testing.assert_array_equal(body["outcome"], block.outcome)
    np.testing.assert_array_equal(body["peak_rotation"], block.peak_rotation)
    np.testing.assert_array_equal(sides[:, :2].max(axis=1), block.peak_rotation)
