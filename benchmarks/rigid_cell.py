"""Time of one rigid cell on one core against its error, beside general integrators: `python -m benchmarks.rigid_cell`.

The grid: one sine, alpha 20 degrees, restitution 0.85; 64 frequency ratios, log-spaced from 0.5 to 10;
64 slendernesses, 0.05 to 0.95. Every method runs at several settings; scipy is given a random sample of the same cells.
Rounds of all of them alternate, so that a busy machine hurts all alike; times are processor time of the one thread.
Errors are against the 192-bit integration kept in benchmarks/data. numbalsoda and heyoka take part where they can be
imported.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import rocking
from benchmarks import fixed_step_peer, scipy_peer
from benchmarks.equal_error import time_for
from benchmarks.measure import accuracy, in_rounds, progress, save, spread, versions
from benchmarks.one_sine import rock, rock_many
from benchmarks.truth import Cells, read

TARGETS = (1e-6, 1e-9, 1e-12)
"""Errors at which the methods are compared."""


class Method(NamedTuple):
    """Peaks of cells at a setting; `slow` methods get a sample of the cells."""

    name: str
    peaks: Callable[[Any, Cells], NDArray[np.float64]]
    settings: tuple[float | None, ...]
    slow: bool = False


def ours(tolerance: float | None, cells: Cells) -> NDArray[np.float64]:
    """Peak rotation by the package on one core, nan where overturned; None is its tightest."""
    return rocking.peak_response(
        "sine",
        slenderness=cells.slenderness,
        frequency_ratio=cells.frequency_ratio,
        restitution=cells.restitution,
        alpha=cells.alpha,
        threads=1,
        tolerance=tolerance,
    ).peak_rotation


def compiled(fly: Any) -> Callable[[Any, Cells], NDArray[np.float64]]:
    """A peer with a compiled flight; the cells of one table share restitution and alpha."""

    def peaks(setting: Any, cells: Cells) -> NDArray[np.float64]:
        found = np.empty(len(cells))
        eta, alpha = float(cells.restitution[0]), float(cells.alpha[0])
        rock_many(fly, setting, cells.slenderness, cells.frequency_ratio, eta, alpha, found)
        return found

    return peaks


def plain(one: Callable[..., float]) -> Callable[[Any, Cells], NDArray[np.float64]]:
    """A peer in Python, from its peak of one cell."""

    def peaks(setting: Any, cells: Cells) -> NDArray[np.float64]:
        columns = (cells.slenderness, cells.frequency_ratio, cells.restitution, cells.alpha)
        return np.array([one(setting, *map(float, cell)) for cell in zip(*columns, strict=True)])

    return peaks


def by_scipy(method: str) -> Callable[..., float]:
    """scipy's `solve_ivp` with that method."""

    def one(rtol: float, slenderness: float, frequency_ratio: float, restitution: float, alpha: float) -> float:
        return scipy_peer.peak_rotation(slenderness, frequency_ratio, restitution, rtol, alpha=alpha, method=method)

    return one


def methods() -> Iterator[Method]:
    """Ours, and the peers that this environment has."""
    yield Method("rocking", ours, (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, None))
    rtols = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13)
    if find_spec("heyoka"):
        from benchmarks import heyoka_peer  # noqa: PLC0415  # optional

        yield Method(
            "heyoka", plain(lambda tol, *cell: float(rock.py_func(heyoka_peer.flight, tol, *cell))), (*rtols, 1e-15)
        )
    if find_spec("numbalsoda"):
        from benchmarks import numbalsoda_peer  # noqa: PLC0415  # optional

        yield Method("numbalsoda DOP853", compiled(numbalsoda_peer.dop853_flight), rtols)
        yield Method("numbalsoda LSODA", compiled(numbalsoda_peer.lsoda_flight), rtols)
    yield Method("numba RK4, fixed steps", compiled(fixed_step_peer.flight), (64, 256, 1024, 4096, 8192))
    yield Method("scipy DOP853", plain(by_scipy("DOP853")), rtols, slow=True)
    yield Method("scipy LSODA", plain(by_scipy("LSODA")), rtols, slow=True)


