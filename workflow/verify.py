"""Compares every product with the manifest, byte by byte: `python -m workflow.verify [FOLDER]`, or `make verify`."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

from workflow.records import FOLDER, differences, false_records, read_record, records_of

MANIFEST = "results/manifest.json"

LISTS = {MANIFEST: "manifest", "results/checks.txt": "check_results"}
"""Products that the manifest cannot list, and the job of each."""

SUITES = "results/suites/*/manifest.json"
"""Manifests of the suites of records."""


def problems(folder: Path) -> Iterator[str]:
    """Descriptions of the differences from the manifests in `folder`, which contains `results`.

    There is one of the paper, which may be missing where only suites were made, and one of each suite. If a manifest
    itself differs from its record, the products are compared with the records from which it was made.
    """
    suites = sorted(path.relative_to(folder).as_posix() for path in folder.glob(SUITES))
    for name in suites:
        flaws = [*_flaws_of_list(folder, name, name.removeprefix("results/").removesuffix(".json"))]
        yield from flaws or _flaws_of_products(folder, name)
    if not suites or (folder / MANIFEST).exists() or records_of(folder, LISTS[MANIFEST]):
        yield from _problems_of_paper(folder)


def _problems_of_paper(folder: Path) -> Iterator[str]:
    flaws = {name: [*_flaws_of_list(folder, name, job)] for name, job in LISTS.items()}
    yield from chain.from_iterable(flaws.values())
    if flaws[MANIFEST]:
        listed = [record for job in LISTS.values() for record in records_of(folder, job)]
        yield from chain.from_iterable(found for record, found in false_records(folder) if record not in listed)
    else:
        yield from _flaws_of_products(folder, MANIFEST)


def _flaws_of_products(folder: Path, manifest: str) -> Iterator[str]:
    """Differences of the products that an intact manifest lists, relative to its own folder."""
    products = json.loads((folder / manifest).read_bytes())["products"]
    place = Path(manifest).parent.as_posix()
    yield from differences(folder, {f"{place}/{name}": entry for name, entry in products.items()})


def _flaws_of_list(folder: Path, name: str, job: str) -> Iterator[str]:
    records = records_of(folder, job)
    try:
        (record,) = records
        yield from differences(folder, {name: read_record(record)[name]})
    except (OSError, ValueError, KeyError):
        yield f"{folder / FOLDER / job}.*.json: the record of {name} is missing or damaged"


def main(folder: Path) -> None:
    """Print the differences; exit status 1 if there are any."""
    found = [*problems(folder)]
    if found:
        advice = "`make reproduce`, with the CONFIG they were made with, makes them again"
        sys.exit("\n".join([*found, f"{len(found)} found; {advice}"]))
    print(f"{folder / 'results'}: every product is as the manifest states")


if __name__ == "__main__":
    main(Path(*sys.argv[1:]))
