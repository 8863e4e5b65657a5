"""Responses with an error bound, and the error bound of the solver."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.arrays import Array, Flags
from rocking._base.equality import EqualByValue
from rocking._base.errors import integer
from rocking._base.quantities import FREQUENCY_RATIO, SLENDERNESS
from rocking._excitation.pulses import AbstractPulse, as_pulse
from rocking._model.checks import check_groups
from rocking._model.fields import (
    BOUNDED_FIELDS,
    DERIVED_FIELDS,
    OVERTURNED,
    SOLVED_FIELDS,
    ResponseField,
    ResponseFields,
)
from rocking._model.outcome import Outcome
from rocking._numba.cancellation import StopFlag
from rocking._solver.bodies import SOLVER_ERROR, error_bound
from rocking._solver.peak_response import solve_cells
from rocking._solver.state import FULL_PRECISION

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


@dataclass(frozen=True, eq=False, repr=False)
class BoundedResponse(ResponseFields, EqualByValue, declared=BOUNDED_FIELDS):
    """Responses with an error bound and a source. Every field is an array of the broadcast shape of the arguments.

    `outcome` holds codes of `rocking.Outcome`; `impacts` is -1 where a cube was interpolated that leaves the number
    open; the other fields are certain, the peak within its bound.

    Attributes
    ----------
    {fields}
    derived : mapping of str to float64 array
        The derived fields, such as `residual_energy`, which are attributes too; nan where it is interpolated.
    """

    exceeded_alpha: Flags
    error_bound: Array
    from_cube: Flags
    derived: Mapping[str, Array]

    @property
    def source(self) -> NDArray[np.str_]:
        """Names of the sources: "cube" (interpolated data set) or "solver"."""
        return np.where(self.from_cube, "cube", "solver")

    def __repr__(self) -> str:
        """What happened, in words, with the error bound and the source."""
        if self.outcome.ndim:
            shape = " x ".join(str(size) for size in self.outcome.shape)
            parts = (
                f"{np.count_nonzero(~self.overturned)} survive",
                f"{np.count_nonzero(self.overturned)} overturn",
                f"{np.count_nonzero(self.from_cube)} from a cube",
            )
            return f"<rocking.BoundedResponse of {shape} blocks: {', '.join(parts)}>"
        outcome = Outcome(int(self.outcome))
        survives = outcome == Outcome.RECOVERS
        peak = (
            f": peak rotation {float(self.peak_rotation):.6g} alpha within {float(self.error_bound):.2g}"
            if survives
            else ""
        )
        return f"<rocking.BoundedResponse: {outcome.sentence}{peak}, from the {self.source.item()}>"

    def to_xarray(self) -> xr.Dataset:
        """The fields as a data set over dim_0, dim_1, ..., with units, meanings and equation numbers."""
        import xarray as xr  # noqa: PLC0415  (takes longer to load than the solver)

        names, fields = [f"dim_{axis}" for axis in range(self.outcome.ndim)], (*BOUNDED_FIELDS, OVERTURNED)
        found: dict[str, Any] = {one.name: one.variable(names, getattr(self, one.name)) for one in fields}
        return xr.Dataset(found | {one.name: one.variable(names, self.derived[one.name]) for one in DERIVED_FIELDS})

    def to_pandas(self) -> pd.DataFrame:
        """The fields as columns, one row for each block."""
        labelled = self.to_xarray()
        return (labelled if labelled.dims else labelled.expand_dims("block")).to_dataframe()

    def reshape(self, shape: tuple[int, ...]) -> BoundedResponse:
        """The same responses in another shape."""
        return self if shape == self.outcome.shape else self._each(lambda values: values.reshape(shape))

    def __getitem__(self, index: Flags | NDArray[np.intp] | slice) -> BoundedResponse:
        """The responses of a part of the points."""
        return self._each(lambda values: values[index])

    def _each(self, change: Callable[[NDArray[Any]], NDArray[Any]]) -> BoundedResponse:
        fields: dict[str, Any] = {field.name: change(getattr(self, field.name)) for field in BOUNDED_FIELDS}
        return BoundedResponse(**fields, derived={name: change(values) for name, values in self.derived.items()})

    def _derived(self, field: ResponseField) -> Array:
        return self.derived[field.name]

    def put(self, where: Flags | NDArray[np.intp], part: BoundedResponse) -> None:
        """Set the responses of a part of the points."""
        for field in BOUNDED_FIELDS:
            getattr(self, field.name)[where] = getattr(part, field.name)
        for name, values in self.derived.items():
            values[where] = part.derived[name]


def solve_with_bound(
    pulse: str | AbstractPulse,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
    alpha: ArrayLike | None,
    threads: int | None = None,
    stop: StopFlag | None = None,
    body: Any = None,
) -> BoundedResponse:
    """Solve twice, with the groups as given and slightly smaller, and bound the error of the peak by the difference.

    See `rocking._solver.bodies.error_bound`.

    Arguments and errors are those of `rocking.peak_response` under a pulse; `body` as of `rocking.Response`.
    """
    given = check_groups(slenderness=slenderness, frequency_ratio=frequency_ratio, restitution=restitution, alpha=alpha)
    s, w, eta, angle = np.broadcast_arrays(*given.values())
    if threads is not None:
        threads = integer("threads", threads, 1, math.inf)
    return solve_checked(as_pulse(pulse), s, w, eta, angle, body, threads, stop)


def solve_checked(
    pulse: AbstractPulse,
    s: Array | float,
    w: Array | float,
    eta: Array | float,
    alpha: Array | float,
    body: Any = None,
    threads: int | None = None,
    stop: StopFlag | None = None,
) -> BoundedResponse:
    """The same for groups that have been checked, arrays of one shape or numbers."""
    shape = np.shape(s)
    shift = (1.0 - SOLVER_ERROR * np.arange(2)).reshape(2, *[1] * len(shape))  # downwards: eta = 1 stays in [0, 1]
    groups = np.empty((4, 2, *shape))
    groups[0] = np.maximum(s * shift, SLENDERNESS.lower)
    groups[1] = np.maximum(w * shift, FREQUENCY_RATIO.lower)
    groups[2] = eta * shift
    groups[3] = alpha
    cells = [np.array(one.ravel()) for one in groups[: 4 if groups[3].any() else 3]]  # each of its own memory
    records = solve_cells(pulse, cells, FULL_PRECISION, threads, stop).reshape(2, *shape)
    first, bound = records[0], error_bound(*records)
    known = {
        "slenderness": groups[0, 0],
        "frequency_ratio": groups[1, 0],
        "restitution": groups[2, 0],
        "alpha": groups[3, 0],
    }
    fields = {field.name: np.array(first[field.name]) for field in SOLVED_FIELDS}
    derived = {
        one.name: np.asarray(one.derive(fields, known, pulse, body), one.dtype) for one in DERIVED_FIELDS if one.derive
    }
    kept = fields["peak_rotation"], fields["outcome"], fields["impacts"], fields["exceeded_alpha"]
    return BoundedResponse(*kept, bound, np.zeros(shape, np.bool_), derived)
