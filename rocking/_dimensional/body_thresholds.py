"""Peak accelerations and factors of a record at which the outcome for a body with two edges changes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.equality import EqualByValue
from rocking._boundary.amplitude import amplitude_changes
from rocking._boundary.scan import outcome_changes, scanned
from rocking._dimensional.body_problem import BodyProblem
from rocking._dimensional.record_groups import HIGHEST_SCALE
from rocking._dimensional.threshold import Threshold, threshold_text
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import highest_vertical_scale
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import Record as KernelRecord

Array = NDArray[np.float64]

HIGHEST = 100.0, 10.0
"""Largest strength searched over that of uplift [-]: of pulses, as for blocks, and of records."""


@dataclass(frozen=True, eq=False)
class BodyThresholds(EqualByValue):
    """Strengths of a ground motion at which the outcome changes, for each body.

    Attributes
    ----------
    value : float array (..., thresholds)
        Peak acceleration of a pulse [m/s2], or factor of a record [-], ascending; nan beyond the last of a body.
    overturns_above : bool array (..., thresholds)
        True where the body overturns just above and survives just below.
    searched : float array (..., 2)
        Lowest and highest strength searched, from uplift on.
    given : (float, str, str)
        Strength of the problem, its name and its unit; of the first body.
    """

    value: Array
    overturns_above: NDArray[np.bool_]
    searched: Array
    given: tuple[float, str, str]

    @property
    def lowest(self) -> Array:
        """Lowest strength at which each body overturns; nan where none was found. Array (...)."""
        if not self.value.shape[-1]:
            return np.full(self.value.shape[:-1], math.nan)
        return self.value[..., 0]

    @cached_property
    def changes(self) -> tuple[Threshold, ...]:
        """Those of the first body, one for each."""
        first = self.value.reshape(-1, self.value.shape[-1])[0]
        above = self.overturns_above.reshape(-1, self.value.shape[-1])[0]
        return tuple(Threshold(float(v), bool(a)) for v, a in zip(first, above, strict=True) if not math.isnan(v))

    @property
    def sentence(self) -> str:
        """From which strength the first body overturns, in words."""
        _, name, unit = self.given
        top = threshold_text(float(self.searched.reshape(-1, 2)[0, 1]))
        if not self.changes:
            return f"no {name} up to {top}{unit} was found to overturn it"
        first, *others = self.changes
        more = f"; above that the outcome changes {len(others)} more times up to {top}{unit}" if others else ""
        return f"it overturns from a {name} of {first.text()}{unit}{more}"

    def __repr__(self) -> str:
        """The lowest thresholds in words."""
        if self.value.ndim == 1:
            return f"<rocking.BodyThresholds: {self.sentence}>"
        shape = " x ".join(map(str, self.value.shape[:-1]))
        found = self.lowest[~np.isnan(self.lowest)]
        ends = f", lowest from {found.min():.4g} to {found.max():.4g}{self.given[2]}" if found.size else ""
        return f"<rocking.BodyThresholds of {shape} bodies: {found.size} overturn{ends}>"


def thresholds_of(problem: BodyProblem, highest: float | None = None, stop: StopFlag | None = None) -> BodyThresholds:
    """Every strength at which the outcome changes, for each body of a problem, whose own strength is not read.

    Under a pulse as `rocking.thresholds`; under a record as `rocking._dimensional.record_scales`: scales that
    differ by 0.2 % are solved, and changes between them are bisected. A narrower range of one outcome can be missed.

    Parameters
    ----------
    problem : BodyProblem
        The bodies and the motion.
    highest : float, optional
        Highest strength searched, in its unit; by default 100 times that of uplift under a pulse, 10 under a record.
    stop : StopFlag, optional
        Cancels the work.

    Raises
    ------
    StoppedError
        If `stop` was set.
    """
    motion, shape = problem.motion, problem.shape
    by_record = isinstance(motion, Record)
    unit = motion.peak_acceleration if isinstance(motion, Record) else 1.0
    strength = float(problem.acceleration.ravel()[0] / unit) if problem.acceleration.size else math.nan
    problem = replace(problem, acceleration=np.full(shape, unit))  # of the strength 1
    uplift = np.broadcast_to(problem.body.uplift_acceleration, shape).ravel() / unit
    if isinstance(motion, Record) and motion.vertical is not None:
        uplift = np.array([uplift_scale(motion, motion.vertical, cell) for cell in problem.cells])
    top = uplift * HIGHEST[by_record] if highest is None else np.full(uplift.size, highest)
    if isinstance(motion, Record):
        gravity = np.broadcast_to(problem.body.gravity, shape).ravel() / STANDARD_GRAVITY
        top = np.minimum(top, highest_vertical_scale(motion) * gravity)
    found = [
        _record_changes(problem, k, uplift[k], top[k], stop)
        if by_record
        else _pulse_changes(problem, k, uplift[k], top[k], stop)
        for k in range(uplift.size)
    ]
    most = max((values.size for values, _ in found), default=0)
    value, above = np.full((uplift.size, most), math.nan), np.zeros((uplift.size, most), dtype=np.bool_)
    for k, (values, up) in enumerate(found):
        value[k, : values.size], above[k, : values.size] = values, up
    given = (strength, "factor of the record", "") if by_record else (strength, "peak acceleration", " m/s2")
    searched = np.stack([uplift, np.maximum(uplift, top)], axis=-1)
    return BodyThresholds(value.reshape(*shape, most), above.reshape(*shape, most), searched.reshape(*shape, 2), given)


def uplift_scale(record: Record, vertical: Array, cell: KernelRecord) -> float:
    """Smallest factor at which a body uplifts under a record with a vertical component [m/s2]; `cell` at factor 1 [-].

    Uplift of an edge is where the horizontal acceleration over g tan(alpha_s) of the other reaches 1 + w/g
    (`rocking._model.body`): at a sample, since all of them are linear between samples.
    """
    resisted = cell["slenderness"] * record.peak_acceleration  # g tan(alpha_s)
    horizontal = np.maximum(record.acceleration / resisted[1], -record.acceleration / resisted[0])
    excess = float((horizontal - cell["vertical"] * vertical / STANDARD_GRAVITY).max())
    return 1.0 / max(excess, 1.0 / HIGHEST_SCALE)


def _pulse_changes(
    problem: BodyProblem, k: int, uplift: float, highest: float, stop: StopFlag | None
) -> tuple[Array, NDArray[np.bool_]]:
    if highest <= uplift:
        return np.empty(0), np.empty(0, dtype=np.bool_)
    cell = problem.cells[k]
    found = amplitude_changes(
        problem.solver(k, stop), float(cell["rate"]), float(cell["eta"][0]), min(highest / uplift, 1e6)
    )
    return found.amplitude * uplift, found.overturns_above


def _record_changes(
    problem: BodyProblem, k: int, uplift: float, highest: float, stop: StopFlag | None
) -> tuple[Array, NDArray[np.bool_]]:
    if highest <= uplift:
        return np.empty(0), np.empty(0, dtype=np.bool_)
    solve, cell = problem.solver(k, stop), problem.cells[k]
    rate, slenderness = float(cell["rate"]), float(cell["slenderness"].min())

    def overturns(scales: Array) -> NDArray[np.bool_]:
        records, _ = solve(slenderness / scales, np.full(scales.size, rate), np.zeros(scales.size))
        return np.asarray(records["outcome"] >= Outcome.OVERTURNED_DIRECTLY)

    return outcome_changes(overturns, scanned(uplift, highest))
