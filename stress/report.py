"""What the records of all families say: three tables, and which promises are broken."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stress.families import BY_NAME

LARGEST_OVER_EXPLAINED = 1000.0
"""Largest error of the peak over what one ulp of the input explains: three of sixteen digits, lost by rounding."""

EXACT_SYMMETRIES = ("mirror", "company", "size_4", "units_1024")


def markdown(records: Mapping[str, Mapping[str, Any]]) -> str:
    """The tables."""
    tables = (
        (
            fates,
            "cells, rigid, stand, impacts up to, wrong fates, events, unexplained, time median, largest, per impact",
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
        *(f"{record['time'][key]:.2g}" for key in ("median", "largest", "slow_per_impact")),
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
        over, slow = record["peak_in_ulps"]["largest"], record["time"]["slow_per_impact"]
        judged = {
            "fates": (len(unexplained(record)), "wrong fates or events that one ulp of the input does not explain"),
            "bounds": (record["beyond_promised_bound"], "peaks beyond the bound that is promised"),
            "digits": (over if over > LARGEST_OVER_EXPLAINED else 0, "times what an ulp explains is the largest error"),
            "times": (slow if slow > 1.0 else 0, "ordinary cells to an impact is the time of a slow one"),
        }
        judged = {promise: judged[promise] for promise in BY_NAME[name].promises}
        for symmetry in EXACT_SYMMETRIES:
            same = record["symmetries"][symmetry]
            judged[symmetry] = (same["cells"] - same["identical"], f"cells change their bits: {symmetry}")
        found += [f"{name}: {value:.0f} {text}" for value, text in judged.values() if value > 0]
    return found
