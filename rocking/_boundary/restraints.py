"""The tendon, prestress or damper that saves a block: where its outcome changes along one of the three."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array, Flags
from rocking._base.equality import EqualByValue
from rocking._base.errors import number, one_of
from rocking._base.quantities import DAMPING, PRESTRESS, RESTRAINTS, STIFFNESS
from rocking._base.units import Scalar
from rocking._boundary.amplitude import one_restraint
from rocking._boundary.scan import RESOLUTION, checked_resolution
from rocking._excitation.pulses import AbstractPulse
from rocking._excitation.records.record import Record
from rocking._numba.cancellation import StopFlag
from rocking._solver.peak_response import peak_response

Name = Literal["stiffness", "prestress", "damping"]

HIGHEST = {STIFFNESS.name: 100.0, PRESTRESS.name: 100.0, DAMPING.name: 3.0}
"""Largest group searched by default [-]; of the prestress at most that at which the block does not uplift."""

NARROW = 1e-9  # largest distance of the two values between which a change is bisected, over 1 + the value [-]

PARTS = 16  # parts into which a bracket is divided at a time


@dataclass(frozen=True, eq=False, repr=False)
class SavingRestraint(EqualByValue):
    """Values of one restraint at which the outcome of a block changes, ascending.

    Attributes
    ----------
    name : {"stiffness", "prestress", "damping"}
        Which restraint.
    unit : str
        Of the values: "-" of the groups; N/m, N or N s/m.
    value : float array (changes,)
        The block survives at it, and overturns at one side of it.
    survives_above : bool array (changes,)
        Whether it survives just above, and overturns just below.
    survives_without : bool
        Whether it survives without this restraint.
    highest : float
        Largest value searched.
    resolution : float
        Largest distance of two values that were tried, over 1 + the group [-]; a narrower range can be missed.
    """

    name: str
    unit: str
    value: Array
    survives_above: Flags
    survives_without: bool
    highest: float
    resolution: float

    @property
    def lowest(self) -> float:
        """Smallest value with which the block survives; nan if there is none up to the highest."""
        if self.survives_without:
            return 0.0
        return float(self.value[0]) if self.value.size else math.nan

    @property
    def safe(self) -> float:
        """Smallest value from which on the block survives up to the highest; nan if there is none.

        It exceeds `lowest` where more of a restraint overturns the block again.
        """
        if not self.value.size:
            return self.lowest
        return float(self.value[-1]) if self.survives_above[-1] else math.nan

    def in_units(self, factor: float, unit: str) -> SavingRestraint:
        """Return the same with values times `factor`, in another unit."""
        return replace(self, unit=unit, value=self.value * factor, highest=self.highest * factor)

    def __repr__(self) -> str:
        """The restraint in words."""
        unit = "" if self.unit == "-" else f" {self.unit}"
        if math.isnan(self.lowest):
            return f"<rocking.SavingRestraint: no {self.name} up to {self.highest:.6g}{unit} was found to save it>"
        words = "it survives without any" if self.survives_without else f"it survives from {self.lowest:.6g}{unit} on"
        if self.safe != self.lowest:
            words += f", up to {self.highest:.6g}{unit} only from {self.safe:.6g}{unit} on"
        return f"<rocking.SavingRestraint: {self.name}: {words}>"


def saving_restraint(
    motion: str | AbstractPulse | Record,
    name: Name,
    *,
    slenderness: Scalar,
    frequency_ratio: Scalar | None = None,
    frequency_parameter: Scalar | None = None,
    restitution: Scalar,
    alpha: Scalar | None = None,
    stiffness: Scalar = 0.0,
    prestress: Scalar = 0.0,
    damping: Scalar = 0.0,
    vertical_scale: Scalar | None = None,
    highest: Scalar | None = None,
    resolution: Scalar = RESOLUTION,
    stop: StopFlag | None = None,
) -> SavingRestraint:
    """Find the smallest tendon stiffness, prestress or damping with which a block survives a motion.

    Parameters
    ----------
    motion, slenderness, frequency_ratio, frequency_parameter, restitution, alpha, vertical_scale
        As for `peak_response`; scalars.
    name : {"stiffness", "prestress", "damping"}
        The restraint that is searched.
    stiffness, prestress, damping : float
        The two others [-]; that of `name` is not read.
    highest : float, optional
        Largest group searched [-]; by default 100 of stiffness and prestress, 3 of damping, and at most the prestress
        at which the block does not uplift.
    resolution : float
        Largest distance of two values tried, over 1 + the value [-], [1e-4, 0.1]. The outcome need not be monotone, so
        that a narrower range can be missed; changes that are found are bisected to 1e-9.
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Examples
    --------
    >>> saving_restraint("sine", "damping", slenderness=0.5, frequency_ratio=3.0, restitution=0.9)
    <rocking.SavingRestraint: damping: it survives from 0.273262 on>
    """
    one_of("name", name, HIGHEST)
    held = one_restraint(stiffness, prestress, damping)
    held.pop(name, None)
    vertical = isinstance(motion, Record) and motion.vertical is not None
    groups: dict[str, Any] = {
        "slenderness": slenderness,
        "frequency_ratio": frequency_ratio,
        "frequency_parameter": frequency_parameter,
        "restitution": restitution,
        "alpha": alpha,
        "vertical_scale": vertical_scale,
    }

    def overturned(values: Array) -> Flags:
        restraints: dict[str, Any] = {**held, name: values}
        return np.asarray(peak_response(motion, **groups, **restraints, stop=stop).overturned)

    top = None if highest is None else number("highest", highest, 0.0, _range_end(name), closed="right")
    if top is None:
        without_uplift = math.inf if vertical else max(1.0 / float(np.asarray(slenderness)) - 1.0, 0.0)
        top = min(HIGHEST[name], without_uplift) if name == PRESTRESS.name else HIGHEST[name]
    return search_restraint(overturned, name, top, checked_resolution(resolution))


def _range_end(name: str) -> float:
    return next(quantity.upper for quantity in RESTRAINTS if quantity.name == name)


def search_restraint(
    overturned: Callable[[Array], Flags], name: str, highest: float, resolution: float
) -> SavingRestraint:
    """`saving_restraint` of a block whose outcomes at values of the group (size,) `overturned` gives."""
    count = max(math.ceil(math.log1p(highest) / math.log1p(resolution)), 1)
    grid: NDArray[np.float64] = np.expm1(np.linspace(0.0, math.log1p(highest), count + 1))
    grid[-1] = highest
    falls = overturned(grid)
    changes = np.flatnonzero(falls[1:] != falls[:-1])
    values = [_bisected(overturned, float(grid[k]), float(grid[k + 1]), bool(falls[k + 1])) for k in changes.tolist()]
    return SavingRestraint(name, "-", np.array(values), falls[changes], not falls[0], highest, resolution)


def _bisected(overturned: Callable[[Array], Flags], low: float, high: float, falls_above: bool) -> float:
    """The end at which the block survives of the interval that holds a change, once the interval is narrow."""
    while high - low > NARROW * (1.0 + low):
        inner = np.linspace(low, high, PARTS + 1)[1:-1]
        falls = overturned(inner) == falls_above
        first = int(falls.argmax()) if falls.any() else inner.size
        edges = np.concatenate([[low], inner, [high]])
        if not low < edges[first + 1] <= high:
            break
        low, high = float(edges[first]), float(edges[first + 1])
    return low if falls_above else high
