"""Cells of the benchmarks with their answers in 192-bit arithmetic, kept in benchmarks/data.

The tables are made by
    python -m benchmarks.truth grid        64 x 64 rigid blocks under a sine; two minutes
    python -m benchmarks.truth random      1,000 cells of all pulses, with their conditioning; four minutes
A second run gives the same bytes. Inputs are exact doubles and stand in the tables to their last bit.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.tools.exact_pulses import PULSES
from tests.tools.exact_response import working_precision
from tests.tools.make_truth import solved_row
from tests.tools.multiprecision import integrate

DATA = Path(__file__).parent / "data"
COLUMNS = {
    "grid": ("slenderness", "frequency_ratio", "restitution", "alpha", "peak_rotation"),
    "random": (
        *("pulse", "slenderness", "frequency_ratio", "restitution", "alpha"),
        *("peak_rotation", "peak_rotation_per_ulp"),
    ),
}
GRID_RESTITUTION, GRID_ALPHA = 0.85, math.radians(20.0)
WAVELETS = ("ricker", "ricker_antisymmetric")
"""The pulses under which the slender block, too, is expanded in Taylor series."""


@dataclass(frozen=True)
class Cells:
    """Blocks and their exact peaks; arrays (cells,), alpha in rad, 0 the slender limit, everything else [-]."""

    pulse: NDArray[np.str_]
    slenderness: NDArray[np.float64]
    frequency_ratio: NDArray[np.float64]
    restitution: NDArray[np.float64]
    alpha: NDArray[np.float64]
    peak_rotation: NDArray[np.float64]
    """nan where overturned."""
    peak_rotation_per_ulp: NDArray[np.float64]
    """Largest relative change of the peak when an input moves by one unit in its last place; nan if not known."""

    def __len__(self) -> int:
        return len(self.slenderness)

    def chosen(self, index: NDArray[Any]) -> Cells:
        """Those of that index."""
        return Cells(**{name: values[index] for name, values in vars(self).items()})


def read(name: str) -> Cells:
    """The table of that name, "grid" or "random"."""
    with (DATA / f"{name}.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))

    def column(key: str) -> NDArray[np.float64]:
        return np.array([float(row.get(key) or "nan") for row in rows])

    numbers = [key for key in Cells.__dataclass_fields__ if key != "pulse"]
    return Cells(np.array([row.get("pulse", "sine") for row in rows]), **{key: column(key) for key in numbers})


def grid_cells(count: int = 64) -> Iterator[dict[str, Any]]:
    """Blocks of 20 degrees under a sine [alpha in rad], 0.5 <= omega <= 10 in the logarithm, 0.05 <= 1/a <= 0.95."""
    for frequency_ratio in np.geomspace(0.5, 10.0, count):
        for slenderness in np.linspace(0.05, 0.95, count):
            yield {
                "pulse": "sine",
                "slenderness": float(slenderness),
                "frequency_ratio": float(frequency_ratio),
                "restitution": GRID_RESTITUTION,
                "alpha": GRID_ALPHA,
            }


def random_cells(rigid: int = 880, slender: int = 120, seed: int = 5) -> Iterator[dict[str, Any]]:
    """Rigid blocks under each pulse in turn, then slender blocks under wavelets [alpha in rad]."""
    random = np.random.default_rng(seed)
    for k in range(rigid + slender):
        cell = {
            "pulse": PULSES[k % len(PULSES)] if k < rigid else WAVELETS[k % 2],
            "slenderness": float(random.uniform(0.02, 0.98)),
            "frequency_ratio": float(np.exp(random.uniform(np.log(0.1), np.log(15.0)))),
            "restitution": float(random.uniform(0.3, 1.0)),
        }
        yield cell | {"alpha": float(random.uniform(0.01, 1.2))} if k < rigid else cell


def with_peak(cell: dict[str, Any]) -> dict[str, str]:
    """A row of a table: inputs to their last bit, the peak to 20 digits, empty where overturned."""
    with working_precision(192):
        peak = integrate(**cell).peak_rotation
    return {name: str(value) for name, value in cell.items()} | {
        "peak_rotation": "" if peak is None else peak.str(20, radius=False)
    }


def with_conditioning(cell: dict[str, Any]) -> dict[str, str]:
    """The same with what the last bit of the inputs explains, which takes five integrations."""
    return {"alpha": "0.0"} | solved_row(cell)


TABLES: dict[str, tuple[Any, Any]] = {"grid": (grid_cells, with_peak), "random": (random_cells, with_conditioning)}


def write(name: str) -> None:
    """Make the table of that name; the file appears when it is complete."""
    cells, solve = TABLES[name]
    path = DATA / f"{name}.csv"
    unfinished = path.with_suffix(".tmp")
    with unfinished.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, COLUMNS[name], extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        for k, cell in enumerate(cells()):
            if k % 100 == 0:
                print(f"{k} cells", file=sys.stderr)
            writer.writerow(solve(cell))
    unfinished.replace(path)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=TABLES)
    write(parser.parse_args().table)


if __name__ == "__main__":
    main()
