"""What is not done changes no answer and saves work: counts with and without it, as in `benchmarks.skips`."""

from collections.abc import Callable, Iterable

import numpy as np
import pytest

from benchmarks import skip_grids, skip_motion, skips
from benchmarks.skip import Skip
from rocking.boundary.tracing import overturning_boundaries, overturning_boundary
from rocking.solver import peak_response as solve
from rocking.solver.peak_response import peak_response

NO_ROUNDS = 0
"""Counts alone, no time."""


@pytest.mark.parametrize(
    ("measure", "least"),
    [
        (lambda: skip_motion.motions(16, NO_ROUNDS), {"free": 30, "chatter: slender": 1.5, "chatter: rigid": 1.5}),
        (lambda: skip_motion.first_flights(12, NO_ROUNDS), {"first": 11}),
        (lambda: [skip_grids.precision(32, NO_ROUNDS)], {"all digits": 10}),
        (lambda: skip_grids.shared_tracing(31, NO_ROUNDS), {"first": 11, "boundaries": 11}),
        (lambda: skip_grids.tracing(61, NO_ROUNDS), {"points": 2}),
        (lambda: skip_grids.probes(NO_ROUNDS), {"probes": 1.5, "between": 3}),
    ],
    ids=["motion", "first flights", "digits", "boundaries", "tracing", "cubes"],
)
def test_a_skip_saves_work_and_changes_nothing(measure: Callable[[], Iterable[Skip]], least: dict[str, float]) -> None:
    found = [*measure()]
    assert [one.name for one in found if one.changed] == []
    for name, factor in least.items():
        ours = [one for one in found if one.name.startswith(name)]
        assert ours, name
        for one in ours:
            assert one.without >= factor * max(one.done, 1), one


def test_a_block_that_cannot_uplift_is_not_followed() -> None:
    found = skip_motion.no_uplift(8, NO_ROUNDS)
    assert (found.done, found.without) == (0, 64)


def test_boundaries_of_several_restitutions_are_those_of_each() -> None:
    etas = [0.0, 0.6, 0.85, 0.95]
    for pulse, alpha in (("sine", None), ("cosine", 0.35), ("ricker", None)):
        together = overturning_boundaries(pulse, restitution=etas, alpha=alpha, nodes=41)
        for eta, curves in zip(etas, together, strict=True):
            alone = overturning_boundary(pulse, restitution=eta, alpha=alpha, nodes=41)
            assert curves.identical(alone)
            assert curves.restitution == eta


def test_arcs_are_never_solved_a_second_time() -> None:
    """Exact as they are; Taylor steps are, where another fate is near."""
    slenderness, frequency_ratio = skip_motion.plane(32)
    groups = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "restitution": 0.85, "tolerance": 1e-3}
    solved = {
        (pulse, alpha): skip_grids.cells_solved(lambda p=pulse, a=alpha: peak_response(p, alpha=a, **groups))
        for pulse in ("cosine", "ricker")
        for alpha in (None, 0.35)
    }
    assert solved.pop(("cosine", None)) == slenderness.size
    assert all(count < 1.2 * slenderness.size for count in solved.values())
    assert max(solved.values()) > slenderness.size


def test_counting_sees_every_cell() -> None:
    cells = {"slenderness": np.linspace(0.1, 0.9, 7)[:, None], "frequency_ratio": np.arange(1.0, 4.0)}
    ask: Callable[[], object] = lambda: peak_response("sine", restitution=0.9, **cells)  # noqa: E731
    assert skip_grids.cells_solved(ask) == 21
    again = skip_grids.with_settings(solve, lambda: skip_grids.cells_solved(ask), NEAR_BOUNDARY_MARGIN=np.inf)
    assert again == 21


def test_the_table_tells_all() -> None:
    found = [skip_motion.no_uplift(8, 1), *skip_motion.first_flights(4, NO_ROUNDS)]
    lines = skips.table({"skips": [one.record() for one in found]}).splitlines()
    assert len(lines) == 1 + 2 * len(found)
    assert "64" in lines[1]
