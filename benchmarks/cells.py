"""Cells with exact answers, read from benchmarks/data; `benchmarks.reference_tables` made the tables."""

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
    """The table of that name, one of `TABLES`."""
    with (DATA / f"{name}.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))

    def column(key: str) -> NDArray[np.float64]:
        return np.array([float(row.get(key) or "nan") for row in rows])

    numbers = [key for key in Cells.__dataclass_fields__ if key != "pulse"]
    return Cells(np.array([row["pulse"] for row in rows]), **{key: column(key) for key in numbers})
