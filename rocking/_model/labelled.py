"""Responses to labelled arguments: xarray broadcasts them by the names of dimensions; with dask they stay lazy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from rocking._base.errors import InvalidArgumentError
from rocking._model.fields import OVERTURNED, RESPONSE_FIELDS

if TYPE_CHECKING:
    import xarray as xr

FIELDS = (*RESPONSE_FIELDS, OVERTURNED)


def is_labelled(*arguments: Any) -> bool:
    """Whether one of the arguments is an `xarray.DataArray`; xarray is not loaded to find out."""
    return any(type(argument).__name__ == "DataArray" and hasattr(argument, "dims") for argument in arguments)


def labelled_response(
    solve: Callable[..., Any], arguments: Mapping[str, Any], options: Mapping[str, Any]
) -> xr.Dataset:
    """The response as a data set over the dimensions of the arguments.

    Parameters
    ----------
    solve : callable
        Takes the arguments as arrays that broadcast by position, and the options; gives a `Response`.
    arguments : mapping
        Labelled and plain ones by name; None is left out. Plain ones are numbers.
    options : mapping
        Other arguments of `solve`. For dask-backed arguments `threads` is 1 unless stated: a worker has its own.

    Raises
    ------
    InvalidArgumentError
        If the indexes of a dimension differ, or a plain argument is an array.
    """
    import xarray as xr  # noqa: PLC0415  # loaded by who made the arguments

    given = {name: value for name, value in arguments.items() if value is not None}
    options = dict(options)
    for name, value in given.items():
        if not is_labelled(value) and getattr(value, "shape", ()) not in ((),):
            raise InvalidArgumentError(name, value, "a number or an xarray.DataArray beside labelled arguments")
    if options.get("threads") is None and any(getattr(value, "chunks", None) for value in given.values()):
        options["threads"] = 1

    def fields(*values: Any) -> tuple[Any, ...]:
        found = solve(**dict(zip(given, values, strict=True)), **options)
        return tuple(getattr(found, one.name) for one in FIELDS)

    try:
        variables = xr.apply_ufunc(
            fields,
            *given.values(),
            join="exact",
            output_core_dims=[()] * len(FIELDS),
            output_dtypes=[one.dtype for one in FIELDS],
            dask="parallelized",
        )
    except xr.AlignmentError as error:
        raise InvalidArgumentError(", ".join(given), "labels", f"equal indexes of a dimension ({error})") from None
    named = {one.name: value for one, value in zip(FIELDS, variables, strict=True)}
    data = xr.Dataset(named)
    for one in FIELDS:
        data[one.name].attrs = {"units": one.unit} | one.attributes
    free = {name: value for name, value in given.items() if name not in data.dims}
    return data.assign_coords({name: value for name, value in free.items() if not getattr(value, "chunks", None)})
