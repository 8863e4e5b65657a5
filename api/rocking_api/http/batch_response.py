"""The answer to a batch: computed piece by piece, so that it can be stopped, and written in the form asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
from fastapi import Response

from rocking._numba.cancellation import StopFlag
from rocking.lookup.collection import CubeCollection
from rocking.solver.bounded_response import BoundedResponse
from rocking_api.execution.evaluation import ask
from rocking_api.http.batch_body import Batch
from rocking_api.http.formats import Form, csv_stream, dataset_of, json_response, netcdf_response
from rocking_api.http.in_flight import Holding
from rocking_api.models.responses import BatchAnswer, arrays_of, columns_of

PIECE = 50_000
"""Points between two looks at the clock [-]: some hundredths of a second."""


def answer_batch(atlas: CubeCollection, batch: Batch, stop: StopFlag) -> tuple[BoundedResponse, tuple[str, ...]]:
    """Responses of all points, and the sha256 of each data set that gave some of them.

    Raises
    ------
    InvalidArgumentError, DatasetError
        As `CubeCollection.response`.
    StoppedError
        If `stop` was set.
    """
    parts = []
    versions: dict[str, None] = {}
    for start in range(0, max(batch.points, 1), PIECE):
        stop.check()
        piece = {name: values[start : start + PIECE] for name, values in batch.groups.items()}
        part, met = ask(atlas, batch.options, **piece, stop=stop)
        parts.append(part)
        versions |= dict.fromkeys(met)
    names = BoundedResponse.__dataclass_fields__
    return BoundedResponse(*(np.concatenate([getattr(part, name) for part in parts]) for name in names)), (*versions,)


def batch_response(
    batch: Batch, found: BoundedResponse, versions: tuple[str, ...], form: Form, holding: Holding
) -> Response:
    """The answer in its form; what is kept until it is sent is counted in `holding`."""
    query: dict[str, Any] = batch.options.model_dump() | {"points": batch.points}
    if form == "json":
        columns = columns_of(found)
        return json_response(BatchAnswer.model_construct(query=query, data_versions=list(versions), **columns))
    if form == "csv":
        arrays = batch.groups | arrays_of(found)
        holding.add(sum(column.nbytes for column in arrays.values()))
        return csv_stream(arrays, "response")
    attributes = {name: value for name, value in query.items() if value is not None}
    return netcdf_response(dataset_of(batch.groups, found, attributes), "response")
