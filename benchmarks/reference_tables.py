"""Tables of cells with responses computed in 192-bit arithmetic, stored in benchmarks/data.

Commands:
    python -m benchmarks.reference_tables slender-sine   32 x 32 blocks of one diagram, likewise slender-ricker,
                                                         rigid-sine and rigid-ricker; two seconds to a minute
    python -m benchmarks.reference_tables random         1,000 cells of all pulses with conditioning; four minutes
A second run writes the same bytes. Inputs are doubles, written with all their digits.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from benchmarks.cells import DATA, DIAGRAMS
from reference.exact_pulses import PULSES
from reference.exact_response import working_precision
from reference.make_table import solved_row
from reference.multiprecision import integrate

RESTITUTION = 0.85
FREQUENCY_RATIO, SLENDERNESS = (0.5, 10.0), (0.05, 0.95)
"""Ranges of the grids of these tables, log-spaced and uniform [-]."""

COLUMNS = ("pulse", "slenderness", "frequency_ratio", "restitution", "alpha", "peak_rotation")
WITH_CONDITIONING = (*COLUMNS, "peak_rotation_per_ulp")
WAVELETS = ("ricker", "ricker_antisymmetric")
"""Pulses for which the solver uses Taylor series also for the slender block."""


def diagram_cells(name: str, count: int = 32) -> Iterator[dict[str, Any]]:
    """Yield the blocks of one diagram on a grid over `FREQUENCY_RATIO` and `SLENDERNESS` [alpha in rad]."""
    pulse, alpha = DIAGRAMS[name]
    for frequency_ratio in np.geomspace(*FREQUENCY_RATIO, count):
        for slenderness in np.linspace(*SLENDERNESS, count):
            yield {
                "pulse": pulse,
                "slenderness": float(slenderness),
                "frequency_ratio": float(frequency_ratio),
                "restitution": RESTITUTION,
                "alpha": alpha,
            }


def random_cells(rigid: int = 880, slender: int = 120, seed: int = 5) -> Iterator[dict[str, Any]]:
    """Yield rigid blocks under each pulse in turn, then slender blocks under wavelets [alpha in rad]."""
    random = np.random.default_rng(seed)
    for k in range(rigid + slender):
        cell = {
            "pulse": PULSES[k % len(PULSES)] if k < rigid else WAVELETS[k % 2],
            "slenderness": float(random.uniform(0.02, 0.98)),
            "frequency_ratio": float(np.exp(random.uniform(np.log(0.1), np.log(15.0)))),
            "restitution": float(random.uniform(0.3, 1.0)),
        }
        yield cell | {"alpha": float(random.uniform(0.01, 1.2))} if k < rigid else cell


def row_with_peak(cell: dict[str, Any]) -> dict[str, str]:
    """Return a table row: inputs with all digits, the peak with 20 digits, empty where the block overturns."""
    with working_precision(192):
        peak = integrate(**cell | {"alpha": cell["alpha"] or None}).peak_rotation
    return {name: str(value) for name, value in cell.items()} | {
        "peak_rotation": "" if peak is None else peak.str(20, radius=False)
    }


def row_with_conditioning(cell: dict[str, Any]) -> dict[str, str]:
    """Return the same row with the conditioning of the peak, which takes five integrations."""
    return {"alpha": "0.0"} | solved_row(cell)


TABLES: dict[str, tuple[Callable[[], Iterator[dict[str, Any]]], Callable[[dict[str, Any]], dict[str, str]]]] = {
    **{name: (partial(diagram_cells, name), row_with_peak) for name in DIAGRAMS},
    "random": (random_cells, row_with_conditioning),
}


def columns(name: str) -> tuple[str, ...]:
    """Return the column names of a table."""
    return COLUMNS if name in DIAGRAMS else WITH_CONDITIONING


def write(name: str) -> None:
    """Write a table; the file appears only when it is complete."""
    cells, make_row = TABLES[name]
    path = DATA / f"{name}.csv"
    unfinished = path.with_suffix(".tmp")
    with unfinished.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, columns(name), extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        for k, cell in enumerate(cells()):
            if k % 100 == 0:
                print(f"{k} cells", file=sys.stderr)
            writer.writerow(make_row(cell))
    unfinished.replace(path)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=TABLES)
    write(parser.parse_args().table)


if __name__ == "__main__":
    main()
