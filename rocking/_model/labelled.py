"""Responses to labelled arguments: xarray broadcasts them by the names of dimensions; with dask they stay lazy."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from rocking._base.errors import InvalidArgumentError, float_array
from rocking._model.fields import OVERTURNED, RESPONSE_FIELDS, ResponseField

if TYPE_CHECKING:
    import xarray as xr

FIELDS = (*RESPONSE_FIELDS, OVERTURNED)


Index = tuple[Hashable, Any]


def variable(dims: Any, values: Any, unit: str, meaning: str, **attributes: Any) -> tuple[Any, Any, dict[str, Any]]:
    """A variable of a data set with unit, as CF writes it, "" for none, meaning and further attributes."""
    units = {"units": unit} if unit else {}
    return dims, values, units | {"long_name": meaning} | attributes


def is_labelled(*arguments: Any) -> bool:
    """Whether one of the arguments is an `xarray.DataArray`; xarray is not loaded to find out."""
    return any([type(one).__name__ == "DataArray" and hasattr(one, "dims") for one in arguments])  # noqa: C419  (a call)


def index_of(*arguments: Any) -> Index | None:
    """Name, "index" without one, and labels of the index of the first pandas series, which is found without pandas."""
    for argument in arguments:
        if type(argument).__name__ == "Series" and hasattr(argument, "index"):
            index = argument.index
            return index.name or "index", index if index.nlevels == 1 else index.to_numpy()
    return None


def with_index(found: xr.Dataset, axis: Hashable, index: Index | None) -> xr.Dataset:
    """A data set whose dimension `axis` has the name and labels of the index of a pandas argument, if there is one."""
    if index is None or found.sizes.get(axis) != len(index[1]):
        return found
    name, labels = index
    if name != axis and name in found.variables:  # an argument of that name is a coordinate already
        return found
    return (
        found.reset_index([axis] if axis in found.indexes else [])
        .swap_dims({axis: name})
        .assign_coords({name: (name, labels)})
    )


def in_unit(parameter: str, value: Any, unit: str) -> Any:
    """A labelled argument that holds texts or quantities, as numbers in `unit`; others as they are."""
    if not is_labelled(value) or (value.dtype.kind not in "UO" and not hasattr(value.variable.data, "units")):
        return value
    return value.copy(data=float_array(parameter, value, unit=unit))


def broadcast_by_name(arguments: Mapping[str, xr.DataArray]) -> dict[str, xr.DataArray]:
    """Labelled arguments over all dimensions of them; dimensions with different indexes are refused."""
    if not arguments:
        return {}
    import xarray as xr  # noqa: PLC0415  # loaded by who made the arguments

    try:
        aligned = xr.align(*arguments.values(), join="exact")
    except xr.AlignmentError as error:
        raise _differ(arguments, error) from None
    return dict(zip(arguments, xr.broadcast(*aligned), strict=True))


def _differ(arguments: Mapping[str, Any], error: Exception) -> InvalidArgumentError:
    return InvalidArgumentError(", ".join(arguments), "labels", f"equal indexes of a dimension ({error})")


def labelled_response(
    solve: Callable[..., Any],
    arguments: Mapping[str, Any],
    options: Mapping[str, Any],
    fields: Sequence[ResponseField] = FIELDS,
) -> xr.Dataset:
    """The response as a data set over the dimensions of the arguments.

    `solve` takes the arguments as arrays that broadcast by position, and the options, and gives an object with the
    fields. `arguments`: labelled ones and plain numbers by name; None is left out. For dask-backed arguments `threads`
    is 1 unless stated: a worker has its own. Dimensions with different indexes and plain arrays are refused. An error
    of `solve` names the value without its place, which is that in a chunk, or among dimensions in another order.
    """
    import xarray as xr  # noqa: PLC0415  # loaded by who made the arguments

    given = {name: value for name, value in arguments.items() if value is not None}
    options = dict(options)
    for name, value in given.items():
        if not is_labelled(value) and getattr(value, "shape", ()) not in ((),):
            raise InvalidArgumentError(name, value, "a number or an xarray.DataArray beside labelled arguments")
    if options.get("threads") is None and any(getattr(value, "chunks", None) for value in given.values()):
        options["threads"] = 1

    def solved(*values: Any) -> tuple[Any, ...]:
        with without_place():
            found = solve(**dict(zip(given, values, strict=True)), **options)
        return tuple(getattr(found, one.name) for one in fields)

    try:
        variables = xr.apply_ufunc(
            solved,
            *given.values(),
            join="exact",
            output_core_dims=[()] * len(fields),
            output_dtypes=[one.dtype for one in fields],
            dask="parallelized",
        )
    except xr.AlignmentError as error:
        raise _differ(given, error) from None
    named = {one.name: value for one, value in zip(fields, variables, strict=True)}
    data = xr.Dataset(named)
    for one in fields:
        data[one.name].attrs = {"units": one.unit} | one.attributes
    return data.assign_coords({name: value for name, value in given.items() if name not in data.dims})


@contextmanager
def without_place() -> Iterator[None]:
    """Errors of arguments inside have no index: the index in a part is wrong in the whole array."""
    try:
        yield
    except InvalidArgumentError as error:
        if not error.index:
            raise
        raise InvalidArgumentError(error.parameter, error.value, error.allowed) from None
