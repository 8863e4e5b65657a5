"""Compare all hard cases with their reference: `python -m stress`, or `make stress`; reports violated requirements."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from benchmarks.measure import progress, save, versions
from stress.evaluate import evaluate_family
from stress.families import BY_NAME, select_families
from stress.figure import draw
from stress.report import markdown, violations
from stress.speed import relative_times, single_times, time_summary
from stress.tables import read_table


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("family", nargs="*", help=f"in addition to ordinary; default: all of {', '.join(BY_NAME)}")
    parser.add_argument("--out", type=Path, default=Path("results/stress/stress.json"))
    options = parser.parse_args()
    out, selected = options.out, select_families(options.family, parser)
    records: dict[str, dict[str, Any]] = {}
    parts: dict[str, dict[str, NDArray[Any]]] = {}
    for count, name in enumerate(dict.fromkeys(("ordinary", *selected)), start=1):
        progress(f"family {count}: {name}")
        records[name], parts[name] = evaluate_family(read_table(name))
    times, single = relative_times(parts), single_times(read_table("ordinary"))
    for name, record in records.items():
        record["time"] = time_summary(times[name], parts[name], single, read_table(name))
    violated = violations(records)
    measured = {"rigid" if rigid else "slender": time for rigid, time in single.items()}
    found = {"families": records, "violations": violated, "single_ordinary_cell_us": measured}
    save(found | {"versions": versions("numpy", "numba")}, out)
    table = markdown(records)
    out.with_suffix(".md").write_text(table)
    draw(
        {name: part["error"] for name, part in parts.items()},
        times,
        {name: part["rigid"] for name, part in parts.items()},
        out,
    )
    print(table)
    print(f"written to {out}, and .md, .png and .svg with the same name")
    if violated:
        sys.exit("\n".join(["requirements violated:", *violated]))


if __name__ == "__main__":
    main()
