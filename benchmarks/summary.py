"""Summary of all measurements: `python -m benchmarks.summary` writes results/benchmarks/summary.md.

The numbers of docs/benchmarks.md are taken from this page. Missing measurements are omitted.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.ablations import suite as ablations
from benchmarks.accuracy import grid_size, tolerance
from benchmarks.cells import DIAGRAMS
from benchmarks.cost import bodies, first_call, growth, solver, stages, work_precision
from benchmarks.cost import records as recorded_motions
from benchmarks.service import performance

GOALS = {"slender": 1000.0, "rigid": 10.0}
"""Intended time of the fastest baseline over that of the package, at every error."""

TABLES = {
    "solver": ("Time of a cell", lambda record: solver.table(record["rows"])),
    "growth": ("Cost against the number of cells", growth.table),
    "grid-size": ("Interpolation", grid_size.table),
    "tolerance": ("Tolerance", tolerance.table),
    "records": ("Recorded motions", recorded_motions.table),
    "bodies": ("Bodies with two edges", bodies.table),
    "first-call": ("After the installation", first_call.table),
    "service": ("Service", performance.table),
    "ablations": ("Ablations", ablations.table),
    "stages": ("Stages of the reproduction", lambda record: stages.table(record["stages"])),
}
CLASSES = {"any": "", "scipy": "scipy"}
"""Groups of baselines that are compared: a name and the prefix of the baselines in it."""


def comparison(records: list[dict[str, Any]], measure: str, prefix: str) -> Iterator[str]:
    """Yield a table: time of the fastest baseline of a class over that of the package at each error."""
    yield "| diagram | " + " | ".join(f"{error:.0e}" for error in work_precision.TARGETS) + " |"
    yield "|---" * (len(work_precision.TARGETS) + 1) + "|"
    for record in records:
        best = work_precision.fastest_baselines(record, measure, prefix)
        yield f"| {record['diagram']} | " + " | ".join(map(ratio, best.values())) + " |"


def ratio(best: tuple[str, dict[str, float]] | None) -> str:
    """Format one entry of the comparison with its range over the rounds."""
    if best is None:
        return "not reached"
    name, found = best
    return f"{digits(found['median'])} ({digits(found['smallest'])} to {digits(found['largest'])}), {name}"


def digits(value: float) -> str:
    """Format a number with two or three digits."""
    return f"{value:.1f}" if value < 100.0 else f"{float(f'{value:.3g}'):,.0f}"


def verdict(records: list[dict[str, Any]], measure: str, prefix: str) -> Iterator[str]:
    """Yield whether the fastest baseline of a class reaches the intended ratio."""
    for kind, goal in GOALS.items():
        best = [
            one["median"]
            for record in records
            if record["diagram"].startswith(kind)
            for _, one in filter(None, work_precision.fastest_baselines(record, measure, prefix).values())
        ]
        if best:
            met = sum(value >= goal for value in best)
            yield f"- {kind}: {goal:,.0f} times reached at {met} of {len(best)} errors; smallest {digits(min(best))}"


def page(folder: Path) -> Iterator[str]:
    """Yield the lines of the page."""
    read = {path.stem: json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))}
    yield "# Benchmarks"
    yield f"\n{os.cpu_count()} cores, {platform.machine()}, {platform.system()}, Python {platform.python_version()}"
    records = [read[f"work-precision-{name}"] for name in DIAGRAMS if f"work-precision-{name}" in read]
    if records:
        yield ", ".join(f"{name} {version}" for name, version in records[0]["versions"].items() if name != "python")
    for measure in work_precision.MEASURES if records else ():
        for class_name, prefix in CLASSES.items():
            yield f"\n## Fastest baseline ({class_name}) over rocking, {measure.replace('_', ' ')}\n"
            yield from comparison(records, measure, prefix)
            yield ""
            yield from verdict(records, measure, prefix)
    for record in records:
        yield f"\n## {record['diagram']}, {record['cells']['all']} cells\n\n```"
        yield work_precision.table_of(record)
        yield "```"
    for name, (title, table) in TABLES.items():
        if name in read:
            yield f"\n## {title}\n\n```\n{table(read[name])}\n```"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, default=Path("results/benchmarks"), help="folder of the measurements")
    folder = parser.parse_args().folder
    text = "\n".join(page(folder)) + "\n"
    (folder / "summary.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
