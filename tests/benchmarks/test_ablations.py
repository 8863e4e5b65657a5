"""Avoided work changes no result and saves work: counts with and without it, as in `benchmarks.ablations`."""

from collections.abc import Callable, Iterable

import numpy as np
import pytest

from benchmarks.ablations import grids, motion, suite
from benchmarks.ablations.ablation import Ablation
from rocking._solver import peak_response as solve
from rocking._solver.peak_response import peak_response

COUNTS_ONLY = 0
"""No timing rounds."""


@pytest.mark.parametrize(
    ("measure", "least"),
    [
        (lambda: motion.motions(16, COUNTS_ONLY), {"free": 30, "chatter: slender": 1.5, "chatter: rigid": 1.5}),
        (lambda: motion.first_flights(12, COUNTS_ONLY), {"first": 11}),
        (lambda: [grids.precision(32, COUNTS_ONLY)], {"all digits": 10}),
        (lambda: grids.tracing(61, COUNTS_ONLY), {"points": 1.35}),
        (lambda: grids.probes(COUNTS_ONLY), {"probes": 1.5, "between": 1.5}),
    ],
    ids=["motion", "first flights", "digits", "tracing", "cubes"],
)
def test_an_optimisation_saves_work_and_changes_nothing(
    measure: Callable[[], Iterable[Ablation]], least: dict[str, float]
) -> None:
    found = [*measure()]
    assert [one.name for one in found if one.changed] == []
    for name, factor in least.items():
        rows = [one for one in found if one.name.startswith(name)]
        assert rows, name
        for one in rows:
            assert one.without >= factor * max(one.done, 1), one


def test_a_block_that_cannot_uplift_is_not_integrated() -> None:
    found = motion.no_uplift(8, COUNTS_ONLY)
    assert (found.done, found.without) == (0, 64)


def test_arcs_are_never_solved_a_second_time() -> None:
    """Arcs are exact at once; Taylor steps are repeated where another outcome is near."""
    slenderness, frequency_ratio = motion.control_plane(32)
    groups = {
        "slenderness": slenderness,
        "frequency_ratio": frequency_ratio,
        "restitution": 0.85,
        "relative_tolerance": 1e-3,
    }
    solved = {
        (pulse, alpha): grids.cells_solved(lambda p=pulse, a=alpha: peak_response(p, alpha=a, **groups))
        for pulse in ("cosine", "ricker")
        for alpha in (None, 0.35)
    }
    assert solved.pop(("cosine", None)) == slenderness.size
    by_arcs = frequency_ratio >= 1.0
    arcs = {name: value[by_arcs] if np.ndim(value) else value for name, value in groups.items()}
    assert grids.cells_solved(lambda: peak_response("ricker", **arcs)) == by_arcs.sum()
    assert all(count < 1.2 * slenderness.size for count in solved.values())
    assert max(solved.values()) > slenderness.size


def test_every_solved_cell_is_counted() -> None:
    cells = {"slenderness": np.linspace(0.1, 0.9, 7)[:, None], "frequency_ratio": np.arange(1.0, 4.0)}
    evaluate: Callable[[], object] = lambda: peak_response("sine", restitution=0.9, **cells)  # noqa: E731
    assert grids.cells_solved(evaluate) == 21
    again = grids.with_settings(solve, lambda: grids.cells_solved(evaluate), NEAR_BOUNDARY_MARGIN=np.inf)
    assert again == 21


def test_the_table_has_a_line_for_each_ablation_and_note() -> None:
    found = [motion.no_uplift(8, 1), *motion.first_flights(4, COUNTS_ONLY)]
    lines = suite.table({"ablations": [one.record() for one in found]}).splitlines()
    assert len(lines) == 1 + 2 * len(found)
    assert "64" in lines[1]
