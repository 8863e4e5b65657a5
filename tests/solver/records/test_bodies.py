"""Bodies with two different edges and a vertical component against their reference table."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest
from numpy.typing import NDArray

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._solver.records.record_response import solve_bodies
from rocking._solver.records.samples import sample_rows
from rocking._solver.state import BODY_CELL
from tests.solver.records.tables import TABLE, samples

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
