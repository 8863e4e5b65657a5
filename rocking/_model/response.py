"""The response of one block or of an array of blocks to a pulse."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking._base.equality import EqualByValue
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantities import FREQUENCY_PARAMETER, GROUPS, RESTRAINTS
from rocking._base.units import WithUnit
from rocking._model.fields import OVERTURNED, RESPONSE_FIELDS, SOLVED_FIELDS, ResponseField, ResponseFields
from rocking._model.labelled import Index, variable, with_index
from rocking._model.outcome import Outcome

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Outcome", "Response", "dimensions_of"]


@dataclass(frozen=True, eq=False, repr=False)
class Response(ResponseFields, EqualByValue, declared=RESPONSE_FIELDS):
    """Responses of blocks to a pulse. Every field is an array of the broadcast shape of the arguments.

    `outcome` holds codes of `Outcome`. Within one `peak_mode` the peak is a smooth function of the groups.

    Attributes
    ----------
    {fields}
    pulse : str
        Name of the pulse; empty if not known.
    groups : mapping of str to array
        The arguments slenderness, frequency_ratio [-], restitution [-] and alpha [rad] before broadcasting, for the
        coordinates of `to_xarray`; empty if not known.
    dims : tuple
        Names of the dimensions if an argument was labelled (xarray).
    index : (name, labels) or None
        Index of the last axis if an argument was a series (pandas).
    motion : AbstractPulse or Record
        The ground motion, for fields that are derived from it; None if not known.
    body : AbstractBody
        The bodies in SI units, likewise.
    """

    chatter: NDArray[np.bool_]
    exceeded_alpha: NDArray[np.bool_]
    uplift_time: NDArray[np.float64]
    first_impact_time: NDArray[np.float64]
    first_impact_velocity: NDArray[np.float64]
    peak_mode: NDArray[np.int32]
    end_rotation: NDArray[np.float64]
    end_velocity: NDArray[np.float64]
    pulse: str = ""
    groups: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    dims: tuple[Hashable, ...] = ()
    index: Index | None = field(default=None, compare=False)
    motion: Any = field(default=None, compare=False)
    body: Any = field(default=None, compare=False)

    @property
    def shape(self) -> tuple[int, ...]:
        """The broadcast shape of the arguments."""
        return self.peak_rotation.shape

    def _derived(self, field: ResponseField) -> NDArray[Any]:
        if field.derive is None:
            raise AttributeError(field.name)
        fields = {one.name: vars(self)[one.name] for one in SOLVED_FIELDS}
        return np.asarray(field.derive(fields, self.groups, self.motion, self.body), field.dtype)

    def __repr__(self) -> str:
        """What happened, in words."""
        under = f" under {self.pulse}" if self.pulse else ""
        if self.peak_rotation.ndim == 0:
            outcome = Outcome(int(self.outcome))
            rocked = outcome == Outcome.RECOVERS
            count = int(self.impacts)
            impacts = f", {count} impact{'' if count == 1 else 's'}" if outcome != Outcome.NO_UPLIFT else ""
            peak = f": peak rotation {float(self.peak_rotation):.6g} alpha" if rocked else ""
            return f"<rocking.Response{under}: {outcome.sentence}{peak}{impacts}>"
        counts = np.bincount(self.outcome.ravel(), minlength=len(Outcome))
        parts = [f"{count} {outcome.plural}" for outcome, count in zip(Outcome, counts.tolist(), strict=True) if count]
        peaks = self.peak_rotation[~np.isnan(self.peak_rotation)]
        largest = [f"largest peak rotation {float(peaks.max()):.6g} alpha"] if peaks.size else []
        shape = " x ".join(str(size) for size in self.shape)
        return f"<rocking.Response{under} of {shape} blocks: {', '.join([*parts, *largest])}>"

    def to_xarray(self, dims: tuple[Hashable, ...] | None = None) -> xr.Dataset:
        """The response as a labelled data set, with units, meanings and equation numbers as attributes.

        Parameters
        ----------
        dims : tuple of names, optional
            One for each axis. By default those of the labelled arguments, else the name of the argument that alone
            varies along the axis (slenderness, frequency_ratio, restitution, alpha), else dim_0, dim_1, ...

        Returns
        -------
        xarray.Dataset
            The fields and `overturned`; the arguments are coordinates.
        """
        import xarray as xr  # takes longer to load than the solver, and most responses remain arrays

        names = axis_names(len(self.shape), self.groups, self.dims) if dims is None else tuple(dims)
        if len(names) != len(self.shape):
            raise InvalidArgumentError("dims", dims, f"{len(self.shape)} names")
        variables: dict[str, Any] = {
            one.name: one.variable(names, getattr(self, one.name)) for one in (*RESPONSE_FIELDS, OVERTURNED)
        }
        coordinates: dict[str, Any] = {}
        for group in (*GROUPS, FREQUENCY_PARAMETER, *RESTRAINTS):
            value = self.groups.get(group.name)
            if value is not None:
                unit = "1" if group.unit == "-" else group.unit
                coordinates[group.name] = variable(*along_own_axes(value, names), unit, group.label)
        if (factor := self.groups.get("vertical_scale")) is not None:
            about = "factor of the vertical component"
            coordinates["vertical_scale"] = variable(*along_own_axes(factor, names), "1", about)
        attributes = {"pulse": self.pulse} if self.pulse else {}
        found = xr.Dataset(variables, coordinates, attributes)
        return with_index(found, names[-1], self.index) if names and dims is None else found

    def to_pandas(self) -> pd.DataFrame:
        """The fields as columns, one row for each block; the index has the axes of `to_xarray`."""
        labelled = self.to_xarray()
        return (labelled if labelled.dims else labelled.expand_dims("block")).to_dataframe()

    def _repr_html_(self) -> str:
        return f"<p>{escape(repr(self))}</p>{self.to_xarray()._repr_html_()}"


def axis_names(
    count: int, arguments: Mapping[str, NDArray[np.float64]], dims: tuple[Hashable, ...]
) -> tuple[Hashable, ...]:
    """Names of `count` axes: of the labelled arguments, `dims`, or of the one argument that varies along each."""
    if len(dims) == count:
        return dims
    varying: list[list[str]] = [[] for _ in range(count)]
    for name, value in arguments.items():
        axes = [axis for axis in range(value.ndim) if value.shape[axis] != 1]
        for axis in axes:
            # an argument that varies along several axes is no coordinate of either
            varying[count - value.ndim + axis] += [name] if len(axes) == 1 else [name, name]
    return tuple(names[0] if len(names) == 1 else f"dim_{axis}" for axis, names in enumerate(varying))


def along_own_axes(
    value: NDArray[np.float64], names: Sequence[Hashable]
) -> tuple[tuple[Hashable, ...], NDArray[np.float64]]:
    """The axes along which an argument of a response varies, out of the `names` of all axes, and its values."""
    first = len(names) - value.ndim
    axes = [axis for axis, size in enumerate(value.shape) if size != 1]
    return tuple(names[first + axis] for axis in axes), value.reshape([value.shape[axis] for axis in axes])


def dimensions_of(*arguments: ArrayLike | WithUnit | None) -> tuple[Hashable, ...]:
    """Names of the dimensions of the labelled argument (xarray) with the most of them; empty if there is none."""
    return max((tuple(getattr(argument, "dims", ())) for argument in arguments), key=len)
