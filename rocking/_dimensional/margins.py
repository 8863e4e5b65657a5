"""Distance of a block from another outcome, in amplitude, period and size, by the rigid equation (2.2)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rocking._base.quantities import FREQUENCY_RATIO
from rocking._boundary.frequency import critical_frequency_ratio
from rocking._dimensional.problem import Problem
from rocking._dimensional.threshold import Threshold
from rocking._numba.cancellation import StopFlag

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

SEARCH_FACTOR = 10.0
"""Ratio of the largest period searched to that of the pulse, and its inverse [-]; sizes go with its square."""


UNITS = {
    "nearest_acceleration": "m s-2",
    "acceleration_factor": "1",
    "nearest_period": "s",
    "period_factor": "1",
    "smallest_surviving_half_diagonal": "m",
    "surviving_from_half_diagonal": "m",
}
"""Numbers of `Margins`, and their units as CF writes them."""


@dataclass(frozen=True, repr=False)
class Margins:
    """Distances of a block from another outcome."""

    # peak acceleration nearest in its logarithm at which the outcome changes [m/s2]; None if none was found
    nearest_acceleration: float | None
    acceleration_factor: float | None  # nearest_acceleration over the peak acceleration of the problem [-]
    nearest_period: float | None  # the same for the period [s]
    period_factor: float | None  # the same for the period [-]
    periods: tuple[Threshold, ...]  # all periods at which the outcome changes, ascending [s]
    periods_searched: tuple[float, float]  # smallest and largest [s]
    # smallest R of this shape searched that survives this pulse [m]; a larger one may overturn
    smallest_surviving_half_diagonal: float | None
    # R from which every larger size searched survives [m]; None if the largest overturns
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
            name: ((), math.nan if (value := getattr(self, name)) is None else value, {"units": unit})
            for name, unit in UNITS.items()
        }
        for name, unit in (("periods", "s"), ("sizes", "m")):
            changes = getattr(self, name)
            variables[name] = (f"{name}_change", [one.value for one in changes], {"units": unit})
            variables[f"{name}_overturn_above"] = (f"{name}_change", [one.overturns_above for one in changes])
        return xr.Dataset(variables)

    def to_pandas(self) -> pd.Series:
        """The numbers as a series; units are those of `to_xarray`."""
        import pandas as pd  # noqa: PLC0415  # takes longer to load than the solver

        return pd.Series({name: getattr(self, name) for name in UNITS}, dtype=float)


def margins_of(
    problem: Problem,
    accelerations: Iterable[Threshold],
    stop: StopFlag | None = None,
    served: tuple[float, float] = (FREQUENCY_RATIO.lower, FREQUENCY_RATIO.upper),
) -> Margins:
    """Nearest changes of outcome of a block under a pulse, from those of `block_thresholds`.

    `served`: frequency ratios beyond which periods are not searched [-].
    """
    groups, block = problem.groups, problem.block
    omega = groups["frequency_ratio"]
    low, high = max(omega / SEARCH_FACTOR, served[0]), min(omega * SEARCH_FACTOR, served[1])
    found = critical_frequency_ratio(
        problem.pulse,
        slenderness=groups["slenderness"],
        restitution=groups["restitution"],
        alpha=groups["alpha"],
        window=(low, high),
        stop=stop,
    )
    changes = list(zip(found.frequency_ratio.tolist(), found.overturns_above.tolist(), strict=True))

    def period(ratio: float) -> float:
        return float(problem.period * omega / ratio)  # omega_g = 2 pi/T_p: longer is lower

    def size(ratio: float) -> float:
        return float(block.half_diagonal * (ratio / omega) ** 2)  # p = sqrt(3 g/(4 R)): larger is higher (2.2)

    periods = tuple([Threshold(period(w), not above) for w, above in reversed(changes)])
    sizes = tuple([Threshold(size(w), above) for w, above in changes])
    smallest, largest = size(low), size(high)
    overturns_small, overturns_large = found.overturns_at_ends
    nearest_acceleration = _nearest(problem.peak_acceleration, accelerations)
    nearest_period = _nearest(problem.period, periods)
    return Margins(
        nearest_acceleration=nearest_acceleration,
        acceleration_factor=_factor(nearest_acceleration, problem.peak_acceleration),
        nearest_period=nearest_period,
        period_factor=_factor(nearest_period, problem.period),
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
