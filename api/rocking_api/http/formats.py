"""Answers as JSON, CSV or netCDF-3.

netCDF-3 rather than netCDF-4: xarray and every netCDF library read it, and the bodies that we are sent are parsed by
plain Python (scipy), so that no hostile bytes reach the HDF5 library.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal

import numpy as np
import xarray as xr
from fastapi import Request, Response
from fastapi.responses import StreamingResponse
from numpy.typing import NDArray
from pydantic import BaseModel

from rocking.datasets.csv_text import csv_rows, csv_text
from rocking.datasets.cube import MODEL_RESULT, VARIABLES
from rocking.solver.bounded_response import BoundedResponse

Form = Literal["json", "csv", "nc"]

MEDIA_TYPES: dict[Form, str] = {"json": "application/json", "csv": "text/csv", "nc": "application/x-netcdf"}

CONTENT: dict[int | str, dict[str, Any]] = {
    200: {"content": {MEDIA_TYPES["csv"]: {}, MEDIA_TYPES["nc"]: {}}},
}
"""For the OpenAPI description: the other forms of an answer."""

Column = NDArray[np.float64] | NDArray[np.int32] | NDArray[np.bool_] | NDArray[np.str_] | NDArray[np.object_]

ROWS = 10_000
"""Lines of CSV that are sent at once [-]."""

_SOURCES = ["cube", "solver"]


def form_of(request: Request, asked: Form | None, default: Form = "json") -> Form:
    """The form of the answer: as asked, else the first known media type of the Accept header, else the default."""
    if asked is not None:
        return asked
    for part in request.headers.get("accept", "").split(","):
        for form, media_type in MEDIA_TYPES.items():
            if part.split(";")[0].strip() == media_type:
                return form
    return default


def json_response(answer: BaseModel) -> Response:
    """A model as JSON; it was made by us and is not validated again."""
    return Response(answer.model_dump_json(), media_type=MEDIA_TYPES["json"])


def csv_response(columns: Mapping[str, list[Any]], name: str) -> Response:
    """Columns as CSV: numbers to the last digit, nothing where there is no number, true and false."""
    return Response(csv_text(columns), media_type=MEDIA_TYPES["csv"], headers=_file(f"{name}.csv"))


def csv_stream(columns: Mapping[str, Column], name: str) -> Response:
    """Arrays (points,) as CSV, written while it is sent: the text of a million points is 100 MB."""

    def parts() -> Iterator[str]:
        yield ",".join(columns) + "\n"
        for start in range(0, len(next(iter(columns.values()))), ROWS):
            yield csv_rows({key: column[start : start + ROWS].tolist() for key, column in columns.items()})

    return StreamingResponse(parts(), media_type=MEDIA_TYPES["csv"], headers=_file(f"{name}.csv"))


def netcdf_response(dataset: xr.Dataset, name: str) -> Response:
    """A data set as a netCDF-3 file."""
    content = bytes(dataset.to_netcdf(engine="scipy", format="NETCDF3_64BIT"))
    return Response(content, media_type=MEDIA_TYPES["nc"], headers=_file(f"{name}.nc"))


def dataset_of(
    groups: Mapping[str, NDArray[np.float64]], found: BoundedResponse, attributes: Mapping[str, Any]
) -> xr.Dataset:
    """Questions and answers over one dimension `point`, with the attributes of the data sets."""
    variables: dict[str, Any] = {name: ("point", values, {"units": "1"}) for name, values in groups.items()}
    for name in ("peak_rotation", "outcome", "impacts", "exceeded_alpha"):
        dtype, about = VARIABLES[name]
        kept = {key: value for key, value in about.items() if key != "ancillary_variables"}
        variables[name] = ("point", getattr(found, name).astype(dtype), MODEL_RESULT | kept)
    bound = {"units": "1", "long_name": "bound of the absolute error of peak_rotation"}
    source = {"flag_values": np.arange(2, dtype=np.int8), "flag_meanings": " ".join(_SOURCES)}
    variables["error_bound"] = ("point", found.error_bound, bound)
    variables["source"] = ("point", (found.source == "solver").astype("i1"), {"long_name": "source", **source})
    return xr.Dataset(variables, attrs={"Conventions": "CF-1.11", **attributes})


def _file(name: str) -> dict[str, str]:
    return {"Content-Disposition": f'attachment; filename="{name}"'}
