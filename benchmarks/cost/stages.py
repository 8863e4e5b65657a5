"""Where the time of a finished run goes, from Snakemake's record of each job: `python -m benchmarks.cost.stages`.

One row for each kind of job, or for each kind and pulse (`--by-pulse`): number of jobs, wall-clock and processor time,
largest memory of one job. Jobs run in parallel; each starts Python and loads the kernels, which is part of its time.
Snakemake's processor time ends at its last look at the job, up to half a minute before its end.
"""

from __future__ import annotations

import argparse
import csv
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.measure import save

KINDS = {
    r"overturning-.*": "overturning boundaries",
    r"spectra-.*": "spectrum cubes",
    r"(figure|table)-.*": "figures and table",
    r"claims": "claims",
    r"manifest": "manifest",
    r"check_results|checks-.*": "tests of the products",
}


def kind_of(job: str) -> str:
    """Return the kind of a job from its name."""
    return next((kind for pattern, kind in KINDS.items() if re.fullmatch(pattern, job)), job)


def kind_and_pulse_of(job: str) -> str:
    """Return the kind of a job and, of data sets and their tests, its pulse."""
    pulse = re.match(r"(overturning|spectra|checks)-([a-z0-9_]+)", job)
    return kind_of(job) + (f", {pulse[2]}" if pulse else "")


def measure(folder: Path, row_of: Callable[[str], str] = kind_of) -> list[dict[str, Any]]:
    """Return one row for each kind of job, sorted by decreasing time."""
    rows: dict[str, dict[str, Any]] = {}
    for path in sorted(folder.glob("*.tsv")):
        job_record = record_of(path)
        kind = row_of(path.stem)
        row = rows.setdefault(
            kind, {"kind": kind, "jobs": 0, "seconds": 0.0, "processor_seconds": 0.0, "largest_mb": 0.0}
        )
        row["jobs"] += 1
        row["seconds"] += float(job_record["s"])
        row["processor_seconds"] += number(job_record["cpu_time"])
        row["largest_mb"] = max(row["largest_mb"], number(job_record["max_rss"]))
    return sorted(rows.values(), key=lambda row: -row["seconds"])


def record_of(path: Path) -> dict[str, str]:
    """Read Snakemake's record of a job."""
    with path.open(encoding="utf-8", newline="") as stream:
        (record,) = csv.DictReader(stream, delimiter="\t")
    return record


def number(text: str) -> float:
    """Read a column that Snakemake leaves without a value for very short jobs."""
    try:
        return float(text)
    except ValueError:
        return 0.0


def table(rows: list[dict[str, Any]]) -> str:
    """Format the rows and their sum as text."""
    width = max((len(row["kind"]) for row in rows), default=0) + 2
    lines = [f"{'':{width}}{'jobs':>6}{'wall s':>9}{'cpu s':>9}{'MB':>7}"]
    total = {key: sum(row[key] for row in rows) for key in ("jobs", "seconds", "processor_seconds")}
    total |= {"kind": "sum", "largest_mb": max((row["largest_mb"] for row in rows), default=0.0)}
    lines += [
        f"{row['kind']:{width}}{row['jobs']:6d}{row['seconds']:9.1f}{row['processor_seconds']:9.1f}{row['largest_mb']:7.0f}"
        for row in (*rows, total)
    ]
    return "\n".join(lines)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--logs", type=Path, default=Path("logs/benchmarks"), help="folder of Snakemake's job records")
    parser.add_argument("--by-pulse", action="store_true", help="a row for each kind and pulse")
    parser.add_argument("--out", type=Path, default=Path("results/benchmarks/stages.json"))
    options = parser.parse_args()
    rows = measure(options.logs, kind_and_pulse_of if options.by_pulse else kind_of)
    save({"stages": rows}, options.out)
    print(table(rows))
    print(f"\nwritten to {options.out}")


if __name__ == "__main__":
    main()
