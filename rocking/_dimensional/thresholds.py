"""Strengths of a ground motion at which the outcome changes: peak accelerations of a pulse, factors of a record."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking._base.arrays import Array, Flags
from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError, number
from rocking._base.quantities import HIGHEST_SCALE
from rocking._base.units import Scalar
from rocking._boundary.amplitude import amplitude_changes
from rocking._boundary.scan import RESOLUTION, Lines, checked_resolution, lowest_overturning, outcome_changes
from rocking._dimensional.lowest_thresholds import record_lines, record_range
from rocking._dimensional.problem import Problem, record_groups, restitution_of, search_range
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._model.block import AbstractBlock
from rocking._model.labelled import Index, with_index
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.record_response import record_cells
from rocking._solver.records.samples import motion_samples

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


from collections.abc import Iterable
from decimal import ROUND_CEILING, ROUND_FLOOR, Context

from rocking._boundary.scan import RELATIVE_ERROR  # that of elastic blocks under pulses, too

MARGIN = 0.05
"""Relative distance of a change of outcome below which a warning is given [-]: ground motions are not known better."""

DIGITS = 6  # significant digits of a threshold in texts [-]

MAX_LISTED = 4  # changes of outcome that a warning lists; of more, it states the number and both ends


@dataclass(frozen=True)
class Threshold:
    """A value at which the outcome changes."""

    value: float  # peak acceleration [m/s2], period [s], half-diagonal [m], or factor of a record [-]
    overturns_above: bool  # true: the block overturns just above and survives just below; False: the reverse

    def __str__(self) -> str:
        """The outcome above the value in words, such as `overturns above 4.70006`."""
        return f"{'overturns' if self.overturns_above else 'survives'} above {self.text()}"

    def text(self, digits: int = DIGITS) -> str:
        """The value with some significant digits, 1 to 15, on the safe side of itself and of its error."""
        return threshold_text(self.value, digits, overturns_above=self.overturns_above)


def threshold_text(value: float, digits: int = DIGITS, *, overturns_above: bool = True) -> str:
    """A threshold > 0 as text: rounded down if the block overturns above it, rounded up if it survives there."""
    error, rounding = (-RELATIVE_ERROR, ROUND_FLOOR) if overturns_above else (RELATIVE_ERROR, ROUND_CEILING)
    rounded = Context(prec=digits, rounding=rounding).create_decimal_from_float(value * (1.0 + error))
    return f"{float(rounded):.{digits}g}"


def warnings_of_changes(given: float, changes: Iterable[Threshold], name: str, unit: str = "") -> list[str]:
    """A warning that the outcome changes close to the given value."""
    near = sorted((one for one in changes if abs(one.value / given - 1.0) < MARGIN), key=lambda one: one.value)
    if not near:
        return []
    places = f"at {', '.join(one.text() for one in near)}"
    if len(near) > MAX_LISTED:
        places = f"{len(near)} times, from {near[0].text()} to {near[-1].text()}"
    return [f"the outcome changes within {100 * MARGIN:g} % of this {name}: {places}{unit}"]


BEYOND = 10.0, 2.0  # the same over the strength of the problem, where that is larger: under pulses, and records

WORDS = {
    "peak_acceleration": ("peak acceleration", " m/s2", "a peak acceleration of {} m/s2", " m/s2"),
    "scale": ("factor of the record", "", "{} times the record", " times"),
}
"""Kinds of strength: name, unit, one from which a body overturns, and the unit after `up to`."""


@dataclass(frozen=True, eq=False, repr=False)
class BodyThresholds(EqualByValue):
    """Strengths of a ground motion at which the outcome changes, for each body; of one body a sequence of `Threshold`.

    Attributes
    ----------
    value : float array (..., thresholds)
        Peak acceleration of a pulse [m/s2], or factor of a record [-], ascending; nan beyond the last of a body. The
        body overturns at it, and survives within a relative 1e-6 of it.
    overturns_above : bool array (..., thresholds)
        True where the body overturns just above and survives just below.
    searched : float array (..., 2)
        Lowest and highest strength searched, from uplift on.
    strength : {"peak_acceleration", "scale"}
        What the values are.
    ends_in_flight : bool
        Whether the search for one body ended at the factor at which the vertical acceleration reaches -g.
    index : (name, labels) or None
        Index of the last axis of the bodies if an argument was a series (pandas).
    resolution : float
        Of a record: largest relative distance of the factors tried up to the lowest value [-]; 0 of a pulse.
    """

    value: Array
    overturns_above: Flags
    searched: Array
    strength: str
    ends_in_flight: bool = False
    index: Index | None = field(default=None, compare=False)
    resolution: float = 0.0

    @property
    def lowest(self) -> Array:
        """Lowest strength at which each body overturns; nan where none was found. Array (...)."""
        if not self.value.shape[-1]:
            return np.full(self.value.shape[:-1], math.nan)
        return self.value[..., 0]

    @cached_property
    def changes(self) -> tuple[Threshold, ...]:
        """The thresholds of one body, as a list."""
        if self.value.ndim > 1:
            raise InvalidArgumentError("thresholds", f"shape {self.value.shape[:-1]}", "those of one body")
        return tuple(map(Threshold, self.value.tolist(), self.overturns_above.tolist()))

    def __len__(self) -> int:
        return len(self.changes)

    def __iter__(self) -> Iterator[Threshold]:
        return iter(self.changes)

    def __getitem__(self, index: int) -> Threshold:
        return self.changes[index]

    @property
    def sentence(self) -> str:
        """In words: the strength from which one body overturns, and the number of changes of the outcome above it."""
        name, unit, from_strength, up_to = WORDS[self.strength]
        top = threshold_text(float(self.searched[1]))
        end = f"; from {top} times on its vertical acceleration reaches -g" if self.ends_in_flight else ""
        if not self.changes:
            tried = f" (factors at most {100.0 * self.resolution:g} % apart were tried)" if self.resolution else ""
            return f"no {name} up to {top}{unit} was found to overturn it{tried}{end}"
        first, *others = self.changes
        more = f"; above that the outcome changes {len(others)} more times up to {top}{up_to}" if others else ""
        return f"it overturns from {from_strength.format(first.text())}{more}{end}"

    def __repr__(self) -> str:
        """The lowest thresholds in words."""
        if self.value.ndim == 1:
            return f"<rocking.BodyThresholds: {self.sentence}>"
        shape = " x ".join(map(str, self.value.shape[:-1]))
        found = self.lowest[~np.isnan(self.lowest)]
        unit = WORDS[self.strength][1]
        ends = f", lowest from {found.min():.4g} to {found.max():.4g}{unit}" if found.size else ""
        return f"<rocking.BodyThresholds of {shape} bodies: {found.size} overturn{ends}>"

    def to_xarray(self) -> xr.Dataset:
        """The thresholds as a data set over the axes of the bodies and `threshold`, with units."""
        import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

        axes = [f"dim_{axis}" for axis in range(self.value.ndim - 1)]
        name, unit, *_ = WORDS[self.strength]
        units = {"units": unit.strip().replace("/s2", " s-2") or "1"}
        about = units | {"long_name": f"{name} at which the outcome changes"}
        above = {"units": "1", "long_name": "whether the body overturns just above"}
        variables: dict[str, Any] = {
            self.strength: ((*axes, "threshold"), self.value, about),
            "overturns_above": ((*axes, "threshold"), self.overturns_above, above),
            "searched": ((*axes, "end"), self.searched, units | {"long_name": f"lowest and highest {name} searched"}),
        }
        found = xr.Dataset(variables)
        return with_index(found, axes[-1], self.index) if axes else found

    def to_pandas(self) -> pd.DataFrame:
        """The thresholds as rows; the index has the axes of `to_xarray`."""
        return self.to_xarray().drop_vars("searched").to_dataframe()


def thresholds_of(
    problem: Problem, highest: float | None = None, stop: StopFlag | None = None, resolution: float = RESOLUTION
) -> BodyThresholds:
    """Every strength of its motion at which the outcome changes, for each body of a problem.

    Under a pulse as `rocking.thresholds`. Under a record the lowest is that of `lowest_overturning` from uplift on, at
    this resolution; above it factors 0.2 % apart are solved, and each change is bisected: a range of one outcome that
    is narrower can be missed. The search ends below the factor at which the vertical acceleration reaches -g.
    `highest`: in the unit of the strength; by default `highest_amplitude` of the motion times that of uplift, and at
    least `BEYOND` times the strength of the problem.
    """
    motion, shape = problem.motion, problem.shape
    by_record = motion.is_scanned
    at_one = replace(problem, strength=np.ones(shape))
    uplift = np.broadcast_to(problem.body.uplift_acceleration, shape).ravel() / motion.unit_acceleration
    limit = np.full(uplift.size, math.inf)
    if by_record:
        found_uplift, limit = record_range(at_one)
        uplift = uplift if motion.vertical is None else found_uplift
    if highest is None:
        own = np.broadcast_to(problem.strength, shape).ravel()
        top = np.maximum(motion.highest_amplitude * uplift, BEYOND[by_record] * own)
    else:
        top = np.full(uplift.size, highest)
    top = np.minimum(top, motion.strength.upper)
    flies, searched = limit < top, np.minimum(top, limit)
    lines = record_lines(at_one, stop) if by_record else None

    def changes(k: int) -> tuple[Array, Flags]:
        if searched[k] <= uplift[k]:
            return np.empty(0), np.empty(0, dtype=np.bool_)
        if lines is None:
            return _pulse_changes(at_one, k, uplift[k], searched[k], stop)
        return outcome_changes(lines.from_line(k), uplift[k], top[k], limit[k], resolution=resolution)

    found = [changes(k) for k in range(uplift.size)]
    most = max((values.size for values, _ in found), default=0)
    value, above = np.full((uplift.size, most), math.nan), np.zeros((uplift.size, most), dtype=np.bool_)
    for k, (values, up) in enumerate(found):
        value[k, : values.size], above[k, : values.size] = values, up
    return BodyThresholds(
        value.reshape(*shape, most),
        above.reshape(*shape, most),
        np.stack([uplift, np.maximum(uplift, searched)], axis=-1).reshape(*shape, 2),
        motion.strength.name,
        ends_in_flight=bool(flies.all()) and shape == (),
        index=problem.index,
        resolution=resolution if by_record else 0.0,
    )


def scale_window(problem: Problem) -> tuple[float, float]:
    """Factors of a record from that at which one body uplifts to ten times it, or where it would lose its weight."""
    uplift, limit = record_range(replace(problem, strength=np.ones(())))
    lowest = float(uplift[0])
    return lowest, min(problem.motion.highest_amplitude * lowest, float(limit[0]))


def _pulse_changes(
    problem: Problem, k: int, uplift: float, highest: float, stop: StopFlag | None
) -> tuple[Array, Flags]:
    cell = problem.cells[k]
    found = amplitude_changes(
        problem.solver(k, stop), float(cell["rate"]), float(cell["eta"][0]), min(highest / uplift, 1e6)
    )
    return found.amplitude * uplift, found.overturns_above


def overturning_scale(
    record: Record,
    block: AbstractBlock,
    *,
    restitution: Scalar = "momentum",
    highest: Scalar | None = None,
    resolution: Scalar = RESOLUTION,
    stop: StopFlag | None = None,
) -> float:
    """Lowest scale of a record at which it overturns a block [-]; nan if there is none.

    The first of `thresholds_of`, in less time; the arguments are those of `rocking.Block.thresholds`.
    """
    given = None if highest is None else number("highest", highest, 0.0, HIGHEST_SCALE, closed="right")
    share = checked_resolution(resolution)
    uplift, top, _ = search_range(record, block, given)
    lines = block_lines(record, block, restitution_of(block, restitution), stop=stop)
    limit = min(highest_vertical_scale(record, block.gravity), HIGHEST_SCALE)
    return float(lowest_overturning(lines, np.array([uplift]), top, limit, resolution=share)[0])


def block_lines(
    record: Record,
    block: AbstractBlock,
    eta: float,
    *,
    scales_size: bool = False,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> Lines:
    """A block under a record, as one line of scales of the record; or of factors of its p, if these are scaled."""

    def cells(_line: NDArray[np.intp], scale: Array) -> NDArray[np.void]:
        groups = record_groups(record, block, np.ones(scale.size) if scales_size else scale, eta)
        if scales_size:
            groups["frequency_parameter"] = block.frequency_parameter * scale
        return record_cells(record, **groups)

    return Lines(motion_samples(record), cells, threads=threads, stop=stop)
