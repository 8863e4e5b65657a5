"""Time of a cell for each pulse, slender and rigid: `python -m benchmarks.cost.solver`.

`--baseline FOLDER` compares with another checkout of the project, in the same run: each checkout solves the same cells
in its own process, the processes take turns, and the ratio of the medians is printed. Grids are square, omega 0.5 to 12
by 1/a 0.02 to the bound shown, eta 0.85; "random" is the same grid in random order, "eta" 32 restitutions 0.5 to 0.98
for each of its points. Processor time of one thread; compilation is excluded.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.measure import arguments, finish, progress, spread, versions
from rocking._excitation.pulses import PULSE_NAMES

ROOT = Path(__file__).parents[2]

WORKER = """
import json, sys, time
sys.meta_path = [one for one in sys.meta_path if "editable" not in str(one).lower()]
sys.path.insert(0, sys.argv[1])
import numpy as np
import rocking
assert rocking.__file__.startswith(sys.argv[1]), rocking.__file__
grids = {}
def cells(count, highest, order):
    omega, slenderness = np.meshgrid(np.linspace(0.5, 12.0, count), np.linspace(0.02, highest, count))
    omega, slenderness, eta = omega.ravel(), slenderness.ravel(), np.full(omega.size, 0.85)
    if order == "random":
        order = np.random.default_rng(0).permutation(omega.size)
        omega, slenderness = omega[order], slenderness[order]
    elif order == "eta":
        eta = np.tile(np.linspace(0.5, 0.98, 32), omega.size)
        omega, slenderness = np.repeat(omega, 32), np.repeat(slenderness, 32)
    return dict(slenderness=slenderness, frequency_ratio=omega, restitution=eta)
for line in sys.stdin:
    pulse, alpha, *grid = json.loads(line)
    key = tuple(grid)
    if key not in grids:
        grids[key] = cells(*grid)
    begin = time.process_time()
    rocking.peak_response(pulse, **grids[key], alpha=alpha, threads=1)
    print((time.process_time() - begin) / grids[key]["slenderness"].size, flush=True)
"""


PIPES: Any = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "cwd": "/"}


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
    rows, command = [], (sys.executable, "-c", WORKER)
    with ExitStack() as stack:
        workers = {
            name: stack.enter_context(subprocess.Popen([*command, str(folder.resolve())], **PIPES))
            for name, folder in folders.items()
        }
        for case in cases(scale):
            times: dict[str, list[float]] = {name: [] for name in folders}
            for k in range(rounds + 1):
                for name, worker in workers.items():
                    assert worker.stdin is not None
                    assert worker.stdout is not None
                    worker.stdin.write(json.dumps(case) + "\n")
                    worker.stdin.flush()
                    found = float(worker.stdout.readline())
                    if k > 0:  # the first call compiles
                        times[name].append(1e9 * found)
            rows.append({"case": case.label, **{name: spread(values) for name, values in times.items()}})
            progress(row_text(rows[-1]))
        for worker in workers.values():
            assert worker.stdin is not None
            worker.stdin.close()
    return rows


def row_text(row: dict[str, Any]) -> str:
    """Format a row."""
    here = row["here"]["median"]
    text = f"{row['case']:54}{here:10.1f}"
    if "baseline" in row:
        before = row["baseline"]["median"]
        smallest = row["baseline"]["smallest"] / row["here"]["smallest"]
        text += f"{before:10.1f}{before / here:8.2f}{smallest:8.2f}"
    return text


def table(record: dict[str, Any]) -> str:
    """Format all rows as text: medians [ns], ratio of the medians and of the smallest times."""
    rows = record["rows"]
    head = f"{'ns a cell':54}{'here':>10}"
    if rows and "baseline" in rows[0]:
        head += f"{'baseline':>10}{'ratio':>8}{'of min':>8}"
    return "\n".join([head, *map(row_text, rows)])


def main() -> None:
    """Command line; `--scale` multiplies the points along each axis."""
    options = arguments(__doc__, baseline=Path(), rounds=5, scale=1.0, out=Path("results/benchmarks/solver.json"))
    folders = {"here": ROOT} | ({"baseline": options.baseline} if options.baseline != Path() else {})
    rows = measure(folders, options.rounds, options.scale)
    finish({"rows": rows, "versions": versions("numpy", "numba")}, options.out, table)


if __name__ == "__main__":
    main()
