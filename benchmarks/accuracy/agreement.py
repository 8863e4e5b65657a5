"""Responses of random cells by another checkout, and on other processors: `python -m benchmarks.accuracy.agreement`.

`--baseline FOLDER` compares with another checkout of the project; `--processors haswell generic` with this one,
compiled for other instructions (names of LLVM: AVX2 with fused multiply-add; SSE2 without). Each solves the same cells
in its own process. Outcomes, impacts and the mode of the peak (which arc has it) are compared, and the peaks with the
stated bound of their error. Cells: omega 0.1 to 30, even in the logarithm, 1/a 0.01 to 1, eta 0 to 1; slender, and
rigid with alpha 0.01 to 1.2 rad.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import progress, save, versions
from rocking._excitation.pulses import PULSE_NAMES
from rocking._solver.bounded_response import solve_with_bound

ROOT = Path(__file__).parents[2]

CODES = ("outcome", "impacts", "peak_mode")
"""Fields that are compared for equality."""

WORKER = """
import sys
sys.meta_path = [one for one in sys.meta_path if "editable" not in str(one).lower()]
sys.path.insert(0, sys.argv[1])
import numpy as np
import rocking
assert rocking.__file__.startswith(sys.argv[1]), rocking.__file__
with np.load(sys.argv[2]) as cells:
    found = rocking.peak_response(sys.argv[3], **{name: cells[name] for name in cells})
np.savez(sys.argv[4], **{name: getattr(found, name) for name in sys.argv[5:]})
"""

Fields = Mapping[str, NDArray[Any]]


def random_cells(count: int, rng: np.random.Generator) -> dict[str, NDArray[np.float64]]:
    """Return the groups of `count` cells, of which the first 72 % are slender (they take a third of the time)."""
    alpha = rng.uniform(0.01, 1.2, count)
    alpha[: round(0.72 * count)] = 0.0
    return {
        "slenderness": rng.uniform(0.01, 1.0, count),
        "frequency_ratio": np.exp(rng.uniform(np.log(0.1), np.log(30.0), count)),
        "restitution": rng.uniform(0.0, 1.0, count),
        "alpha": alpha,
    }


def responses(pulse: str, cells: Fields, folder: Path = ROOT, processor: str | None = None) -> dict[str, NDArray[Any]]:
    """Return the compared fields as another process finds them."""
    names = (*CODES, "peak_rotation")
    environment = dict(os.environ) | ({"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""} if processor else {})
    with tempfile.TemporaryDirectory() as place:
        given, found = Path(place, "cells.npz"), Path(place, "found.npz")
        np.savez(given, allow_pickle=False, **cells)
        arguments = [str(folder.resolve()), str(given), pulse, str(found), *names]
        subprocess.run([sys.executable, "-c", WORKER, *arguments], check=True, cwd="/", env=environment)
        with np.load(found) as read:
            return {name: read[name] for name in names}


def compare(here: Fields, other: Fields, bound: NDArray[np.float64]) -> dict[str, Any]:
    """Return the number of cells that differ in each code, and how far the peaks differ.

    Parameters
    ----------
    here, other : mapping of arrays (cells,)
        The fields of `CODES` and `peak_rotation`.
    bound : array (cells,)
        Bound of the error of `peak_rotation`; nan where the block overturns, infinite where the outcome is uncertain.
    """
    counts = {name: int(np.sum(here[name] != other[name])) for name in CODES}
    survives = np.isfinite(here["peak_rotation"]) & np.isfinite(other["peak_rotation"])
    peak = here["peak_rotation"][survives]
    difference = np.abs(other["peak_rotation"][survives] - peak)
    relative = difference / np.where(peak > 0.0, peak, 1.0)
    return counts | {
        "cells": int(survives.size),
        "surviving": int(peak.size),
        "median": float(np.median(relative)) if peak.size else 0.0,
        "largest": float(relative.max(initial=0.0)),
        "above_bound": int(np.sum(difference > bound[survives])),
        "without_bound": int(np.sum(np.isinf(bound))),
    }


def measure(
    count: int,
    seed: int,
    baseline: Path | None,
    processors: Sequence[str] = (),
    pulses: Sequence[str] = PULSE_NAMES,
) -> list[dict[str, Any]]:
    """Return one row for each pulse and other way: the differences of `count` cells."""
    ways: dict[str, dict[str, Any]] = {name: {"processor": name} for name in processors}
    if baseline is not None:
        ways["baseline"] = {"folder": baseline}
    rows = []
    for place, pulse in enumerate(pulses):
        cells = random_cells(count, np.random.default_rng([seed, place]))
        here = responses(pulse, cells)
        bound = solve_with_bound(pulse, **cells).error_bound
        for name, way in ways.items():
            rows.append({"way": name, "pulse": pulse, **compare(here, responses(pulse, cells, **way), bound)})
            progress(row_text(rows[-1]))
    return rows


def row_text(row: Mapping[str, Any]) -> str:
    """Format a row."""
    counts = "".join(f"{row[name]:>11}" for name in (*CODES, "above_bound", "without_bound"))
    return f"{row['way']:10}{row['pulse']:26}{row['cells']:>10}{counts}{row['median']:>10.1e}{row['largest']:>10.1e}"


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Format all rows as text."""
    names = ("outcome", "impacts", "mode", "above bound", "no bound")
    head = f"{'way':10}{'pulse':26}{'cells':>10}" + "".join(f"{name:>11}" for name in names)
    return "\n".join([head + f"{'median':>10}{'largest':>10}", *map(row_text, rows)])


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--baseline", type=Path, help="another checkout of the project")
    parser.add_argument("--processors", nargs="*", default=[], help="names of processors, of LLVM")
    parser.add_argument("--count", type=int, default=1_111_111, help="cells of each pulse")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/agreement.json"))
    options = parser.parse_args()
    if options.baseline is None and not options.processors:
        parser.error("state --baseline or --processors")
    rows = measure(options.count, options.seed, options.baseline, options.processors)
    save({"rows": rows, "seed": options.seed, "versions": versions("numpy", "numba")}, options.out)
    print(table(rows))
    print(f"\nwritten to {options.out}")


if __name__ == "__main__":
    main()
