"""Responses as JSON, CSV or netCDF-3.

netCDF-3 rather than netCDF-4: xarray and every netCDF library read it, and request bodies are parsed by plain Python
(scipy), so that untrusted bytes do not reach the HDF5 library.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal

import numpy as np
import xarray as xr
from fastapi import Request, Response
from fastapi.responses import StreamingResponse
from numpy.typing import NDArray
from pydantic_core import to_json

from rocking._base.arrays import Array
from rocking._datasets.csv_text import csv_header, csv_rows, csv_text
from rocking._datasets.cube import MODEL_RESULT, VARIABLES
from rocking._interpolation.kernel import UNKNOWN_IMPACTS
from rocking._model.fields import DERIVED_FIELDS, ERROR_BOUND, IMPACTS
from rocking_api.execution.evaluation import FIELDS, BatchResult
from rocking_api.models.answer import Answer, url_of

Form = Literal["json", "csv", "nc"]

MEDIA_TYPES: dict[Form, str] = {
    "json": "application/json",
    "csv": "text/csv",
    "nc": "application/x-netcdf",
}

TABLE_FORMS: tuple[Form, ...] = ("json", "csv")
"""Formats of a table in a body, and of its response."""

CONTENT: dict[int | str, dict[str, Any]] = {200: {"content": {MEDIA_TYPES["csv"]: {}, MEDIA_TYPES["nc"]: {}}}}
"""For the OpenAPI description: the other formats of a response."""


Column = Callable[[slice], list[Any]]
"""The values of a column at some points, of which no list is made before they are sent."""


ROWS = 5_000  # points of a batch that are written and sent at once [-]: up to half a megabyte, some milliseconds
_WEIGHT = re.compile(r"0(\.[0-9]{0,3})?|1(\.0{0,3})?")  # RFC 9110, 12.4.2; another is ignored


def negotiated_form(
    request: Request,
    requested: Form | None,
    offered: Sequence[Form] = ("json", "csv", "nc"),
    default: Form | None = None,
) -> Form:
    """Format of the response.

    As requested, else the one that the Accept header prefers, of equal ones the first that it names; else the default,
    which is the first that is offered unless stated. text/html means the default.
    """
    if requested is not None:
        return requested
    request.state.negotiated = True  # `ParamsRoute` adds the header Vary
    default = default or offered[0]
    quality = _accepted(request.headers.get("accept", ""))
    named = list(quality)
    if quality.get("text/html", 0.0) > 0.0:
        named.insert(0, MEDIA_TYPES[default])
        quality[named[0]] = quality["text/html"]

    def rank(form: Form) -> tuple[float, bool, int]:
        media = MEDIA_TYPES[form]
        ranges = (media, media.partition("/")[0] + "/*", "*/*")  # the most specific holds (RFC 9110, 12.5.1)
        q = next((quality[one] for one in ranges if one in quality), 0.0)
        return q, media in quality, -named.index(media) if media in quality else 0

    return max((default, *offered), key=rank)


def _accepted(header: str) -> dict[str, float]:
    """The quality of each media range of an Accept header, -1 if it is excluded (q=0)."""
    found = {}
    for part in header.lower().split(","):
        media, *parameters = (text.strip() for text in part.split(";"))
        weight = next((text[2:] for text in parameters if text.startswith("q=")), "")
        found[media] = (float(weight) if _WEIGHT.fullmatch(weight) else 1.0) or -1.0
    return found


def json_response(answer: Answer[Any], request: Request, headers: Mapping[str, str] | None = None) -> Response:
    """An answer to a request as JSON, without validation."""
    answer.url = url_of(request)
    return Response(answer.model_dump_json(), headers=headers, media_type=MEDIA_TYPES["json"])


def csv_response(columns: Mapping[str, list[Any]], name: str) -> Response:
    """Columns as CSV, see `csv_text`."""
    return text_response(csv_text(columns), name)


def text_response(text: str, name: str, form: Form = "csv", headers: Mapping[str, str] | None = None) -> Response:
    """Return the text of `csv_text` as a file."""
    return Response(text, media_type=MEDIA_TYPES[form], headers={**_file(f"{name}.{form}"), **(headers or {})})


def columns_as_they_are(arrays: Mapping[str, NDArray[Any]]) -> dict[str, Column]:
    """Columns of arrays (points,)."""
    return {name: lambda part, values=values: values[part].tolist() for name, values in arrays.items()}  # type: ignore[misc]


def csv_stream(columns: Mapping[str, Column], points: int, name: str) -> Response:
    """Columns as CSV, written while it is sent: the text of a million points takes 100 MB."""

    def parts() -> Iterator[bytes]:
        yield csv_header(columns).encode()
        for start in range(0, points, ROWS):
            yield csv_rows({key: column(slice(start, start + ROWS)) for key, column in columns.items()}).encode()

    return _streamed(parts(), points, MEDIA_TYPES["csv"], _file(f"{name}.csv"))


def json_stream(answer: Answer[Any], request: Request, columns: Mapping[str, Column], points: int) -> Response:
    """As `json_response`, after columns that the answer lacks; written while it is sent."""
    answer.url = url_of(request)

    def parts() -> Iterator[bytes]:
        opening = b"{"
        for key, column in columns.items():
            opening += to_json(key) + b":["
            for start in range(0, points, ROWS):
                yield opening + to_json(column(slice(start, start + ROWS)), inf_nan_mode="null")[1:-1]
                opening = b","
            opening = (b"" if points else opening) + b"],"
        yield opening + answer.model_dump_json().encode()[1:]

    return _streamed(parts(), points, MEDIA_TYPES["json"], {})


def _streamed(parts: Iterator[bytes], points: int, media_type: str, headers: dict[str, str]) -> Response:
    """Send a short response as a whole: a thread per part would take longer."""
    if points <= ROWS:
        return Response(b"".join(parts), media_type=media_type, headers=headers)
    return StreamingResponse(parts, media_type=media_type, headers=headers)


def netcdf_response(dataset: xr.Dataset, name: str) -> Response:
    """A data set as a netCDF-3 file."""
    content = dataset.to_netcdf(engine="scipy", format="NETCDF3_64BIT")
    return Response(content, media_type=MEDIA_TYPES["nc"], headers=_file(f"{name}.nc"))


def solved_variable(name: str, dimensions: Any, values: NDArray[Any]) -> tuple[Any, NDArray[Any], dict[str, Any]]:
    """A field of responses with the type and the attributes that it has in the data sets."""
    dtype, about = VARIABLES[name]
    kept = {key: value for key, value in about.items() if key != "ancillary_variables"}
    return dimensions, values.astype(dtype, copy=False), MODEL_RESULT | kept


def dataset_of(groups: Mapping[str, Array], result: BatchResult, attributes: Mapping[str, Any]) -> xr.Dataset:
    """Groups and results over one dimension `point`, with the attributes of the data sets."""
    variables: dict[str, Any] = {name: ("point", values, {"units": "1"}) for name, values in groups.items()}
    variables |= {name: solved_variable(name, "point", result.fields[name]) for name in FIELDS if name in VARIABLES}
    variables[IMPACTS.name][2]["_FillValue"] = np.int32(UNKNOWN_IMPACTS)
    for field in DERIVED_FIELDS:
        variables[field.name] = ("point", result.fields[field.name], MODEL_RESULT | field.attributes)
    bound = {"units": ERROR_BOUND.unit, **ERROR_BOUND.attributes}
    source = {"flag_values": np.arange(2, dtype=np.int8), "flag_meanings": "cube solver"}
    variables["error_bound"] = ("point", result.fields["error_bound"], bound)
    variables["source"] = ("point", (~result.from_cube).astype("i1"), {"long_name": "source", **source})
    return xr.Dataset(variables, attrs={"Conventions": "CF-1.11", **attributes})


def _file(name: str) -> dict[str, str]:
    return {"Content-Disposition": f'attachment; filename="{name}"'}
