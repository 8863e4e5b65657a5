"""What families of hard cases are made of: cells drawn at random for every pulse, sign and equation in turn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count, product
from typing import Any
from zlib import crc32

import numpy as np

from reference.conditioning import MOST_IMPACTS
from reference.exact_pulses import PULSES
from reference.exact_response import ExactResponse, working_precision
from reference.multiprecision import integrate

Cell = dict[str, Any]
"""A question to the solver: pulse, slenderness, frequency_ratio, restitution [-]; alpha [rad] if it is rigid."""

PROMISES = ("fates", "digits", "bounds", "times")
"""No wrong fate that one ulp does not explain; few digits lost beyond the conditioning; error bounds; no slow cell."""

BITS = 128
"""Precision at which cells are looked for; their answers are computed anew at 192."""


class Draw:
    """Random numbers of a family, the same on every run."""

    def __init__(self, name: str) -> None:
        self.random = np.random.default_rng(crc32(name.encode()))

    def uniform(self, low: float, high: float) -> float:
        return float(self.random.uniform(low, high))

    def log(self, low: float, high: float) -> float:
        """Uniform in the logarithm."""
        return float(np.exp(self.random.uniform(np.log(low), np.log(high))))

    def one_of(self, *values: float) -> float:
        return float(self.random.choice(values))


def look(cell: Cell, most_impacts: int = MOST_IMPACTS, **changed: Any) -> ExactResponse:
    """The response of a cell in multi-precision arithmetic, to see what happens."""
    with working_precision(BITS):
        return integrate(**(cell | changed), most_impacts=most_impacts)


def any_angle(draw: Draw) -> float:
    """Slenderness angles of real blocks and beyond [rad]."""
    return draw.uniform(0.02, 1.2)


@dataclass(frozen=True)
class Family:
    """Cells drawn one by one.

    Parameters
    ----------
    name : str
        The table is stress/data/NAME.csv.
    why : str
        Why it is hard, in half a line.
    groups : callable
        Draws slenderness, frequency_ratio and restitution [-].
    pulses : tuple of str
        In turn, each with both signs, slender and rigid.
    accept : callable
        Whether the response is of the kind that is wanted.
    angle : callable
        Draws alpha [rad] of the rigid ones.
    rigid : tuple of bool
        (False, True), or (True,) where the slender block has no part in it.
    size : int
        Number of cells.
    promises : tuple of str
        What is held against the answers: see `report.broken`.
    """

    name: str
    why: str
    groups: Callable[[Draw], tuple[float, float, float]]
    pulses: tuple[str, ...] = PULSES
    accept: Callable[[ExactResponse], bool] | None = None
    angle: Callable[[Draw], float] = any_angle
    rigid: tuple[bool, ...] = (False, True)
    size: int = 252
    promises: tuple[str, ...] = PROMISES

    def cells(self) -> Iterator[Cell]:
        """All of them, in order."""
        found = 0
        for cell in drawn(self):
            if self.accept is None or self.accept(look(cell)):
                yield cell
                found += 1
                if found == self.size:
                    return


def drawn(family: Any) -> Iterator[Cell]:
    """Endless candidates: pulses in turn, then the other sign, then the other equation."""
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
