"""Compares the responses of random cells between this tree and another checkout of the package.

    python -m stress.versions OTHER_TREE --cells 10_000_000
    python -m stress.versions . --processor haswell

With `--processor` the other tree is compiled for other instructions, by the name that LLVM has for them.

Cells are drawn in chunks, for all named pulses and a record in turn, slender and rigid, and solved by a process of each
tree (`benchmarks.checkouts`). A comparison that was interrupted is continued by the same command. Reported for each
kind of cell:

- peaks: the largest relative difference, and the largest over the effect of one rounding, 2^-53, of each input and of
  the peak itself, which follows from the conditioning of the cell;
- events: cells whose outcome or (without chatter) number of impacts differ. One is explained if each tree finds what
  the other has found when inputs change by at most `MAX_ULPS`: so near, the rounding of the inputs decides. The exit
  status is 1 if one is not.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from benchmarks.checkouts import INPUTS, Checkout
from benchmarks.measure import arguments, columns, progress, save
from rocking._base.source_tree import PROJECT, SourceTree
from rocking._excitation.pulses import PULSE_NAMES

RECORD = PROJECT / "workflow/motions/napa_HNE.csv"

CHUNK, RECORD_CHUNK = 100_000, 5_000
"""Cells of a chunk; of a record, under which a cell takes some hundred times as long."""

ROUNDING = 2.0**-53
"""Relative error of a number that is rounded to a double [-]."""

SMALL = 1e-10
"""Relative change of an input by which conditioning is measured [-]: the differences are exact to six digits."""

MAX_ULPS = 256
"""Largest change of the inputs, in units in the last place, that explains another outcome."""


def kinds() -> list[dict[str, Any]]:
    """The kinds of cells, in the order of the chunks."""
    motions = [(name, False, CHUNK) for name in PULSE_NAMES] + [(str(RECORD), True, RECORD_CHUNK)]
    return [
        {"pulse": name, "record": record, "rigid": rigid, "size": size}
        for (name, record, size), rigid in product(motions, (False, True))
    ]


def same_events(one: NDArray[np.void], other: NDArray[np.void]) -> NDArray[np.bool_]:
    """Where outcomes and, without chatter, the numbers of impacts are equal."""
    counted = ~one["chatter"] & ~other["chatter"]
    return np.asarray((one["outcome"] == other["outcome"]) & (~counted | (one["impacts"] == other["impacts"])))


def compare_chunk(chunk: dict[str, Any], trees: Sequence[Checkout]) -> dict[str, Any]:
    """Solve a chunk in both trees and compare the responses."""
    for tree in trees:
        tree.start(chunk)
    (here, seconds), (there, others) = (tree.result() for tree in trees)
    same = same_events(here, there)
    with np.errstate(invalid="ignore", divide="ignore"):
        change = np.abs(there["peak_rotation"] / here["peak_rotation"] - 1.0)
    change = np.where(same, np.nan_to_num(change), 0.0)  # nan: both overturn, or none uplifts
    moved = np.flatnonzero(change)
    over = change[moved] / (ROUNDING * (1.0 + conditioning(chunk, moved, here, trees[0])))
    differing = np.flatnonzero(~same)
    return {
        "cells": here.size,
        "outcomes": int(np.sum(here["outcome"] != there["outcome"])),
        "impacts": int(differing.size - np.sum(here["outcome"] != there["outcome"])),
        "equal_peaks": int(np.sum(same & (change == 0.0))),
        "largest_change": float(change.max()),
        "largest_over_conditioning": float(over.max(initial=0.0)),
        "seconds": seconds,
        "seconds_there": others,
        "differences": [
            {"cell": int(k), "ulps": ulps, "here": here[k].tolist()[1:3], "there": there[k].tolist()[1:3]}
            for k, ulps in zip(differing, ulps_that_explain(chunk, differing, here, there, trees), strict=True)
        ],
    }


def conditioning(
    chunk: dict[str, Any], cells: NDArray[np.intp], found: NDArray[np.void], tree: Checkout
) -> NDArray[np.float64]:
    """Sum over the inputs of the relative change of the peak over that of the input [-]; infinite at a boundary."""
    total = np.zeros(cells.size)
    for k in range(len(INPUTS)):
        factors = np.ones(len(INPUTS))
        factors[k] -= SMALL
        moved = tree.solve(chunk, cells, factors)
        with np.errstate(invalid="ignore", divide="ignore"):
            change = np.abs(moved["peak_rotation"] / found["peak_rotation"][cells] - 1.0) / SMALL
        total += np.where(np.isnan(change), np.inf, change)
    return total


def ulps_that_explain(
    chunk: dict[str, Any],
    cells: NDArray[np.intp],
    here: NDArray[np.void],
    there: NDArray[np.void],
    trees: Sequence[Checkout],
) -> list[int | None]:
    """The change of the inputs, in ulps, with which each tree finds what the other has found; None above `MAX_ULPS`.

    Both have to: a tree that errs at single points finds what the other has found next to them.
    """
    needed = [ulps_to_find(chunk, cells, wanted, tree) for tree, wanted in zip(trees, (there, here), strict=True)]
    return [None if None in pair else max(filter(None, pair)) for pair in zip(*needed, strict=True)]


def ulps_to_find(
    chunk: dict[str, Any], cells: NDArray[np.intp], wanted: NDArray[np.void], tree: Checkout
) -> list[int | None]:
    """The change of the inputs, in ulps, with which a tree finds the wanted events; None above `MAX_ULPS`."""
    found: list[int | None] = [None] * cells.size
    ulps = 1
    while ulps <= MAX_ULPS and None in found:
        for steps in product((-ulps, 0, ulps), repeat=len(INPUTS)):
            left = np.array([k for k, known in enumerate(found) if known is None], dtype=np.intp)
            if not left.size:
                break
            moved = tree.solve(chunk, cells[left], 1.0 + 2.0 * ROUNDING * np.array(steps))
            for k in left[same_events(moved, wanted[cells[left]])]:
                found[k] = ulps
        ulps *= 2
    return found


def summary(kind: dict[str, Any], chunks: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The results of the chunks of one kind together."""
    added = ("cells", "outcomes", "impacts", "equal_peaks", "seconds", "seconds_there")
    largest = ("largest_change", "largest_over_conditioning")
    total = {name: sum(chunk[name] for chunk in chunks) for name in added}
    total |= {name: max(chunk[name] for chunk in chunks) for name in largest}
    differences = [{"seed": chunk["seed"], **one} for chunk in chunks for one in chunk["differences"]]
    name = f"{Path(kind['pulse']).stem}, {'rigid' if kind['rigid'] else 'slender'}"
    return {"kind": name, **total, "differences": differences}


