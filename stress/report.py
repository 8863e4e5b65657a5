"""What the records of all families say: one table, and which promises are broken."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

UNDECIDED = ("last-bits",)
"""Families closer to another fate than any arithmetic on doubles resolves: their wrong fates are told, not judged."""

SLOWEST = 100.0
"""Largest time of a cell over the median ordinary one."""

EXACT_SYMMETRIES = ("mirror", "company", "size_4", "units_1024")

HEADINGS = (
    *("family", "cells", "stand", "impacts"),
    *("wrong fates", "wrong events", "not by 1 ulp", "ulps needed"),
    *("median error", "largest error", "conditioning", "median / expl.", "largest / expl.", "beyond bound"),
    *("median time", "slowest"),
)


def relative_times(parts: Mapping[str, Mapping[str, NDArray[Any]]]) -> dict[str, NDArray[np.float64]]:
    """Times (cells,) over the median of the ordinary cells, slender and rigid each over their own [-]."""
    ordinary = parts["ordinary"]
    usual = {kind: float(np.median(ordinary["time"][ordinary["rigid"] == kind])) for kind in (False, True)}
    return {name: part["time"] / np.where(part["rigid"], usual[True], usual[False]) for name, part in parts.items()}


def row(name: str, record: Mapping[str, Any]) -> list[str]:
    """One line of the table."""
    wrong = record["wrong"]
    needed = [cell["explained_by_ulps"] for cell in wrong]
    most = "-" if not needed else "none" if None in needed else str(max(needed))
    return [
        *(name, str(record["cells"]), str(record["stand"]), str(record["most_impacts"])),
        *(str(sum(cell["wrong"] == kind for cell in wrong)) for kind in ("fate", "events")),
        *(str(sum(ulps != 1 for ulps in needed)), most),
        *(f"{record['peak'][key]:.1e}" for key in ("median", "largest")),
        f"{record['largest_conditioning']:.0e}",
        *(f"{record['peak_in_ulps'][key]:.2g}" for key in ("median", "largest")),
        str(record["beyond_promised_bound"]),
        *(f"{record['time'][key]:.2g}" for key in ("median", "slowest")),
    ]


def markdown(records: Mapping[str, Mapping[str, Any]]) -> str:
    """The table."""
    lines = [HEADINGS, ["---"] * len(HEADINGS), *(row(name, record) for name, record in records.items())]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def broken(records: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Promises that are not kept, in words."""
    found = []
    for name, record in records.items():
        unexplained = [cell for cell in record["wrong"] if cell["explained_by_ulps"] != 1]
        if unexplained and name not in UNDECIDED:
            found.append(f"{name}: {len(unexplained)} wrong fates or events that one ulp of the input does not explain")
        for symmetry in EXACT_SYMMETRIES:
            kept = record["symmetries"][symmetry]
            if kept["identical"] < kept["cells"]:
                found.append(f"{name}: {symmetry} changes the bits of {kept['cells'] - kept['identical']} cells")
        if record["time"]["slowest"] > SLOWEST:
            found.append(f"{name}: a cell takes {record['time']['slowest']:.0f} times an ordinary one")
    return found
