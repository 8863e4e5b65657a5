"""Evaluation of requests, whose parameters were checked, with their options.

Many points are computed in chunks, so that the work can be cancelled, into arrays of the smallest sufficient types:
these arrays are the memory that a response keeps until its client has read it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from rocking._base.arrays import Array, Flags
from rocking._base.errors import OutsideCubeError
from rocking._excitation.pulses import as_pulse
from rocking._lookup.collection import CubeCollection
from rocking._lookup.cube import Points
from rocking._model.fields import BOUNDED_FIELDS, DERIVED_FIELDS, FROM_CUBE
from rocking._numba.cancellation import StopFlag
from rocking._numba.compilation import contiguous_array
from rocking._solver.bounded_response import BoundedResponse, solve_checked
from rocking_api.models.params import GROUPS, LookupOptions

CHUNK_SIZE = 50_000  # points between two checks of the stop flag [-]: some hundredths of a second

FIELDS: dict[str, DTypeLike] = {
    field.name: field.dtype for field in (*BOUNDED_FIELDS, *DERIVED_FIELDS) if field is not FROM_CUBE
}
"""Fields of `BoundedResponse` that are kept, and their types."""

BYTES_PER_POINT = sum(np.dtype(dtype).itemsize for dtype in FIELDS.values()) + 1
"""Memory of a `BatchResult` per point [bytes]."""


@dataclass(frozen=True)
class BatchResult:
    """Responses of many points: arrays (points,) of `FIELDS`, whether from a data set, sha256 of each data set used."""

    fields: dict[str, NDArray[Any]]
    from_cube: Flags
    versions: tuple[str, ...]


def evaluate(
    cubes: CubeCollection,
    options: LookupOptions,
    groups: Iterable[Array],
    stop: StopFlag | None = None,
    *,
    may_read: bool = True,
) -> tuple[BoundedResponse, tuple[str, ...]]:
    """Responses of checked points, and the sha256 of each data set that gave some of them.

    The groups are slenderness, frequency ratio, restitution and alpha, arrays (points,).
    """
    points = Points(*groups)
    if options.method == "solver":
        known = points.slenderness, points.frequency_ratio, points.restitution, points.alpha
        return solve_checked(as_pulse(options.pulse), *known, stop=stop), ()
    cube = cubes.cube(options.pulse, options.method, may_read)
    try:
        found, used = cube.evaluate(points, options.absolute_tolerance, options.method, None, stop)
    except OutsideCubeError as error:
        if error.parameter != "alpha":
            raise
        raise OutsideCubeError("alpha_deg", options.alpha_deg, error.allowed) from None
    return found, tuple([one.sha256 for one in used])


def evaluate_many(
    cubes: CubeCollection, options: LookupOptions, groups: Mapping[str, Array], stop: StopFlag
) -> BatchResult:
    """Responses of the points of three arrays of one length; as `evaluate`."""
    points = groups["slenderness"].size
    alpha = np.float64(math.radians(options.alpha_deg or 0.0))
    fields = {name: np.empty(points, dtype) for name, dtype in FIELDS.items()}
    from_cube = np.empty(points, np.bool_)
    versions: dict[str, None] = {}
    for start in range(0, max(points, 1), CHUNK_SIZE):
        stop.check()
        here = slice(start, start + CHUNK_SIZE)
        s, w, eta = (contiguous_array(groups[name][here]) for name in GROUPS)
        part, met = evaluate(cubes, options, (s, w, eta, np.full(s.size, alpha)), stop)
        for name, values in fields.items():
            values[here] = getattr(part, name)
        from_cube[here] = part.from_cube
        versions |= dict.fromkeys(met)
    return BatchResult(fields, from_cube, (*versions,))
