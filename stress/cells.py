"""Families of hard cases: cells drawn at random for every pulse, sign and equation in turn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count, product
from typing import Any
from zlib import crc32

import numpy as np

from reference.conditioning import MAX_IMPACTS
from reference.exact_pulses import PULSES
from reference.exact_response import ExactResponse, working_precision
from reference.multiprecision import integrate

Cell = dict[str, Any]
"""Parameters of one block: pulse, slenderness, frequency_ratio, restitution [-]; alpha [rad] if it is rigid."""

REQUIREMENTS = ("outcomes", "digits", "bounds", "times")
"""Requirements on a family.

outcomes: every wrong outcome is explained by one ulp of the input; digits: few digits are lost beyond the
conditioning; bounds: error bounds hold; times: no slow cell.
"""

BITS = 128
"""Precision [bits] of the search for cells; their responses are computed again with 192 bits."""


class Draw:
    """Random numbers of a family, the same in every run."""

    def __init__(self, name: str) -> None:
        self.random = np.random.default_rng(crc32(name.encode()))

    def uniform(self, low: float, high: float) -> float:
        return float(self.random.uniform(low, high))

    def log(self, low: float, high: float) -> float:
        """Return a number whose logarithm is uniformly distributed."""
        return float(np.exp(self.random.uniform(np.log(low), np.log(high))))

    def one_of(self, *values: float) -> float:
        return float(self.random.choice(values))


def reference_response(cell: Cell, max_impacts: int = MAX_IMPACTS, **changed: Any) -> ExactResponse:
    """Return the response of a cell in multi-precision arithmetic at `BITS`."""
    with working_precision(BITS):
        return integrate(**(cell | changed), max_impacts=max_impacts)


def any_angle(draw: Draw) -> float:
    """Return a slenderness angle in a range that includes real blocks [rad]."""
    return draw.uniform(0.02, 1.2)


@dataclass(frozen=True)
class Family:
    """Cells drawn one by one.

    Parameters
    ----------
    name : str
        The table is stress/data/NAME.csv.
    reason : str
        Why the family is hard.
    groups : callable
        Draws slenderness, frequency_ratio and restitution [-].
    pulses : tuple of str
        Used in turn, each with both signs, slender and rigid.
    accept : callable
        Whether the response is of the required kind.
    angle : callable
        Draws alpha [rad] of the rigid blocks.
    rigid : tuple of bool
        (False, True), or (True,) for rigid blocks only.
    size : int
        Number of cells.
    requirements : tuple of str
        What is required of the responses: see `report.violations`.
    """

    name: str
    reason: str
    groups: Callable[[Draw], tuple[float, float, float]]
    pulses: tuple[str, ...] = PULSES
    accept: Callable[[ExactResponse], bool] | None = None
    angle: Callable[[Draw], float] = any_angle
    rigid: tuple[bool, ...] = (False, True)
    size: int = 252
    requirements: tuple[str, ...] = REQUIREMENTS

    def cells(self) -> Iterator[Cell]:
        """Yield all cells in order."""
        found = 0
        for cell in draw_cells(self):
            if self.accept is None or self.accept(reference_response(cell)):
                yield cell
                found += 1
                if found == self.size:
                    return


def draw_cells(family: Any) -> Iterator[Cell]:
    """Yield candidates without end: pulses in turn, then the other sign, then the other equation."""
    draw = Draw(family.name)
    kinds = list(product(family.rigid, ("", "-"), family.pulses))
    for k in count():
        rigid, sign, pulse = kinds[k % len(kinds)]
        slenderness, frequency_ratio, restitution = family.groups(draw)
        cell = {
            "pulse": sign + pulse,
            "slenderness": slenderness,
            "frequency_ratio": frequency_ratio,
            "restitution": restitution,
        }
        yield cell | {"alpha": family.angle(draw)} if rigid else cell
