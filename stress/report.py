"""What the records of all families say: three tables, and which promises are broken."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stress.families import BY_NAME

LARGEST_OVER_EXPLAINED = 1000.0
"""Largest error of the peak over what one ulp of the input explains: three of sixteen digits, lost by rounding."""

SLOWEST = 100.0
"""Largest time of a cell over the median ordinary one."""

EXACT_SYMMETRIES = ("mirror", "company", "size_4", "units_1024")


def relative_times(parts: Mapping[str, Mapping[str, NDArray[Any]]]) -> dict[str, NDArray[np.float64]]:
    """Times (cells,) over the median of the ordinary cells, slender and rigid each over their own [-]."""
    ordinary = parts["ordinary"]
    usual = {kind: float(np.median(ordinary["time"][ordinary["rigid"] == kind])) for kind in (False, True)}
    return {name: part["time"] / np.where(part["rigid"], usual[True], usual[False]) for name, part in parts.items()}


def markdown(records: Mapping[str, Mapping[str, Any]]) -> str:
    """The tables."""
    tables = (
        (
            fates,
            "cells, rigid, stand, impacts up to, wrong fates, wrong events, unexplained, time median, time largest",
        ),
        (
            numbers,
            "error median, largest, conditioning up to, over explained median, largest, uplift, impact, bound",
        ),
        (kept, "mirror, company, size x 4, units x 1024, size x 3.7 fates, largest, units mm and ms fates, largest"),
    )
    texts = []
    for line, headings in tables:
        rows = [["family", *headings.split(", ")], ["---"] * (1 + len(headings.split(", ")))]
        rows += [[name, *line(record)] for name, record in records.items()]
        texts.append("".join("| " + " | ".join(cells) + " |\n" for cells in rows))
    return "\n".join(texts)


def fates(record: Mapping[str, Any]) -> list[str]:
    """What happens to the blocks, and the time it takes over that of an ordinary cell."""
    wrong = record["wrong"]
    return [
        *(str(record[key]) for key in ("cells", "rigid", "stand", "most_impacts")),
        *(str(sum(cell["wrong"] == kind for cell in wrong)) for kind in ("fate", "events")),
        str(len(unexplained(record))),
        *(f"{record['time'][key]:.2g}" for key in ("median", "largest")),
    ]


def numbers(record: Mapping[str, Any]) -> list[str]:
    """Relative errors of the peak, and errors over what the last bit of the input explains."""
    return [
        *(f"{record['peak'][key]:.1e}" for key in ("median", "largest")),
        f"{record['largest_conditioning']:.1e}",
        *(f"{record['peak_in_ulps'][key]:.2g}" for key in ("median", "largest")),
        *(f"{record[key]['largest']:.2g}" for key in ("uplift_time_in_ulps", "impact_time_in_ulps")),
        str(record["beyond_promised_bound"]),
    ]


def kept(record: Mapping[str, Any]) -> list[str]:
    """Cells that keep all bits, other fates and largest change over the conditioning where the groups are rounded."""
    found = record["symmetries"]
    rounded = [found[symmetry] for symmetry in ("size_3.7", "units_mm_ms")]
    return [
        *(str(found[symmetry]["identical"]) for symmetry in EXACT_SYMMETRIES),
        *(text for part in rounded for text in (str(part["other_fates"]), f"{part['largest_in_ulps']:.2g}")),
    ]


def unexplained(record: Mapping[str, Any]) -> list[Any]:
    """Wrong cells that one unit in the last place of the input does not explain."""
    return [cell for cell in record["wrong"] if cell["explained_by_ulps"] != 1]


def broken(records: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Promises that are not kept, in words; each family says which hold for it, symmetries hold for all."""
    found = []
    for name, record in records.items():
        over, slowest = record["peak_in_ulps"]["largest"], record["time"]["largest"]
        judged = {
            "fates": (len(unexplained(record)), "wrong fates or events that one ulp of the input does not explain"),
            "bounds": (record["beyond_promised_bound"], "peaks beyond the bound that is promised"),
            "digits": (over if over > LARGEST_OVER_EXPLAINED else 0, "times what an ulp explains is the largest error"),
            "times": (slowest if slowest > SLOWEST else 0, "times an ordinary cell is the slowest"),
        }
        judged = {promise: judged[promise] for promise in BY_NAME[name].promises}
        for symmetry in EXACT_SYMMETRIES:
            same = record["symmetries"][symmetry]
            judged[symmetry] = (same["cells"] - same["identical"], f"cells change their bits: {symmetry}")
        found += [f"{name}: {value:.0f} {text}" for value, text in judged.values() if value > 0]
    return found
