"""Blocks that need not be solved: far from boundaries, between nodes that agree, far from another outcome.

Every cell that the solver integrates is counted in the one function through which all cells pass.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any
from unittest.mock import patch

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from benchmarks.ablations.ablation import Ablation, measure_both
from benchmarks.ablations.motion import RESTITUTION, control_plane
from rocking._boundary import search as boundary_points
from rocking._boundary.cells import crossed_cells
from rocking._boundary.tracing import overturning_boundary
from rocking._solver import peak_response as solve
from rocking._solver.peak_response import peak_response
from rocking._spectra import cubes as sweep

PULSE = "sine"
ANGLES = (0.0, math.radians(20.0))
GRID = {"slenderness": np.linspace(0.05, 0.95, 73), "frequency_ratio": np.geomspace(0.3, 12.0, 161)}
"""The grid of the smallest configuration."""

ETAS = (0.85, 0.90)
FINE = 1e-6
"""Accuracy of a curve for which the full grid is extrapolated [-]; the number of cells alone has no meaning."""


def cells_solved(call: Callable[[], Any]) -> int:
    """Return the number of cells that the solver integrates during a call."""
    count = 0
    follow = solve.solve_cells

    def counting(pulse: Any, cells: list[NDArray[np.float64]], *rest: Any) -> NDArray[np.void]:
        nonlocal count
        count += cells[0].size
        return follow(pulse, cells, *rest)

    with patch.object(solve, "solve_cells", counting), patch.object(boundary_points, "solve_cells", counting):
        call()
    return count


def with_settings(module: Any, call: Callable[[], Any], **settings: Any) -> Any:
    """Call a function while constants of a module have other values."""
    with ExitStack() as stack:
        for name, value in settings.items():
            stack.enter_context(patch.object(module, name, value))
        return call()


def tracing(nodes: int, rounds: int) -> Iterator[Ablation]:
    """Yield boundaries traced against a full grid, and with the energy margin against the outcome alone."""

    def trace() -> xr.Dataset:
        return overturning_boundary(PULSE, restitution=RESTITUTION, nodes=nodes)

    def by_outcome_alone() -> xr.Dataset:
        return with_settings(boundary_points, trace, outcome_margin=lambda z, *_: np.ones_like(z))

    done, without = cells_solved(trace), cells_solved(by_outcome_alone)
    times = measure_both("boundary", trace, by_outcome_alone, rounds)
    vertices = trace().sizes["point"]
    window = 0.98 * math.log(75.0)  # 1/a from 0.02 to 1, omega from 0.2 to 15 in the logarithm
    note = (
        f"extrapolated: a grid that shows the curves to {FINE:g}; one of as many cells shows them to "
        f"{math.sqrt(window / done):.1g}, traced they are good to {boundary_points.RESOLUTION:g}"
    )
    yield Ablation("cells far from a boundary: slender", "cells", done, round(window / FINE**2), note=note)
    yield Ablation(
        "points on the way to a boundary: slender", "cells", done, without, *times,
        note=f"{vertices} vertices, by the energy margin and by the outcome alone",
    )  # fmt: skip


def barred_cells() -> NDArray[np.bool_]:
    """Return the cells of the grid that boundaries cross, by restitution and angle."""
    plane_axes = GRID["slenderness"], GRID["frequency_ratio"]

    def crossed(eta: float, angle: float) -> NDArray[np.bool_]:
        window = {"frequency_ratio": (0.3, 12.0), "slenderness": (0.05, 1.0)}
        curves = overturning_boundary(PULSE, restitution=eta, alpha=angle or None, nodes=61, **window)
        return crossed_cells(curves.assign(alpha=("curve", np.full(curves.sizes["curve"], angle))), angle, *plane_axes)

    return np.array([[crossed(eta, angle) for angle in ANGLES] for eta in ETAS])


def probes(rounds: int) -> Iterator[Ablation]:
    """Yield the cubes of a small grid: nodes, probes in cells and between slices."""
    barred = barred_cells()

    def fill() -> list[xr.Dataset]:
        return list(sweep.spectra(PULSE, restitution=ETAS, alpha=ANGLES, barred=barred, threads=1, **GRID))

    def everywhere() -> list[xr.Dataset]:
        return with_settings(sweep, fill, REFINE_TOL=-1.0, MAX_ERROR=math.inf)

    cells = (GRID["slenderness"].size - 1) * (GRID["frequency_ratio"].size - 1)
    nodes = GRID["slenderness"].size * GRID["frequency_ratio"].size * len(ETAS) * len(ANGLES)
    between = cells_between(fill)
    done, more = cells_solved(fill) - nodes - between, cells_solved(everywhere) - nodes - cells_between(everywhere)
    kept = int(np.sum(np.isfinite([cube.interpolation_error.values for cube in fill()])))
    times = measure_both("probes", fill, everywhere, rounds)
    layers = len(ETAS) * len(ANGLES)
    yield Ablation(
        "probes in the cells of a cube", "cells", done, more, *times,
        note=f"{layers} layers of {cells} cells, {kept} of them with a bound; time of the whole cubes",
    )  # fmt: skip
    intervals = (len(ETAS) - 1) * len(ANGLES) + (len(ANGLES) - 1) * len(ETAS)
    yield Ablation("between the slices of a cube", "cells", between, intervals * cells, note=f"{intervals} intervals")


def cells_between(fill: Callable[[], Any]) -> int:
    """Return the cells solved between slices of restitution and of angle while cubes are filled."""
    count = 0
    measure = sweep._Grid._errors_between

    def counting(*arguments: Any, **named: Any) -> Any:
        nonlocal count
        found: list[Any] = []
        count += cells_solved(lambda: found.append(measure(*arguments, **named)))
        return found[0]

    with patch.object(sweep._Grid, "_errors_between", counting):
        fill()
    return count


def precision(side: int, rounds: int) -> Ablation:
    """Compare the blocks that are solved again with all digits because another outcome is near."""
    slenderness, omega = control_plane(side)
    groups = {"slenderness": slenderness, "frequency_ratio": omega, "restitution": RESTITUTION, "alpha": ANGLES[1]}

    def ask(tolerance: float | None = 1e-3) -> NDArray[np.float64]:
        return peak_response(PULSE, **groups, relative_tolerance=tolerance, threads=1).peak_rotation

    def all_again() -> NDArray[np.float64]:
        return with_settings(solve, ask, NEAR_BOUNDARY_MARGIN=math.inf)

    changed = int(np.sum(np.isnan(ask()) != np.isnan(ask(None))))
    done, without = (cells_solved(call) - omega.size for call in (ask, all_again))
    times = measure_both("precision", ask, all_again, rounds)
    note = "tolerance 1e-3; changes of the outcome are counted"
    return Ablation(
        "all digits far from another outcome: rigid", "cells solved again", done, without, *times, changed, note
    )
