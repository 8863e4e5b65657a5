"""Time of the first response of a new process: `python -m benchmarks.cost.first_call`.

Measured in a fresh copy of the package, whose kernels must be compiled, and again with the kernels cached on disk.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import rocking
from benchmarks.measure import save, versions

FIRST_CALL = """
import time
begin = time.perf_counter()
import rocking
imported = time.perf_counter()
rocking.peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
first = time.perf_counter()
rocking.peak_response("sine", slenderness=0.4, frequency_ratio=5.0, restitution=0.85)
print(imported - begin, first - imported, time.perf_counter() - first)
"""


def seconds() -> dict[str, dict[str, float]]:
    """Return the times of import, first call and second call in a new process, with kernels compiled and cached [s]."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(rocking.__file__).parent
        shutil.copytree(source, Path(folder) / "rocking", ignore=shutil.ignore_patterns("__pycache__"))
        measured = {}
        for state in ("compiled", "cached"):
            done = subprocess.run(
                [sys.executable, "-c", FIRST_CALL], cwd=folder, capture_output=True, text=True, check=True
            )
            names = ("import", "first_call", "second_call")
            measured[state] = dict(zip(names, map(float, done.stdout.split()), strict=True))
    return measured


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/first-call.json"))
    out = parser.parse_args().out
    found = seconds()
    save({"seconds": found, "versions": versions("numpy", "numba")}, out)
    print(f"{'kernels':12}{'import':>10}{'first':>10}{'second':>10}   s for one cell")
    for state, times in found.items():
        print(f"{state:12}" + "".join(f"{value:10.4f}" for value in times.values()))
    print(f"\nwritten to {out}")


if __name__ == "__main__":
    main()
