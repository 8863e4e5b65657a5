"""All that was measured on one page: `python -m benchmarks.summary` writes results/benchmarks/summary.md.

The numbers of docs/benchmarks.md are taken from this page. What was not measured is left out.
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
from benchmarks.cost import growth, stages, work_precision
from benchmarks.service import performance

GOALS = {"slender": 1000.0, "rigid": 10.0}
"""Time of the best peer over ours that we would like to see at every error."""

TABLES = {
    "growth": ("Cost as the work grows", growth.table),
    "grid-size": ("Interpolation", grid_size.table),
    "tolerance": ("Tolerance", tolerance.table),
    "service": ("Service", performance.table),
    "ablations": ("Ablations", ablations.table),
    "stages": ("Stages of the reproduction", lambda record: stages.table(record["stages"])),
}
CLASSES = {"any": "", "scipy": "scipy"}
"""Among whom the best peer is sought: by how its name begins."""


def comparison(records: list[dict[str, Any]], measure: str, beginning: str) -> Iterator[str]:
    """Time of the fastest peer of a class over ours at each error."""
    yield "| diagram | " + " | ".join(f"{error:.0e}" for error in work_precision.TARGETS) + " |"
    yield "|---" * (len(work_precision.TARGETS) + 1) + "|"
    for record in records:
        best = work_precision.best_peers(record, measure, beginning)
        yield f"| {record['diagram']} | " + " | ".join(map(ratio, best.values())) + " |"


def ratio(best: tuple[str, dict[str, float]] | None) -> str:
    """Of one cell of a comparison, with the range over the rounds."""
    if best is None:
        return "no peer gets there"
    name, found = best
    return f"{digits(found['median'])} ({digits(found['smallest'])} to {digits(found['largest'])}), {name}"


def digits(value: float) -> str:
    """Two or three of them."""
    return f"{value:.1f}" if value < 100.0 else f"{float(f'{value:.3g}'):,.0f}"


def verdict(records: list[dict[str, Any]], measure: str, beginning: str) -> Iterator[str]:
    """Whether the best peer of a class is as far behind as we would like."""
    for kind, goal in GOALS.items():
        best = [
            one["median"]
            for record in records
            if record["diagram"].startswith(kind)
            for _, one in filter(None, work_precision.best_peers(record, measure, beginning).values())
        ]
        if best:
            met = sum(value >= goal for value in best)
            yield f"- {kind}: {goal:,.0f} times is reached at {met} of {len(best)} errors; least {digits(min(best))}"


def page(folder: Path) -> Iterator[str]:
    """Lines of the page."""
    read = {path.stem: json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))}
    yield "# Benchmarks"
    yield f"\n{os.cpu_count()} cores, {platform.machine()}, {platform.system()}, Python {platform.python_version()}"
    records = [read[f"work-precision-{name}"] for name in DIAGRAMS if f"work-precision-{name}" in read]
    if records:
        yield ", ".join(f"{name} {version}" for name, version in records[0]["versions"].items() if name != "python")
    for measure in work_precision.MEASURES if records else ():
        for among, beginning in CLASSES.items():
            yield f"\n## Best peer ({among}) over ours, {measure.replace('_', ' ')}\n"
            yield from comparison(records, measure, beginning)
            yield ""
            yield from verdict(records, measure, beginning)
    for record in records:
        yield f"\n## {record['diagram']}, {record['cells']['all']} cells\n\n```"
        yield work_precision.table_of(record)
        yield "```"
    for name, (title, table) in TABLES.items():
        if name in read:
            yield f"\n## {title}\n\n```\n{table(read[name])}\n```"
    if "first-call" in read:
        yield "\n## First answer of a new process [s]\n"
        for state, times in read["first-call"]["seconds"].items():
            yield f"- kernels {state}: " + ", ".join(f"{name} {value:.3g}" for name, value in times.items())


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, default=Path("results/benchmarks"), help="of the measurements")
    folder = parser.parse_args().folder
    text = "\n".join(page(folder)) + "\n"
    (folder / "summary.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
