"""The families of hard cases, each with the reason why it is hard; docs/stress.md says how their cells were drawn."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from benchmarks.tables import Table, read_table

DATA = Path(__file__).parent / "data"


class Family(NamedTuple):
    """Why the cells of stress/data/NAME.csv are hard, and what is required of their responses.

    outcomes: every wrong outcome is explained by one ulp of the input; digits: few digits are lost beyond the
    conditioning; bounds: error bounds hold; times: no slow cell.
    """

    reason: str
    requirements: tuple[str, ...] = ("outcomes", "digits", "bounds", "times")


BY_NAME = {
    "ordinary": Family("random cells, for comparison"),
    "onset": Family("1/a = 1 - 1e-2 to 1 - 1e-12: the net acceleration is a small difference of large numbers"),
    "chatter": Family("100 impacts or more"),
    "uplift-again": Family("at rest during the pulse, then uplift again"),
    "grazing": Family("an impact at a very small velocity, or just none"),
    "touching-alpha": Family("the peak is just below or above alpha, and the block survives"),
    "pulse-end": Family("the last impact just before or after the end of the pulse, as in (3.31)"),
    "separatrix": Family("1e-3 to 1e-12 from another outcome"),
    "islands": Family("1e-3 to 1e-12 from overturning after three, five or more impacts"),
    "last-bits": Family(
        "1e-12 to 1e-16 from another outcome: rounding of the input decides", ("digits", "bounds", "times")
    ),
    "strong": Family("1/a down to 1e-4"),
    "impulse": Family("omega up to 1e4: flights as short as 1e-4"),
    "quasi-static": Family("omega down to 1e-4: e^(p T) would overflow"),
    "restitution": Family("eta of 0, 1e-3, 1 - 1e-12, 1"),
    "angles": Family("alpha of 1e-8 to 1.55 rad"),
    "nearly-elastic": Family("eta from 0.9999 under slow pulses: thousands of impacts without rest"),
    "unending": Family("the same with 20,000 to 60,000 impacts"),
}


def read_family(name: str) -> Table:
    """Read the table of a family."""
    return read_table(name, DATA)
