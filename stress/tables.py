"""Tables of hard cases with their responses in 192-bit arithmetic, stored in stress/data.

Commands:
    python -m stress.tables             all families, about forty minutes on one core
    python -m stress.tables onset ...   some of them
A second run writes the same bytes. Inputs are doubles, written with all their digits; responses have 20 digits.
`NAME_per_ulp` is the conditioning: the largest change of the quantity, relative for the peak and for times, when an
input changes by one unit in the last place (`reference.conditioning`).
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference.make_table import solved_row
from stress.cells import Cell
from stress.families import BY_NAME, select_families

DATA = Path(__file__).parent / "data"
INPUTS = ("slenderness", "frequency_ratio", "restitution", "alpha")
COLUMNS = (
    "pulse",
    *INPUTS,
    *("outcome", "impacts", "chatter", "exceeded_alpha"),
    *("peak_rotation", "uplift_time", "first_impact_time", "margin"),
    *("peak_rotation_per_ulp", "uplift_time_per_ulp", "first_impact_time_per_ulp", "margin_per_ulp"),
)


@dataclass(frozen=True)
class Table:
    """Cells of a family and their exact responses, by column; alpha is 0 for the slender block."""

    family: str
    pulse: NDArray[np.str_]
    columns: dict[str, NDArray[np.float64]]

    def __len__(self) -> int:
        return len(self.pulse)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]

    def select(self, index: NDArray[Any]) -> Table:
        """Return the rows at the given indices."""
        return Table(self.family, self.pulse[index], {name: values[index] for name, values in self.columns.items()})

    def cell(self, k: int) -> Cell:
        """Return row `k` as arguments of the multi-precision integration."""
        cell: Cell = {"pulse": str(self.pulse[k])} | {name: float(self[name][k]) for name in INPUTS}
        if cell["alpha"] == 0.0:
            del cell["alpha"]
        return cell


def read_table(family: str) -> Table:
    """Read the table of a family."""
    with (DATA / f"{family}.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    columns = {name: np.array([float(row[name] or "nan") for row in rows]) for name in COLUMNS if name != "pulse"}
    return Table(family, np.array([row["pulse"] for row in rows]), columns)


def solved_cell(cell: Cell) -> dict[str, str]:
    """Return a row of a table."""
    return {"alpha": "0.0"} | solved_row(cell)


def write(name: str) -> None:
    """Write the table of a family; the file appears only when it is complete."""
    path, started, rows = DATA / f"{name}.csv", time.perf_counter(), 0
    unfinished = path.with_suffix(".tmp")
    with unfinished.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, COLUMNS, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        for rows, cell in enumerate(BY_NAME[name].cells(), start=1):
            writer.writerow(solved_cell(cell))
            if rows % 20 == 0:
                print(f"{name}: {rows} cells, {time.perf_counter() - started:.0f} s", file=sys.stderr, flush=True)
    unfinished.replace(path)
    print(f"{name}: {rows} cells in {time.perf_counter() - started:.0f} s", file=sys.stderr, flush=True)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("family", nargs="*", help=", ".join(BY_NAME))
    for name in select_families(parser.parse_args().family, parser):
        write(name)


if __name__ == "__main__":
    main()
