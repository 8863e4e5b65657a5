"""A block under a sine pulse by Siconos and by the package: `python -m benchmarks.accuracy.siconos`.

Siconos is not a dependency of the project, nor in the Python package index. Debian 12 has it as python3-siconos, for
its own Python and an older numpy than the package allows; so it runs in a process of its own: siconos_block.py, by
/usr/bin/python3 or the Python named in the variable SICONOS_PYTHON. The numbers are those of docs/other-software.md.
"""

from __future__ import annotations

import math
import os
import subprocess
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import rocking
from rocking._base.constants import STANDARD_GRAVITY

WIDTH, HEIGHT, PERIOD = 0.4, 1.6, 0.5
LEVELS = (0.3, 0.4, 0.6)
"""Peak accelerations [g] of the table."""

STEPS = (1e-3, 1e-4, 1e-5)
"""Time steps [s] of the table."""

THRESHOLD_STEPS = STEPS[:2]
"""Of the threshold, which takes as many runs as its digits need: with the shortest step half an hour."""

PYTHON = os.environ.get("SICONOS_PYTHON", "/usr/bin/python3")
BLOCK = Path(__file__).with_name("siconos_block.py")


def peak_rotation(level: float, step: float) -> tuple[float, float]:
    """Return the largest rotation [rad] by Siconos, nan if the body overturns, and the processor time [s]."""
    question = [str(value) for value in (WIDTH, HEIGHT, PERIOD, level, step)]
    found = subprocess.run([PYTHON, "-P", BLOCK, *question], capture_output=True, text=True, check=True)
    peak, seconds = found.stdout.splitlines()[-1].split()  # Siconos may write to the same stream
    return float(peak), float(seconds)


def threshold(step: float, low: float = 0.4, high: float = 0.6) -> tuple[float, float]:
    """Return the lowest overturning acceleration [g] by Siconos, to 1e-4 g, and the processor time [s]."""
    total = 0.0
    while high - low > 1e-4:
        level = (low + high) / 2.0
        peak, seconds = peak_rotation(level, step)
        low, high = (low, level) if math.isnan(peak) else (level, high)
        total += seconds
    return high, total


def rows(
    program: Callable[[float, float], tuple[float, float]], settings: Iterable[float], digits: int
) -> Iterator[str]:
    """Yield rows of docs/other-software.md: the peak rotation over alpha, by the package and by a program.

    A program is called with a peak acceleration [g] and each of its settings, and returns the rotation and its time.
    """
    block = rocking.Block(width=WIDTH, height=HEIGHT)
    for level in LEVELS:
        ours = block.response("sine", peak_acceleration=f"{level} g", period=PERIOD, thresholds=False)
        cells = [f"{level} g", f"{float(ours.peak_rotation):.{digits}f}"]
        for peak, seconds in (program(level, setting) for setting in settings):
            cells.append(f"{peak / float(block.alpha):.{digits}f} ({seconds:.1f} s)")
        yield f"| {' | '.join(cells)} |".replace("nan", "overturns")


def threshold_row() -> str:
    """Return the last row of the table of Siconos."""
    block = rocking.Block(width=WIDTH, height=HEIGHT)
    lowest = block.response("sine", peak_acceleration="0.3 g", period=PERIOD).thresholds.lowest / STANDARD_GRAVITY
    cells = [f"{one:.4f} g ({seconds:.0f} s)" for one, seconds in map(threshold, THRESHOLD_STEPS)]
    return f"| lowest threshold | {lowest:.4f} g | {' | '.join(cells)} | - |"


if __name__ == "__main__":
    for row in rows(peak_rotation, STEPS, digits=4):
        print(row, flush=True)
    print(threshold_row())
