"""Distance of a block from another outcome, in amplitude, period and size, by the rigid equation (2.2)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rocking._base.quantities import FREQUENCY_RATIO
from rocking._boundary.frequency import critical_frequency_ratio
from rocking._dimensional.problem import Problem
from rocking._dimensional.thresholds import Threshold
from rocking._model.fields import ResponseField
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

SEARCH_FACTOR = 10.0
"""Ratio of the largest period searched to that of the pulse, and its inverse [-]; sizes go with its square."""


MARGINS = (
    ResponseField("nearest_acceleration", "f8", "m s-2", "2.2", "nearest peak acceleration, by ratio, at which the "
                  "outcome changes", "none was found"),
    ResponseField("acceleration_factor", "f8", "1", "2.2", "that over the peak acceleration", "none was found"),
    ResponseField("nearest_period", "f8", "s", "2.2", "nearest period, by ratio, at which the outcome changes",
                  "none was found"),
    ResponseField("period_factor", "f8", "1", "2.2", "that over the period", "none was found"),
    ResponseField("smallest_surviving_half_diagonal", "f8", "m", "2.2", "smallest R of this shape searched that "
                  "survives; a larger one may overturn", "none does"),
    ResponseField("surviving_from_half_diagonal", "f8", "m", "2.2", "R from which every larger size searched survives",
                  "the largest overturns"),
)  # fmt: skip
"""Numbers of `Margins`."""


@dataclass(frozen=True, repr=False)
class Margins:
    """Distances of a block from another outcome; the numbers are those of `MARGINS`, None where there is none."""

    nearest_acceleration: float | None
    acceleration_factor: float | None
    nearest_period: float | None
    period_factor: float | None
    periods: tuple[Threshold, ...]  # all periods at which the outcome changes, ascending [s]
    periods_searched: tuple[float, float]  # smallest and largest [s]
    smallest_surviving_half_diagonal: float | None
    surviving_from_half_diagonal: float | None
    sizes: tuple[Threshold, ...]  # all half-diagonals of this shape at which the outcome changes, ascending [m]
    sizes_searched: tuple[float, float]  # smallest and largest half-diagonal [m]

    def __repr__(self) -> str:
        """The nearest changes in words."""
        found = (
            ("acceleration", self.nearest_acceleration, "m/s2"),
            ("period", self.nearest_period, "s"),
            ("half-diagonal from which it survives", self.surviving_from_half_diagonal, "m"),
        )
        texts = [f"{name} {'not found' if one is None else f'{one:.4g} {unit}'}" for name, one, unit in found]
        return f"<rocking.Margins: {', '.join(texts)}>"

    def to_xarray(self) -> xr.Dataset:
        """The margins as a data set, with units; missing ones are nan."""
        import xarray as xr  # noqa: PLC0415  # takes longer to load than the solver

        variables: dict[str, Any] = {
            one.name: one.variable((), math.nan if (value := getattr(self, one.name)) is None else value)
            for one in MARGINS
        }
        for name, unit in (("periods", "s"), ("sizes", "m")):
            changes = getattr(self, name)
            variables[name] = (f"{name}_change", [one.value for one in changes], {"units": unit})
            variables[f"{name}_overturn_above"] = (f"{name}_change", [one.overturns_above for one in changes])
        return xr.Dataset(variables)

    def to_pandas(self) -> pd.Series:
        """The numbers as a series; units are those of `to_xarray`."""
        import pandas as pd  # noqa: PLC0415  # takes longer to load than the solver

        return pd.Series({one.name: getattr(self, one.name) for one in MARGINS}, dtype=float)


def margins_of(
    problem: Problem,
    accelerations: Iterable[Threshold],
    stop: StopFlag | None = None,
    served: tuple[float, float] = (FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper),
) -> Margins:
    """Nearest changes of outcome of a block under a pulse, from those of `thresholds_of`.

    `served`: frequency ratios beyond which periods are not searched [-].
    """
    groups, block, pulse_period = dict(problem.groups), problem.block, float(problem.period)
    omega = groups.pop("frequency_ratio")
    low, high = max(omega / SEARCH_FACTOR, served[0]), min(omega * SEARCH_FACTOR, served[1])
    found = critical_frequency_ratio(problem.pulse, **groups, window=(low, high), stop=stop)
    changes = list(zip(found.frequency_ratio.tolist(), found.overturns_above.tolist(), strict=True))

    def period(ratio: float) -> float:
        return float(pulse_period * omega / ratio)  # omega_g = 2 pi/T_p: longer is lower

    def size(ratio: float) -> float:
        return float(block.half_diagonal * (ratio / omega) ** 2)  # p = sqrt(3 g/(4 R)): larger is higher (2.2)

    periods = tuple([Threshold(period(w), not above) for w, above in reversed(changes)])
    sizes = tuple([Threshold(size(w), above) for w, above in changes])
    smallest, largest = size(low), size(high)
    overturns_small, overturns_large = found.overturns_at_ends
    peak = float(problem.peak_acceleration)
    nearest_acceleration = _nearest(peak, accelerations)
    nearest_period = _nearest(pulse_period, periods)
    return Margins(
        nearest_acceleration=nearest_acceleration,
        acceleration_factor=_factor(nearest_acceleration, peak),
        nearest_period=nearest_period,
        period_factor=_factor(nearest_period, pulse_period),
        periods=periods,
        periods_searched=(period(high), period(low)),
        smallest_surviving_half_diagonal=(
            smallest if not overturns_small else next((one.value for one in sizes if not one.overturns_above), None)
        ),
        surviving_from_half_diagonal=None if overturns_large else sizes[-1].value if sizes else smallest,
        sizes=sizes,
        sizes_searched=(smallest, largest),
    )


def _nearest(value: float, candidates: Iterable[Threshold]) -> float | None:
    return min([one.value for one in candidates], key=lambda candidate: abs(math.log(candidate / value)), default=None)


def _factor(value: float | None, of: float) -> float | None:
    return None if value is None else value / of
