"""All hard cases against their truth: `python -m stress`, or `make stress`; tells which promises are not kept."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from benchmarks.measure import progress, save, versions
from stress.examine import examined
from stress.families import BY_NAME, known
from stress.figure import draw
from stress.report import broken, markdown
from stress.speed import over_ordinary, times_in_short
from stress.truth import read


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("family", nargs="*", help=f"besides ordinary, by default all: {', '.join(BY_NAME)}")
    parser.add_argument("--out", type=Path, default=Path("results/stress/stress.json"))
    options = parser.parse_args()
    out, wanted = options.out, known(options.family, parser)
    records: dict[str, dict[str, Any]] = {}
    parts: dict[str, dict[str, NDArray[Any]]] = {}
    for count, name in enumerate(dict.fromkeys(("ordinary", *wanted)), start=1):
        progress(f"family {count}: {name}")
        records[name], parts[name] = examined(read(name))
    times = over_ordinary(parts)
    for name, record in records.items():
        record["time"] = times_in_short(times[name], parts[name]["impacts"], read(name))
    promises = broken(records)
    save({"families": records, "broken": promises, "versions": versions("numpy", "numba")}, out)
    table = markdown(records)
    out.with_suffix(".md").write_text(table)
    draw(
        {name: part["error"] for name, part in parts.items()},
        times,
        {name: part["rigid"] for name, part in parts.items()},
        out,
    )
    print(table)
    print(f"written to {out}, with .md, .png and .svg beside it")
    if promises:
        sys.exit("\n".join(["not kept:", *promises]))


if __name__ == "__main__":
    main()