def measure(cells: int, sample: int, rounds: int, seed: int) -> dict[str, Any]:
    """All of it, as one record."""
    grid = read("grid")
    shuffled = np.random.default_rng(seed).permutation(len(grid))
    many, few = grid.chosen(np.sort(shuffled[:cells])), grid.chosen(np.sort(shuffled[:sample]))
    table: dict[str, list[dict[str, Any]]] = {}
    tasks = {}
    for method in methods():
        given = few if method.slow else many
        progress(method.name)
        table[method.name] = []
        for setting in method.settings:  # the first call compiles
            found = method.peaks(setting, given)
            table[method.name].append({"setting": setting, "cells": len(given), **accuracy(found, given.peak_rotation)})
            tasks[method.name, setting] = (lambda m=method, s=setting, c=given: m.peaks(s, c)), len(given)
    times = in_rounds(tasks, rounds)
    for name, rows in table.items():
        for row in rows:
            row |= {f"{clock}_us": spread(values) for clock, values in times[name, row["setting"]].items()}
    missing = [peer for peer in ("heyoka", "numbalsoda") if not find_spec(peer)]
    return {
        "cells": {"grid": len(many), "overturned": int(np.isnan(many.peak_rotation).sum()), "sample": len(few)},
        "rounds": rounds,
        "methods": table,
        "time_over_ours_at_equal_error": {
            measure: {name: ratios(table, name, measure) for name in table if name != "rocking"}
            for measure in ("median_error", "error_99")
        },
        "missing_peers": missing,
        "versions": versions("numpy", "scipy", "numba", "heyoka", "numbalsoda"),
    }


def ratios(table: dict[str, list[dict[str, Any]]], name: str, measure: str) -> dict[str, float | None]:
    """Time of a peer over ours where both reach the same error; None where one of them does not reach it."""

    def least(method: str, error: float) -> float:
        rows = table[method]
        return time_for(error, [row["processor_us"]["median"] for row in rows], [row[measure] for row in rows])

    found = {f"{error:.0e}": least(name, error) / least("rocking", error) for error in TARGETS}
    return {error: None if np.isnan(ratio) else ratio for error, ratio in found.items()}


def table_of(record: dict[str, Any]) -> str:
    """The record in lines."""
    columns = ("median", "smallest", "largest", "error", "99 %", "largest", "fates")
    lines = [f"{'one core, us a cell':24}{'setting':>9}" + "".join(f"{column:>10}" for column in columns)]
    for name, rows in record["methods"].items():
        for row in rows:
            setting = "tightest" if row["setting"] is None else f"{row['setting']:g}"
            time = row["processor_us"]
            lines.append(
                f"{name:24}{setting:>9}"
                + "".join(f"{time[key]:10.2f}" for key in ("median", "smallest", "largest"))
                + "".join(f"{row[key]:10.1e}" for key in ("median_error", "error_99", "largest_error"))
                + f"{row['wrong_fates']:10d}"
            )
    for measure, peers in record["time_over_ours_at_equal_error"].items():
        title = f"times ours, {measure.replace('_', ' ')}"
        lines.append("\n" + f"{title:33}" + "".join(f"{error:>10.0e}" for error in TARGETS))
        for name, found in peers.items():
            lines.append(f"{name:33}" + "".join("         -" if r is None else f"{r:10.1f}" for r in found.values()))
    lines.extend(f"\n{peer} cannot be imported here: left out" for peer in record["missing_peers"])
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=4096, help="cells of the grid, at random where not all")
    parser.add_argument("--sample", type=int, default=200, help="cells given to scipy")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/rigid-cell.json"))
    options = parser.parse_args()
    record = measure(options.cells, options.sample, options.rounds, options.seed)
    save(record, options.out)
    print(table_of(record))
    print(f"\nwritten to {options.out}")


if __name__ == "__main__":
    main()
