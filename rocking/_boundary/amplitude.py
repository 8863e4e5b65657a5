"""Amplitudes at which the outcome for a block changes, the frequency of its pulse being fixed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking._base.constants import STANDARD_GRAVITY
from rocking._base.equality import EqualByValue
from rocking._base.errors import needed, number, reject_given
from rocking._base.quantities import FREQUENCY_RATIO, RESTITUTION, RESTRAINTS
from rocking._base.units import Scalar
from rocking._boundary.scan import RESOLUTION as SCAN_RESOLUTION
from rocking._boundary.scan import Index, Lines, checked_resolution, outcome_changes
from rocking._boundary.search import UNCOUNTED, Floats, Solve, block_solver, classifier, counted_code, outcomes_along
from rocking._excitation.pulses import Motion, as_motion
from rocking._excitation.records.record import Record
from rocking._excitation.records.vertical import (
    HIGHEST_VERTICAL_SCALE,
    check_one_vertical_scale,
    highest_vertical_scale,
)
from rocking._model.checks import check_one_alpha, check_restraint, known_restitution
from rocking._model.fields import IMPACTS, OUTCOME
from rocking._model.labelled import variable
from rocking._model.outcome import SURVIVES, decode_outcomes
from rocking._model.response import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.records.record_response import record_cells, record_response
from rocking._solver.records.samples import motion_samples

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


@dataclass(frozen=True, eq=False, repr=False)
class Thresholds(EqualByValue):
    """Amplitudes at which the outcome for a block changes, ascending; all arrays (thresholds,).

    Attributes
    ----------
    amplitude : float array [-]
        a = a_g/(g tan alpha).
    overturns_above : bool array
        True where the block overturns just above the threshold and survives just below it.
    outcome : int8 array
        Code of `Outcome` on the overturning side.
    impacts : int32 array
        Impacts before overturning there.
    """

    amplitude: Floats
    overturns_above: NDArray[np.bool_]
    outcome: NDArray[np.int8]
    impacts: NDArray[np.int32]

    def __repr__(self) -> str:
        """Return the changes of outcome in words."""
        changes = []
        for amplitude, above in zip(self.amplitude.tolist(), self.overturns_above.tolist(), strict=True):
            changes.append(f"{'overturns' if above else 'survives'} above a = {amplitude:.6g}")
        return f"<rocking.Thresholds: {', '.join(changes) or 'no amplitude was found that overturns the block'}>"

    def to_pandas(self) -> pd.DataFrame:
        """Return a row for each threshold, with the name of the outcome."""
        import pandas as pd  # noqa: PLC0415  # takes longer to load than the solver

        names = [Outcome(code).name for code in self.outcome.tolist()]
        return pd.DataFrame(vars(self) | {"outcome": names})

    def to_xarray(self) -> xr.Dataset:
        """Return the thresholds over the dimension `threshold`."""
        import xarray as xr  # noqa: PLC0415

        above = "whether the block overturns just above it"
        return xr.Dataset(
            {
                "amplitude": variable("threshold", self.amplitude, "1", "amplitude a = a_g/(g tan alpha)"),
                "overturns_above": variable("threshold", self.overturns_above, "1", above),
                "outcome": OUTCOME.variable("threshold", self.outcome),
                "impacts": IMPACTS.variable("threshold", self.impacts),
            }
        )


def thresholds(
    motion: Motion,
    *,
    frequency_ratio: Scalar | None = None,
    frequency_parameter: Scalar | None = None,
    restitution: Scalar,
    alpha: Scalar | None = None,
    stiffness: Scalar = 0.0,
    prestress: Scalar = 0.0,
    damping: Scalar = 0.0,
    vertical_scale: Scalar | None = None,
    highest: Scalar | None = None,
    resolution: Scalar = SCAN_RESOLUTION,
    stop: StopFlag | None = None,
) -> Thresholds:
    """Search every amplitude between uplift and `highest` at which the outcome changes.

    Parameters
    ----------
    motion, frequency_ratio, frequency_parameter, restitution, alpha, stiffness, prestress, damping
        As for `peak_response`; scalars.
    vertical_scale : float, optional
        Factor of the vertical component of a record at the amplitude 1 [-], [0, 1e6]; 1 by default. Both components are
        scaled, and the search ends where the vertical acceleration reaches -g.
    highest : float, optional
        Largest a = a_g/(g tan alpha) considered [-], (1, 1e6]; by default 100 under a pulse and 10 under a record.
    resolution : float
        Under a record: largest relative distance of the amplitudes tried up to the lowest that overturns [-],
        [1e-4, 0.1].
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Returns
    -------
    Thresholds
        Under a pulse each is good to `RESOLUTION` in 1/a, or to `ELASTIC_RESOLUTION` where an elastic block overturns
        after more than `MOST_COUNTED` impacts. A region of one way of overturning narrower than 1/2000 of the range and
        surrounded by a single other outcome can be missed; a surviving band between two ways of overturning, of which
        all with more than `MOST_COUNTED` impacts are one, is not, unless it is narrower than `RESOLUTION`. Under a
        record the lowest is that of `rocking._boundary.scan.lowest_overturning`; above it amplitudes that differ by 0.2
        % are tried. Changes are bisected to 1e-6.

    Examples
    --------
    >>> thresholds("sine", frequency_ratio=3.0, restitution=0.9)
    <rocking.Thresholds: overturns above a = 1.40357, survives above a = 3.48466, overturns above a = 3.63115>
    """
    motion = as_motion(motion)
    if highest is None:
        highest = motion.highest_amplitude
    top = number("highest", highest, 1.0, 1e6, closed="right")
    eta = RESTITUTION.number(known_restitution(restitution, alpha))
    restraint = one_restraint(stiffness, prestress, damping)
    if isinstance(motion, Record):
        reject_given("a record", frequency_ratio=frequency_ratio)
        parameter = needed("a record", frequency_parameter=frequency_parameter)
        p = number("frequency_parameter", parameter, *motion.frequency_parameters, unit="rad/s")
        groups = {"frequency_parameter": p, "restitution": eta, "alpha": check_one_alpha(alpha), "restraint": restraint}
        return _record_changes(motion, groups, vertical_scale, top, checked_resolution(resolution), stop)
    reject_given("a pulse", frequency_parameter=frequency_parameter, vertical_scale=vertical_scale)
    omega = FREQUENCY_RATIO.number(needed("a pulse", frequency_ratio=frequency_ratio))
    level = 1.0 + float(restraint.get("prestress", 0.0))
    if top <= level:  # no uplift
        return Thresholds(np.empty(0), np.empty(0, np.bool_), np.empty(0, np.int8), np.empty(0, np.int32))
    solver = block_solver(motion, stop=stop, restraint=restraint)
    changes = amplitude_changes(solver, omega, eta, top / level, check_one_alpha(alpha))
    return replace(changes, amplitude=changes.amplitude * level)


def _record_changes(
    record: Record,
    groups: dict[str, Any],
    vertical_scale: Scalar | None,
    highest: float,
    resolution: float,
    stop: StopFlag | None,
) -> Thresholds:
    """Search `thresholds` under a record."""
    factor = check_one_vertical_scale(record, vertical_scale) if vertical_scale is not None else 1.0
    level = 1.0 + float(groups["restraint"].get("prestress", 0.0))
    lowest, limit = level, math.inf
    if record.vertical is not None and factor > 0.0:
        limit = min(highest_vertical_scale(record), HIGHEST_VERTICAL_SCALE) / factor
        # uplift is where a abs(f) reaches 1 + a w: at a sample, since both are linear between samples
        upwards = factor * record.vertical / STANDARD_GRAVITY
        excess = np.abs(record.acceleration) / record.peak_acceleration - upwards
        lowest = float(level / excess.max())

    def cells(_line: Index, amplitudes: Floats) -> NDArray[np.void]:
        return record_cells(record, slenderness=1.0 / amplitudes, vertical_scale=factor * amplitudes, **groups)

    lines = Lines(motion_samples(record), cells, stop=stop)
    amplitude, above = outcome_changes(lines, lowest, max(highest, lowest), limit, resolution=resolution)
    vertical = None if record.vertical is None else factor * amplitude
    response = record_response(record, slenderness=1.0 / amplitude, vertical_scale=vertical, **groups, stop=stop)
    return Thresholds(amplitude, above, response.outcome, response.impacts)


def one_restraint(stiffness: Scalar, prestress: Scalar, damping: Scalar) -> dict[str, Floats]:
    """Check a restraint given by numbers, as `check_restraint`."""
    values = zip(RESTRAINTS, (stiffness, prestress, damping), strict=True)
    return check_restraint(*[quantity.number(value) for quantity, value in values])


def amplitude_changes(solve: Solve, omega: float, eta: float, highest: float, alpha: float = 0.0) -> Thresholds:
    """Search `thresholds` under a pulse by any solver, whose amplitude is 1 at uplift."""
    lowest, log_omega = 1.0 / highest, float(np.log(omega))
    nodes = np.union1d(np.linspace(lowest, 1.0, 2001), np.geomspace(lowest, 1.0, 2001))
    grid, codes = outcomes_along(0, (lowest, log_omega, eta, alpha), nodes, classifier(solve, counted_code))
    overturns = codes != SURVIVES
    edge = np.flatnonzero(overturns[1:] != overturns[:-1])[::-1]
    above = overturns[edge]  # 1/a falls as the amplitude rises
    overturned = np.where(above, edge, edge + 1)
    threshold, code = grid[overturned], codes[overturned]
    many = code == UNCOUNTED
    if many.any():
        code[many], _ = classifier(solve)(threshold[many], *np.array([log_omega, eta, alpha]))
    return Thresholds(1.0 / threshold, above, *decode_outcomes(code))
