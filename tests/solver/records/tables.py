"""The reference table of responses under recorded motions, and its records."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rocking._excitation.records.record import Record

ROOT = Path(__file__).parents[3]
MOTIONS = ROOT / "workflow" / "motions"
TABLE = ROOT / "tests" / "data" / "records" / "responses.csv"


@lru_cache(maxsize=8)
def samples(name: str) -> NDArray[np.float64]:
    return np.loadtxt(MOTIONS / f"{name}.csv", delimiter=",", skiprows=1)[:, 1]


def record(name: str, time_step: float) -> Record:
    return Record(samples(name), time_step, unit="g", name=name)


@dataclass(frozen=True)
class Row:
    """One case of the table; `peak_rotation` is nan where the block overturns, `amplification` may be nan."""

    motion: Record
    groups: dict[str, float]
    overturned: bool
    peak_rotation: float
    amplification: float


def rows() -> list[Row]:
    found = []
    with TABLE.open(newline="") as stream:
        for row in csv.DictReader(stream):
            whole = samples(row["record"])
            first, last = map(int, row["n"].split(":"))
            motion = Record(whole[first:last], float(row["time_step"]), unit="g", name=row["record"])
            share = float(np.abs(whole).max() / np.abs(whole[first:last]).max())
            groups = {
                "frequency_parameter": float(row["frequency_parameter"]),
                "slenderness": float(row["slenderness"]) * share,
                "restitution": float(row["restitution"]),
                "alpha": float(row["alpha"] or 0.0),
            }
            numbers = (float(row[name] or "nan") for name in ("peak_rotation", "amplification"))
            found.append(Row(motion, groups, row["overturned"] == "1", *numbers))
    return found
