"""The tables of hard cases with their answers in 192-bit arithmetic, kept in stress/data.

The tables are made by
    python -m stress.truth             all families, some forty minutes on one core
    python -m stress.truth onset ...   some of them
A second run gives the same bytes. Inputs are exact doubles and stand in the tables to their last bit, answers to 20
digits. `NAME_per_ulp` is the conditioning: the largest change of the answer, relative for the peak and for times, when
an input moves by one unit in its last place (`reference.conditioning`).
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

from reference.make_truth import solved_row
from stress.cells import Cell
from stress.families import BY_NAME, known

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
    """Cells of a family and their exact answers, column by column; alpha is 0 for the slender block."""

    family: str
    pulse: NDArray[np.str_]
    columns: dict[str, NDArray[np.float64]]

    def __len__(self) -> int:
        return len(self.pulse)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]

    def chosen(self, index: NDArray[Any]) -> Table:
        """The rows of that index."""
        return Table(self.family, self.pulse[index], {name: values[index] for name, values in self.columns.items()})

    def cell(self, k: int) -> Cell:
        """Row `k` as a question to the multi-precision integration."""
        cell: Cell = {"pulse": str(self.pulse[k])} | {name: float(self[name][k]) for name in INPUTS}
        if cell["alpha"] == 0.0:
            del cell["alpha"]
        return cell


def read(family: str) -> Table:
    """The table of that family."""
    with (DATA / f"{family}.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    columns = {name: np.array([float(row[name] or "nan") for row in rows]) for name in COLUMNS if name != "pulse"}
    return Table(family, np.array([row["pulse"] for row in rows]), columns)


def answered(cell: Cell) -> dict[str, str]:
    """A row of a table."""
    return {"alpha": "0.0"} | solved_row(cell)


def write(name: str) -> None:
    """Make the table of that family; the file appears when it is complete."""
    path, started, rows = DATA / f"{name}.csv", time.perf_counter(), 0
    unfinished = path.with_suffix(".tmp")
    with unfinished.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, COLUMNS, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        for rows, cell in enumerate(BY_NAME[name].cells(), start=1):
            writer.writerow(answered(cell))
            if rows % 20 == 0:
                print(f"{name}: {rows} cells, {time.perf_counter() - started:.0f} s", file=sys.stderr, flush=True)
    unfinished.replace(path)
    print(f"{name}: {rows} cells in {time.perf_counter() - started:.0f} s", file=sys.stderr, flush=True)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("family", nargs="*", help=", ".join(BY_NAME))
    for name in known(parser.parse_args().family, parser):
        write(name)


if __name__ == "__main__":
    main()