def table(rows: Sequence[dict[str, Any]]) -> str:
    """The comparison as text."""
    found = pd.DataFrame(rows)
    found["unexplained"] = [len(unexplained(row)) for row in rows]
    for name, seconds in {"equal": "equal_peaks", "us_here": "seconds", "us_there": "seconds_there"}.items():
        found[name] = (100.0 if name == "equal" else 1e6) * found[seconds] / found["cells"]
    peaks = {"equal": "equal peaks [%]", "largest_change": "largest", "largest_over_conditioning": "over conditioning"}
    events = {"outcomes": "outcomes", "impacts": "impacts", "unexplained": "unexplained"}
    return columns(found, kind="", cells="cells", **peaks, **events, us_here="us here", us_there="us there")


def unexplained(row: dict[str, Any]) -> list[dict[str, Any]]:
    """The differences of events that the rounding of the inputs does not explain."""
    return [one for one in row["differences"] if one["ulps"] is None]


def main() -> None:
    """Command line."""
    out = Path("results/stress/versions.json")
    options = arguments(__doc__, other=Path, cells=1_000_000, seed=0, processor="", out=out)
    roots = PROJECT, options.other.resolve()
    if not (roots[1] / "rocking/__init__.py").is_file():
        sys.exit(f"{options.other}: no folder rocking/ with the package")
    digests = [SourceTree(root).digest_of(SourceTree(root).package()) for root in roots]
    identity = {"seed": options.seed, "processor": options.processor, "digests": digests, "kinds": kinds()}
    chunks: list[dict[str, Any]] = []
    if options.out.exists():
        former = json.loads(options.out.read_bytes())
        chunks = former["chunks"] if {name: former.get(name) for name in identity} == identity else []
    trees, partial = [Checkout(roots[0]), Checkout(roots[1], options.processor)], options.out.with_suffix(".partial")
    done = sum(chunk["cells"] for chunk in chunks)
    while done < options.cells:
        seed = [options.seed, len(chunks)]
        found = compare_chunk(kinds()[len(chunks) % len(kinds())] | {"seed": seed}, trees)
        chunks.append({"seed": seed, **found})
        done += found["cells"]
        save(identity | {"chunks": chunks}, partial)
        partial.replace(options.out)
        progress(f"{done} of {options.cells} cells")
    for tree in trees:
        tree.close()
    rows = [summary(kind, chunks[k :: len(kinds())]) for k, kind in enumerate(kinds()[: len(chunks)])]
    print(table(rows))
    left = [f"{row['kind']}: {one}" for row in rows for one in unexplained(row)]
    if left:
        sys.exit("\n".join(["events that the rounding of the inputs does not explain:", *left]))


if __name__ == "__main__":
    main()
