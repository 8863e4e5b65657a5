"""Cells with exact peak rotations, read from benchmarks/data; `benchmarks.reference_tables` writes the tables."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

DATA = Path(__file__).parent / "data"

DIAGRAMS = {
    f"{kind}-{pulse}": (pulse, alpha)
    for kind, alpha in (("slender", 0.0), ("rigid", math.radians(20.0)))
    for pulse in ("sine", "ricker")
}
"""Pulse and slenderness angle [rad] of the tables behind the diagrams of run time against error."""


@dataclass(frozen=True)
class Cells:
    """Blocks and their exact peak rotations; arrays (cells,), alpha in rad (0 is the slender limit), all else [-]."""

    pulse: NDArray[np.str_]
    slenderness: NDArray[np.float64]
    frequency_ratio: NDArray[np.float64]
    restitution: NDArray[np.float64]
    alpha: NDArray[np.float64]
    peak_rotation: NDArray[np.float64]
    """nan where the block overturns."""
    peak_rotation_per_ulp: NDArray[np.float64]
    """Largest relative change of the peak when one input changes by one unit in the last place; nan if unknown."""

    def __len__(self) -> int:
        return len(self.slenderness)

    def select(self, index: NDArray[Any]) -> Cells:
        """Cells at the given indices."""
        return Cells(**{name: values[index] for name, values in vars(self).items()})


def read_table(name: str) -> Cells:
    """Read the table of the given name, one of `reference_tables.TABLES`."""
    with (DATA / f"{name}.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))

    def column(key: str) -> NDArray[np.float64]:
        return np.array([float(row.get(key) or "nan") for row in rows])

    numbers = [key for key in Cells.__dataclass_fields__ if key != "pulse"]
    return Cells(np.array([row["pulse"] for row in rows]), **{key: column(key) for key in numbers})
