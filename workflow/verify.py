"""Compares every product with the manifest, byte by byte: `python -m workflow.verify [FOLDER]`, or `make verify`.

`--against MANIFEST` then compares the values of the data sets with those of another manifest, such as those in
`workflow/manifests/`. The bytes of a file depend on the code that made it as well, which it names.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from workflow.scripts.manifest import digest_of

MANIFEST = "results/manifest.json"
SUITES = "results/suites/*/manifest.json"  # manifests of the suites of records


def problems(folder: Path) -> Iterator[str]:
    """Descriptions of the differences from the manifests in `folder`, which contains `results`.

    There is one of the paper, which may be missing where only suites were made, and one of each suite.
    """
    manifests = sorted(folder.glob(SUITES))
    if not manifests or (folder / MANIFEST).exists():
        manifests.append(folder / MANIFEST)
    for manifest in manifests:
        try:
            products = json.loads(manifest.read_bytes())["products"]
        except OSError as error:
            yield f"{manifest}: {error.strerror}"
        except (ValueError, KeyError, TypeError):
            yield f"{manifest}: damaged"
        else:
            yield from _differences(manifest.parent, products)


def _differences(folder: Path, products: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    for name, expected in products.items():
        path = folder / name
        try:
            digest = digest_of(path)
        except OSError as error:
            yield f"{path}: {error.strerror}"
        else:
            if not digest.items() <= expected.items():
                yield f"{path}: its bytes are not the listed ones"


def differences_of_values(here: Mapping[str, Any], there: Mapping[str, Any]) -> Iterator[str]:
    """Descriptions of the data sets whose values differ between two manifests, or that one of them lacks."""
    ours, theirs = _data_sets(here), _data_sets(there)
    for name in sorted({*ours, *theirs}):
        if name not in ours or name not in theirs:
            yield f"{name}: not in {'this' if name not in ours else 'the other'} manifest"
        elif ours[name]["content_sha256"] != theirs[name]["content_sha256"]:
            processors = f"{ours[name]['processor']} here, {theirs[name]['processor']} there"
            yield f"{name}: other values; processors: {processors}"


def _data_sets(manifest: Mapping[str, Any]) -> dict[str, Any]:
    """The products of a manifest that have a digest of their values."""
    return {name: entry for name, entry in manifest["products"].items() if "content_sha256" in entry}


def compare(folder: Path, other: Path) -> None:
    """Print the differences of the values in `folder` from another manifest; exit status 1 if there are any."""
    here, there = (json.loads(path.read_bytes()) for path in (folder / MANIFEST, other))
    lines = [*differences_of_values(here, there)]
    if lines:
        advice = "between processors the last digits differ, see docs/cluster.md"
        sys.exit("\n".join([*lines, f"{len(lines)} found; {advice}"]))
    print(f"{folder / 'results'}: the values of all {len(_data_sets(there))} data sets are those of {other}")


def verify(folder: Path) -> None:
    """Print the differences from the manifest; exit status 1 if there are any."""
    lines = [*problems(folder)]
    if lines:
        advice = "delete these files; `make reproduce`, with the CONFIG they were made with, makes them again"
        sys.exit("\n".join([*lines, f"{len(lines)} found; {advice}"]))
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
