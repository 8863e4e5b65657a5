"""Compare all hard cases with their reference: `python -m stress`, or `make stress`; reports violated requirements.

`--family NAME ...` selects some of the families, besides "ordinary".
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from benchmarks.measure import arguments, progress, save, versions
from stress.families import BY_NAME, read_family
from stress.figure import draw
from stress.report import evaluate_family, markdown, violations
from stress.speed import relative_times, single_times, time_summary

if __name__ == "__main__":
    options = arguments(__doc__, family=[*BY_NAME], out=Path("results/stress/stress.json"))
    out = options.out
    records: dict[str, dict[str, Any]] = {}
    parts: dict[str, dict[str, NDArray[Any]]] = {}
    for count, name in enumerate(dict.fromkeys(("ordinary", *options.family)), start=1):
        progress(f"family {count}: {name}")
        records[name], parts[name] = evaluate_family(read_family(name))
    times, single = relative_times(parts), single_times(read_family("ordinary"))
    for name, record in records.items():
        record["time"] = time_summary(times[name], parts[name], single)
    violated = violations(records)
    measured = {"rigid" if rigid else "slender": time for rigid, time in single.items()}
    found = {"families": records, "violations": violated, "single_ordinary_cell_us": measured}
    save(found | {"versions": versions("numpy", "numba")}, out)
    table = markdown(records)
    out.with_suffix(".md").write_text(table)
    draw({name: part | {"time": times[name]} for name, part in parts.items()}, out)
    print(table)
    print(f"written to {out}, and .md, .png and .svg with the same name")
    if violated:
        sys.exit("\n".join(["requirements violated:", *violated]))
