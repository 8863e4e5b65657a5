"""Compares every product with the manifest, byte by byte: `python -m workflow.verify [FOLDER]`, or `make verify`."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

from workflow.records import FOLDER, differences, false_records, read_record

MANIFEST = "results/manifest.json"

LISTS = {MANIFEST: "manifest.json", "results/checks.txt": "check_results.json"}
"""Products that the manifest cannot list, and the record of each."""


def problems(folder: Path) -> Iterator[str]:
    """Descriptions of the differences from the manifest in `folder`, which contains `results`.

    If the manifest itself differs from its record, the products are compared with the records from which it was made.
    """
    flaws = {name: [*_flaws_of_list(folder, name)] for name in LISTS}
    yield from chain.from_iterable(flaws.values())
    if flaws[MANIFEST]:
        yield from chain.from_iterable(
            found for record, found in false_records(folder) if record.name not in LISTS.values()
        )
    else:
        products = json.loads((folder / MANIFEST).read_bytes())["products"]
        yield from differences(folder, {f"results/{name}": entry for name, entry in products.items()})


def _flaws_of_list(folder: Path, name: str) -> Iterator[str]:
    record = folder / FOLDER / LISTS[name]
    try:
        yield from differences(folder, {name: read_record(record)[name]})
    except (OSError, ValueError, KeyError):
        yield f"{record}: the record of {name} is missing or damaged"


def main(folder: Path) -> None:
    """Print the differences; exit status 1 if there are any."""
    found = [*problems(folder)]
    if found:
        advice = "`make reproduce`, with the CONFIG they were made with, makes them again"
        sys.exit("\n".join([*found, f"{len(found)} found; {advice}"]))
    print(f"{folder / 'results'}: every product is as the manifest states")


if __name__ == "__main__":
    main(Path(*sys.argv[1:]))
