"""Tables of cells with responses computed in 192-bit arithmetic, in benchmarks/data and stress/data.

`python -m benchmarks.tables FILE ...` solves the inputs of some tables again and writes the same bytes: those of
benchmarks/data take ten minutes on one core, those of stress/data forty. Inputs are doubles, written with all their
digits; responses have 20 digits. `NAME_per_ulp` is the conditioning: the largest change of the quantity, relative for
the peak and for times, when an input changes by one unit in the last place (`reference.conditioning`).
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import progress
from reference.make_table import solved_row

DATA = Path(__file__).parent / "data"
INPUTS = ("slenderness", "frequency_ratio", "restitution", "alpha")

DIAGRAMS = ("slender-sine", "slender-ricker", "rigid-sine", "rigid-ricker")
"""Tables behind the diagrams of run time against error; the rigid blocks have alpha = 20 degrees."""

Cell = dict[str, Any]
"""Parameters of one block: pulse, slenderness, frequency_ratio, restitution [-]; alpha [rad] if it is rigid."""


@dataclass(frozen=True)
class Table:
    """Cells and their exact responses, by column (cells,); alpha is 0 for the slender block, nan means none."""

    name: str
    pulse: NDArray[np.str_]
    columns: dict[str, NDArray[np.float64]]

    def __len__(self) -> int:
        return len(self.pulse)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]

    def select(self, index: NDArray[Any]) -> Table:
        """Return the rows at the given indices."""
        return Table(self.name, self.pulse[index], {name: values[index] for name, values in self.columns.items()})

    def inputs(self, rows: Any = ...) -> dict[str, Any]:
        """Return the groups of some rows as arguments of the solver."""
        return {name: self[name][rows] for name in INPUTS}

    def cell(self, k: int) -> Cell:
        """Return row `k` as arguments of the multi-precision integration."""
        return cell_of({"pulse": str(self.pulse[k])} | {name: self[name][k] for name in INPUTS})


def cell_of(row: dict[str, Any]) -> Cell:
    """Return the inputs of a row."""
    return {"pulse": row["pulse"]} | {name: float(row[name]) for name in INPUTS if name != "alpha" or float(row[name])}


def rows_of(path: Path) -> list[dict[str, str]]:
    """Return the rows of a file as text."""
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def read_table(name: str, folder: Path = DATA) -> Table:
    """Read the table of a name."""
    rows = rows_of(folder / f"{name}.csv")
    columns = {key: np.array([float(row[key] or "nan") for row in rows]) for key in rows[0] if key != "pulse"}
    return Table(name, np.array([row["pulse"] for row in rows]), columns)


def solved(row: dict[str, str]) -> dict[str, str]:
    """Return a row as it is, with its response computed again."""
    found = {"alpha": "0.0"} | solved_row(cell_of(row))
    return {name: found[name] for name in row}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", type=Path, nargs="+")
    for path in parser.parse_args().files:
        rows = rows_of(path)
        unfinished = path.with_suffix(".tmp")
        with unfinished.open("w", encoding="utf-8", newline="") as stream:
            writer = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(map(solved, rows))
        unfinished.replace(path)
        progress(f"{path}: {len(rows)} rows")
