"""Compares every product with the manifest, byte by byte: `python -m workflow.verify [FOLDER]`, or `make verify`.

`--against MANIFEST` then compares the values of the data sets with those of another manifest, such as those in
`workflow/manifests/`. The bytes of a file depend on the code that made it as well, which it names.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

from workflow.records import FOLDER, differences, false_records, read_record, records_of

MANIFEST = "results/manifest.json"

LISTS = {MANIFEST: "manifest", "results/checks.txt": "check_results"}
"""Products that the manifest cannot list, and the job of each."""

SUITES = "results/suites/*/manifest.json"  # manifests of the suites of records


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


def differences_of_values(here: Mapping[str, Any], there: Mapping[str, Any]) -> Iterator[str]:
    """Descriptions of the data sets whose values differ between two manifests, or that one of them lacks."""
    ours, theirs = (_data_sets(manifest) for manifest in (here, there))
    for name in sorted({*ours, *theirs}):
        if name not in ours or name not in theirs:
            yield f"{name}: not in {'this' if name not in ours else 'the other'} manifest"
        elif ours[name]["content_sha256"] != theirs[name]["content_sha256"]:
            made_by = f"{ours[name]['processor']} here, {theirs[name]['processor']} there"
            yield f"{name}: other values; processors: {made_by}"


def _data_sets(manifest: Mapping[str, Any]) -> dict[str, Any]:
    """The products of a manifest that have a digest of their values."""
    return {name: entry for name, entry in manifest["products"].items() if "content_sha256" in entry}


def compare(folder: Path, other: Path) -> None:
    """Print the differences of the values in `folder` from another manifest; exit status 1 if there are any."""
    here, there = (json.loads(path.read_bytes()) for path in (folder / MANIFEST, other))
    found = [*differences_of_values(here, there)]
    if found:
        advice = "between processors the last digits differ, see docs/cluster.md"
        sys.exit("\n".join([*found, f"{len(found)} found; {advice}"]))
    print(f"{folder / 'results'}: the values of all {len(_data_sets(there))} data sets are those of {other}")


def verify(folder: Path) -> None:
    """Print the differences from the manifest; exit status 1 if there are any."""
    found = [*problems(folder)]
    if found:
        advice = "`make reproduce`, with the CONFIG they were made with, makes them again"
        sys.exit("\n".join([*found, f"{len(found)} found; {advice}"]))
    print(f"{folder / 'results'}: every product is as the manifest states")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(), help="folder with the folder `results`")
    parser.add_argument("--against", type=Path, metavar="MANIFEST", help="another manifest")
    options = parser.parse_args()
    verify(options.folder)
    if options.against is not None:
        compare(options.folder, options.against)


if __name__ == "__main__":
    main()
