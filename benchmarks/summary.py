"""All measurements on one page: `python -m benchmarks.summary` writes summary.md and the figures of time against error.

The numbers of docs/benchmarks.md are taken from this page. Missing measurements are omitted.
"""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.accuracy import tolerance
from benchmarks.cost import first_call, records, service, solver, work_precision
from benchmarks.figures.work_precision import draw
from benchmarks.measure import arguments
from benchmarks.tables import DIAGRAMS

TABLES = {
    "solver": ("Time of a cell", solver.table),
    "tolerance": ("Tolerance", tolerance.table),
    "records": ("Recorded motions", records.table),
    "first-call": ("After the installation", first_call.table),
    "service": ("Service", service.table),
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
    return f"{name} {digits(found['median'])} ({digits(found['smallest'])} to {digits(found['largest'])})"


def digits(value: float) -> str:
    """Format a number with two or three digits."""
    return f"{value:.1f}" if value < 100.0 else f"{float(f'{value:.3g}'):,.0f}"


def page(read: dict[str, dict[str, Any]]) -> Iterator[str]:
    """Yield the lines of the page from the records by name."""
    yield "# Benchmarks"
    yield f"\n{os.cpu_count()} cores, {platform.machine()}, {platform.system()}, Python {platform.python_version()}"
    diagrams = [read[f"work-precision-{name}"] for name in DIAGRAMS if f"work-precision-{name}" in read]
    for measure in work_precision.MEASURES if diagrams else ():
        for class_name, prefix in CLASSES.items():
            yield f"\n## Fastest baseline ({class_name}) over rocking, {measure.replace('_', ' ')}\n"
            yield from comparison(diagrams, measure, prefix)
    for record in diagrams:
        yield f"\n## {record['diagram']}, {record['cells']['all']} cells\n\n```\n{work_precision.table(record)}\n```"
    for name, (title, table) in TABLES.items():
        if name in read:
            yield f"\n## {title}\n\n```\n{table(read[name])}\n```"


def main() -> None:
    """Command line."""
    folder = arguments(__doc__, folder=Path("results/benchmarks")).folder
    read = {path.stem: json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))}
    text = "\n".join(page(read)) + "\n"
    (folder / "summary.md").write_text(text)
    if all(f"work-precision-{name}" in read for name in DIAGRAMS):
        for measure in work_precision.MEASURES:
            draw(
                [read[f"work-precision-{name}"] for name in DIAGRAMS], measure, folder / f"work-precision-{measure}.png"
            )
    print(text)


if __name__ == "__main__":
    main()
