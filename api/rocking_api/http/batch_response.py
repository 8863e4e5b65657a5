"""The answer to a batch in the form asked for."""

from __future__ import annotations

from typing import Any

from fastapi import Response

from rocking_api.execution.evaluation import BatchResult
from rocking_api.http.batch_body import Batch
from rocking_api.http.formats import Form, csv_stream, dataset_of, json_stream, netcdf_response
from rocking_api.models.responses import VERSION, columns_of


def batch_response(batch: Batch, result: BatchResult, form: Form) -> Response:
    """The answer in its form; JSON and CSV are written while they are sent."""
    query: dict[str, Any] = batch.options.model_dump() | {"points": batch.points}
    if form == "nc":
        attributes = {name: value for name, value in query.items() if value is not None}
        return netcdf_response(dataset_of(batch.groups, result, attributes), "response")
    columns = columns_of(result)
    if form == "csv":
        return csv_stream(batch.groups | columns, "response")
    return json_stream({"data_versions": result.versions, "version": VERSION, "query": query}, columns)
