"""Evaluation of requests: within the ranges of the service, with the options of a request.

Many points are computed in chunks, so that the work can be cancelled, into arrays of the smallest sufficient types:
these arrays are the memory that a response keeps until its client has read it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from rocking._lookup.collection import CubeCollection
from rocking._model.fields import BOUNDED_FIELDS, DERIVED_FIELDS, FROM_CUBE
from rocking._numba.cancellation import StopFlag
from rocking._solver.bounded_response import BoundedResponse
from rocking_api.models.params import FREQUENCY_RATIO, SLENDERNESS, LookupOptions, alpha_of

CHUNK_SIZE = 50_000
"""Points between two checks of the stop flag [-]: some hundredths of a second."""

FIELDS: dict[str, DTypeLike] = {
    field.name: field.dtype for field in (*BOUNDED_FIELDS, *DERIVED_FIELDS) if field is not FROM_CUBE
}
"""Fields of `BoundedResponse` that are kept, and their types."""

BYTES_PER_POINT = sum(np.dtype(dtype).itemsize for dtype in FIELDS.values()) + 1
"""Memory of a `BatchResult` per point [bytes]."""


@dataclass(frozen=True)
class BatchResult:
    """Responses of many points.

    Attributes
    ----------
    fields : arrays by name, shape (points,)
        Those of `FIELDS`.
    from_cube : bool array, shape (points,)
        Whether a point comes from a data set; one byte rather than 24 for the name.
    versions : tuple of str
        sha256 of each data set used.
    """

    fields: dict[str, NDArray[Any]]
    from_cube: NDArray[np.bool_]
    versions: tuple[str, ...]


def evaluate(
    cubes: CubeCollection,
    options: LookupOptions,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
    stop: StopFlag | None = None,
) -> tuple[BoundedResponse, tuple[str, ...]]:
    """Responses, and the sha256 of each data set that gave some of them; the arguments broadcast.

    Raises
    ------
    InvalidArgumentError, DatasetError
        As `CubeCollection.response`; also outside the ranges of the service.
    StoppedError
        If `stop` was set.
    """
    return cubes.response(
        options.pulse,
        slenderness=SLENDERNESS.convert(slenderness),
        frequency_ratio=FREQUENCY_RATIO.convert(frequency_ratio),
        restitution=restitution,
        alpha=alpha_of(options.alpha_deg),
        absolute_tolerance=options.absolute_tolerance,
        method=options.method,
        stop=stop,
    )


def evaluate_many(
    cubes: CubeCollection, options: LookupOptions, groups: Mapping[str, NDArray[np.float64]], stop: StopFlag
) -> BatchResult:
    """Responses of the points of three arrays of one length.

    Raises
    ------
    InvalidArgumentError, DatasetError
        As `evaluate`.
    StoppedError
        If `stop` was set.
    """
    points = groups["slenderness"].size
    fields = {name: np.empty(points, dtype) for name, dtype in FIELDS.items()}
    from_cube = np.empty(points, np.bool_)
    versions: dict[str, None] = {}
    for start in range(0, max(points, 1), CHUNK_SIZE):
        stop.check()
        here = slice(start, start + CHUNK_SIZE)
        part, met = evaluate(cubes, options, **{name: values[here] for name, values in groups.items()}, stop=stop)
        for name, values in fields.items():
            values[here] = getattr(part, name)
        from_cube[here] = part.from_cube
        versions |= dict.fromkeys(met)
    return BatchResult(fields, from_cube, (*versions,))


class PointResult(NamedTuple):
    """The fields of a `BoundedResponse` for one block, the sha256 of its data set, and the derived fields by name."""

    peak_rotation: float
    outcome: int
    impacts: int
    exceeded_alpha: bool
    error_bound: float
    source: str
    data_version: str | None
    derived: dict[str, float]


def point_results(found: BoundedResponse, versions: tuple[str, ...]) -> list[PointResult]:
    """The results of one restitution, one by one."""
    columns = [getattr(found, name).ravel().tolist() for name in PointResult._fields[:-2]]
    derived = {name: values.ravel().tolist() for name, values in found.derived.items()}
    version = versions[0] if versions else None
    return [
        PointResult._make(
            (*row, version if row[-1] == "cube" else None, {name: values[k] for name, values in derived.items()})
        )
        for k, row in enumerate(zip(*columns, strict=True))
    ]
