"""The answer to a batch: computed piece by piece, so that it can be stopped, and written in the form asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
from fastapi import Response

from api.answers import BatchAnswer, arrays_of, columns_of
from api.ask import ask
from api.batch import Batch
from api.formats import Form, csv_stream, dataset_of, json_response, netcdf_response
from rocking.bounded_response import BoundedResponse
from rocking.lookup_atlas import Atlas

PIECE = 50_000
"""Points between two looks at the clock [-]: some hundredths of a second."""


def answer_batch(atlas: Atlas, batch: Batch) -> tuple[BoundedResponse, tuple[str, ...]]:
    """Responses of all points, and the sha256 of each data set that gave some of them.

    Raises
    ------
    InvalidArgumentError, DatasetError
        As `Atlas.response`.
    """
    parts = []
    versions: dict[str, None] = {}
    for start in range(0, max(batch.points, 1), PIECE):
        piece = {name: values[start : start + PIECE] for name, values in batch.groups.items()}
        part, met = ask(atlas, batch.options, **piece)
        parts.append(part)
        versions |= dict.fromkeys(met)
    names = BoundedResponse.__dataclass_fields__
    return BoundedResponse(*(np.concatenate([getattr(part, name) for part in parts]) for name in names)), (*versions,)


def batch_response(batch: Batch, found: BoundedResponse, versions: tuple[str, ...], form: Form) -> Response:
    """The answer in its form."""
    query: dict[str, Any] = batch.options.model_dump() | {"points": batch.points}
    if form == "json":
        columns = columns_of(found)
        return json_response(BatchAnswer.model_construct(query=query, data_versions=list(versions), **columns))
    if form == "csv":
        return csv_stream(batch.groups | arrays_of(found), "response")
    attributes = {name: value for name, value in query.items() if value is not None}
    return netcdf_response(dataset_of(batch.groups, found, attributes), "response")
