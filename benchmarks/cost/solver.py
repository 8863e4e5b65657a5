"""Time of a cell for each pulse, slender and rigid: `python -m benchmarks.cost.solver`.

`--baseline FOLDER` compares with another checkout of the project, in the same run: each checkout solves the same cells
in its own process, the processes take turns, and the ratio of the medians is printed. Grids are square, omega 0.5 to 12
by 1/a 0.02 to the bound shown, eta 0.85; "random" is the same grid in random order, "eta" 32 restitutions 0.5 to 0.98
for each of its points. Processor time of one thread; compilation is excluded.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from benchmarks.checkouts import Checkout
from benchmarks.measure import arguments, finish, progress, spread, versions
from rocking._excitation.pulses import PULSE_NAMES

ROOT = Path(__file__).parents[2]


class Case(NamedTuple):
    """Cells of one row of the table: pulse, slenderness angle [rad], points along each axis, bound of 1/a, order."""

    pulse: str
    alpha: float | None
    count: int
    highest: float
    order: str = "grid"

    @property
    def label(self) -> str:
        kind = "slender" if self.alpha is None else "rigid"
        return f"{kind} {self.pulse}, 1/a to {self.highest:g}, {self.order}"


def cases(scale: float) -> Iterator[Case]:
    """Yield the rows of the table; `scale` multiplies the points along each axis."""

    def points(count: int) -> int:
        return max(8, round(scale * count))

    for highest in (0.85, 0.95, 0.98):
        for order in ("grid", "random"):
            yield Case("sine", None, points(800), highest, order)
    yield Case("sine", None, points(150), 0.85, "eta")
    for pulse in PULSE_NAMES:
        for highest in (0.85, 0.95) if pulse != "sine" else ():
            yield Case(pulse, None, points(300), highest)
    for pulse in ("sine", "cosine", "mavroeidis_papageorgiou", "ricker"):
        yield Case(pulse, 0.35, points(100), 0.85)


def measure(folders: dict[str, Path], rounds: int, scale: float) -> list[dict[str, Any]]:
    """Return one row for each case: times of each checkout [ns], and their ratio where there are two."""
    rows = []
    checkouts = {name: Checkout(folder.resolve()) for name, folder in folders.items()}
    for case in cases(scale):
        times: dict[str, list[float]] = {name: [] for name in folders}
        for k in range(rounds + 1):
            for name, checkout in checkouts.items():
                checkout.start(case._asdict())
                found, seconds = checkout.result()
                if k > 0:  # the first call compiles
                    times[name].append(1e9 * seconds / found.size)
        rows.append({"case": case.label, **{name: spread(values) for name, values in times.items()}})
        progress(case.label)
    for checkout in checkouts.values():
        checkout.close()
    return rows


def table(record: dict[str, Any]) -> str:
    """Format all rows as text: medians [ns], ratio of the medians and of the smallest times."""
    rows = pd.json_normalize(record["rows"])
    found = pd.DataFrame({"ns a cell": rows["case"], "here": rows["here.median"]})
    if "baseline.median" in rows:
        found["baseline"] = rows["baseline.median"]
        found["ratio"] = found["baseline"] / found["here"]
        found["of min"] = rows["baseline.smallest"] / rows["here.smallest"]
    return found.to_string(index=False, float_format="{:.2f}".format)


def main() -> None:
    """Command line; `--scale` multiplies the points along each axis."""
    options = arguments(__doc__, baseline=Path(), rounds=5, scale=1.0, out=Path("results/benchmarks/solver.json"))
    folders = {"here": ROOT} | ({"baseline": options.baseline} if options.baseline != Path() else {})
    rows = measure(folders, options.rounds, options.scale)
    finish({"rows": rows, "versions": versions("numpy", "numba")}, options.out, table)


if __name__ == "__main__":
    main()
