"""Bodies with two edges under horizontal and vertical motion: the solver against the multi-precision integration."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from flint import arb

from reference.exact_response import CAPPED, RECOVERS, ExactResponse, working_precision
from reference.records import BITS, RELATIVE_CHANGE, Edge, integrate_record
from rocking._solver.records.record_response import solve_bodies
from rocking._solver.records.samples import sample_rows
from rocking._solver.state import BODY_CELL
from tests.sampling import number
from tests.solver.records.test_bodies import edge

ROUNDING = 2.2e-16
ALLOWED = 1000
"""Roundings times the amplification."""


def random_body(seed: int) -> tuple[dict[str, Any], np.ndarray, np.ndarray]:
    """Arguments of `integrate_record`, the samples and the cell of the solver.

    Edges that differ, or are alike, as those of every third body, which is slender; restitution by angular momentum, or
    any for each edge; every second motion has a vertical component, some close to -g.
    """
    random = np.random.default_rng(seed)
    height, left, right = random.uniform(0.5, 2.0), random.uniform(0.05, 0.6), random.uniform(0.05, 0.6)
    slender = seed % 3 == 0
    if slender or seed % 5 == 0:
        left = right
    gyration = math.hypot(height, 0.5 * (left + right)) * random.uniform(0.3, 0.8)
    (alpha, p, eta), (left_alpha, left_p, left_eta) = (
        edge(right, left, height, gyration), edge(left, right, height, gyration)
    )  # fmt: skip
    if min(eta, left_eta) < 0.0 or random.uniform() < 0.4:
        eta, left_eta = random.uniform(0.5, 1.0, 2).tolist()
    count, step = int(random.integers(30, 150)), 10.0 ** random.uniform(-2.3, -1.0)
    shape = np.convolve(random.standard_normal(count), np.ones(int(random.integers(1, 6))), "same")
    peak = random.uniform(1.0, 4.0) * min(math.tan(alpha), math.tan(left_alpha))
    vertical = None
    if seed % 2:
        vertical = random.standard_normal(count)
        vertical *= random.uniform(0.1, 0.999) / max(-vertical.min(), 0.3 * vertical.max())
    f = shape / np.abs(shape).max()
    cell = np.zeros(1, BODY_CELL)
    cell["rate"], cell["vertical"] = p * step, float(vertical is not None)
    cell["alpha"] = 0.0 if slender else alpha
    cell["ratio"], cell["stiffness"] = left_alpha / alpha, (left_p / p) ** 2
    cell["slenderness"], cell["eta"] = (math.tan(alpha) / peak, math.tan(left_alpha) / peak), (eta, left_eta)
    groups = {
        "acceleration": f.tolist(),
        "time_step": step,
        "frequency_parameter": p,
        "slenderness": float(cell["slenderness"][0, 0]),
        "restitution": eta,
        "alpha": None if slender else alpha,
        "vertical": None if vertical is None else vertical.tolist(),
        "left": Edge(float(cell["ratio"][0]), float(cell["stiffness"][0]), left_eta),
    }
    return groups, sample_rows(f, None, vertical), cell


def against_a_wall(seed: int) -> tuple[dict[str, Any], np.ndarray, np.ndarray]:
    """The same of bodies that rock about their right edge only, with any rebound, 0 and 1 among them."""
    groups, rows, cell = random_body(seed)
    groups["restitution"] = (0.0, 1.0, 0.9, 0.5, 0.2)[seed % 5]
    groups |= {"left": None, "one_sided": True}
    cell["slenderness"][0, 1], cell["ratio"], cell["stiffness"], cell["eta"] = math.inf, 1.0, 1.0, groups["restitution"]
    return groups, rows, cell


def errors_of(seed: int, made: Callable[..., Any] = random_body) -> tuple[ExactResponse, list[float]]:
    """The reference, and the errors of both peaks over roundings times their amplification; none are judged beyond 1e9.

    The outcome is asserted unless it changes with the last bits of the amplitude.
    """
    groups, rows, cell = made(seed)
    with working_precision(BITS):
        exact = integrate_record(**groups)
        moved = integrate_record(**groups, scale=1 + arb(RELATIVE_CHANGE))
        found, edges = solve_bodies(rows, cell, 1, None, each_side=True)
        if exact.outcome == CAPPED or exact.outcome != moved.outcome:
            return exact, []
        assert found["outcome"][0] == exact.outcome, seed
        if exact.outcome != RECOVERS:
            return exact, []
        assert exact.peaks is not None
        assert moved.peaks is not None
        errors = []
        for true, other, z in zip(exact.peaks, moved.peaks, edges[0, :2].tolist(), strict=True):
            if true == 0:
                assert z == 0.0
                continue
            amplification = max(1.0, float(abs(other / true - 1) / arb(RELATIVE_CHANGE)))
            if amplification < 1e9:
                errors.append(float(abs(z / true - 1)) / ROUNDING / amplification)
        return exact, errors


@pytest.mark.parametrize("made", [random_body, against_a_wall])
def test_random_bodies(made: Callable[..., Any]) -> None:
    found = [errors_of(seed, made) for seed in number(range(11, 16), range(100))]
    errors = [error for _, both in found for error in both]
    assert max(errors) < ALLOWED
    assert np.median(errors) < 10.0
    assert len(errors) > number(1, 15)
    assert any(exact.overturned for exact, _ in found)


def test_equal_edges_are_the_block() -> None:
    """Edges given as those of a block, a vertical component of zeros; a constant one is another gravity."""
    shape = [0.0, 1.0, -0.7, 0.2, -1.0, 0.0, 0.0, 0.0]
    groups = {"frequency_parameter": 3.0, "slenderness": 0.6, "restitution": 0.8, "alpha": 0.3}
    with working_precision(BITS):
        block = integrate_record(shape, 0.1, **groups)
        body = integrate_record(shape, 0.1, **groups, left=Edge(1.0, 1.0, 0.8), vertical=[0.0] * 8)
        assert block.outcome == body.outcome == RECOVERS
        assert float(abs(block.peak_rotation - body.peak_rotation)) < 1e-40
        # a motion that ends at rest, under gravity 4 g: twice the frequency, four times the slenderness
        shape = [0.0, 1.0, -0.7, 0.2, -1.0, *[0.0] * 400]
        groups = {"frequency_parameter": 3.0, "slenderness": 0.2, "restitution": 0.5, "alpha": 0.3}
        lifted = integrate_record(shape, 0.1, **groups, vertical=[3.0] * len(shape))
        groups |= {"frequency_parameter": 6.0, "slenderness": 0.8}
        heavier = integrate_record(shape, 0.1, **groups)
        assert lifted.outcome == heavier.outcome == RECOVERS
        assert float(abs(lifted.peak_rotation / heavier.peak_rotation - 1)) < 1e-15
