"""Responses as CSV or netCDF-3.

netCDF-3 rather than netCDF-4: xarray and every netCDF library read it, and request bodies are parsed by plain Python
(scipy), so that untrusted bytes do not reach the HDF5 library.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
import xarray as xr
from fastapi import Body, Request, Response
from fastapi.responses import StreamingResponse
from numpy.typing import NDArray
from pydantic import BaseModel, Discriminator, Tag

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError
from rocking._base.quantities import GROUPS
from rocking._datasets.csv_text import csv_header, csv_rows, csv_text
from rocking._datasets.cube import MODEL_RESULT, VARIABLES, describe
from rocking._interpolation.kernel import UNKNOWN_IMPACTS
from rocking._model.fields import DERIVED_FIELDS, ERROR_BOUND, IMPACTS
from rocking_api.execution.evaluation import BatchResult
from rocking_api.http.errors import UnsupportedBodyError

M = TypeVar("M")
P = TypeVar("P", bound=BaseModel)
Q = TypeVar("Q", bound=BaseModel)

Form = Literal["json", "csv", "nc"]

MEDIA_TYPES: dict[Form, str] = {
    "json": "application/json",
    "csv": "text/csv",
    "nc": "application/x-netcdf",
}

CONTENT: dict[int | str, dict[str, Any]] = {200: {"content": {MEDIA_TYPES["csv"]: {}, MEDIA_TYPES["nc"]: {}}}}
"""For the OpenAPI description: the other formats of a response."""

JsonOrFile = Annotated[
    Annotated[M, Tag("<json>")] | Annotated[bytes, Tag("<file>")],
    Discriminator(lambda value: "<file>" if isinstance(value, bytes) else "<json>"),
    Body(),
]
"""A body that is a JSON object of some model, or a file of another media type as it is."""

Column = Callable[[slice], list[Any]]
"""The values of a column at some points, of which no list is made before they are sent."""

ROWS = 5_000  # points of a batch that are written and sent at once [-]: up to half a megabyte, some milliseconds


def body_form(request: Request, accepted: Sequence[Form]) -> Form:
    """Format of the body by its Content-Type, which has to be stated."""
    declared = request.headers.get("content-type", "").split(";")[0].strip().lower()
    for form in accepted:
        if declared in (MEDIA_TYPES[form], "application/netcdf" if form == "nc" else MEDIA_TYPES[form]):
            return form
    types = ", ".join(MEDIA_TYPES[form] for form in accepted)
    raise UnsupportedBodyError("Content-Type", declared, f"one of {types}")


def stated(body: P | bytes, query: Q) -> P | Q:
    """The parameters of a request: those of the query beside a file, those of a JSON body otherwise."""
    if isinstance(body, bytes):
        return query
    for name in query.model_fields_set:
        raise InvalidArgumentError(name, getattr(query, name), "in the JSON body, which holds all parameters")
    return body


def body_of(json_example: Any, texts: Mapping[str, str], description: str = "") -> dict[str, Any]:
    """What the OpenAPI description of a route adds to its body: an example of JSON, and of texts by media type."""
    content: dict[str, Any] = {MEDIA_TYPES["json"]: {"example": json_example}}
    content |= {media: {"schema": {"type": "string"}, "example": text} for media, text in texts.items()}
    return {"requestBody": {"content": content, **({"description": description} if description else {})}}


def csv_response(columns: Mapping[str, list[Any]], name: str) -> Response:
    """Columns as CSV, see `csv_text`."""
    return text_response(csv_text(columns), name)


def text_response(text: str, name: str, form: Form = "csv") -> Response:
    """Return the text of `csv_text` as a file."""
    return Response(text, media_type=MEDIA_TYPES[form], headers=_file(f"{name}.{form}"))


def columns_as_they_are(arrays: Mapping[str, NDArray[Any]]) -> dict[str, Column]:
    """Columns of arrays (points,)."""
    return {name: lambda part, values=values: values[part].tolist() for name, values in arrays.items()}  # type: ignore[misc]


def csv_stream(columns: Mapping[str, Column], points: int, name: str) -> Response:
    """Columns as CSV, written while it is sent: the text of a million points takes 100 MB."""

    def parts() -> Iterator[bytes]:
        yield csv_header(columns).encode()
        for start in range(0, points, ROWS):
            yield csv_rows({key: column(slice(start, start + ROWS)) for key, column in columns.items()}).encode()

    if points <= ROWS:  # a thread a part would take longer
        return Response(b"".join(parts()), media_type=MEDIA_TYPES["csv"], headers=_file(f"{name}.csv"))
    return StreamingResponse(parts(), media_type=MEDIA_TYPES["csv"], headers=_file(f"{name}.csv"))


def netcdf_response(dataset: xr.Dataset, name: str, title: str, url: str) -> Response:
    """A data set as a netCDF-3 file that follows CF-1.11; `url` repeats the question."""
    dataset = describe(dataset.drop_encoding(), title=title, history=f"rocking serve: {url}")
    if "time" in dataset.dims:  # a dimension of this name is one of dates
        dataset = dataset.rename_dims(time="sample")
    for variable in dataset.data_vars.values():
        others = variable.attrs.pop("ancillary_variables", "").split()
        if present := [other for other in others if other in dataset]:
            variable.attrs["ancillary_variables"] = " ".join(present)
    without_fill = {coordinate: {"_FillValue": None} for coordinate in dataset.coords}
    content = dataset.to_netcdf(engine="scipy", format="NETCDF3_64BIT", encoding=without_fill)
    return Response(content, media_type=MEDIA_TYPES["nc"], headers=_file(f"{name}.nc"))


SOLVED = ("peak_rotation", "outcome", "impacts", "exceeded_alpha")
"""Fields of responses that every file has."""


def solved_variables(dimensions: Any, fields: Mapping[str, NDArray[Any]]) -> dict[str, Any]:
    """Fields of responses with the types and the attributes that they have in the data sets."""
    variables = {}
    for name in SOLVED:
        dtype, attributes = VARIABLES[name]
        variables[name] = dimensions, fields[name].astype(dtype, copy=False), MODEL_RESULT | attributes
    return variables


def dataset_of(groups: Mapping[str, Array], result: BatchResult, attributes: Mapping[str, Any]) -> xr.Dataset:
    """Groups and results over one dimension `point`, with the attributes of the data sets."""
    variables: dict[str, Any] = {
        group.name: ("point", groups[group.name], {"units": "1", "long_name": group.label})
        for group in GROUPS
        if group.name in groups
    }
    variables |= solved_variables("point", result.fields)
    variables[IMPACTS.name][2]["_FillValue"] = np.int32(UNKNOWN_IMPACTS)
    for field in DERIVED_FIELDS:
        variables[field.name] = ("point", result.fields[field.name], MODEL_RESULT | field.attributes)
    bound = {"units": ERROR_BOUND.unit, **ERROR_BOUND.attributes}
    source = {"flag_values": np.arange(2, dtype=np.int8), "flag_meanings": "cube solver"}
    variables["error_bound"] = ("point", result.fields["error_bound"], bound)
    variables["source"] = ("point", (~result.from_cube).astype("i1"), {"long_name": "source", **source})
    return xr.Dataset(variables, attrs=dict(attributes))


def _file(name: str) -> dict[str, str]:
    return {"Content-Disposition": f'attachment; filename="{name}"'}
