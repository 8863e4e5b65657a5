"""The one way in which routes ask for responses: inside the border of the service, with the options of a question."""

from __future__ import annotations

from numpy.typing import ArrayLike

from rocking._numba.cancellation import StopFlag
from rocking.lookup.collection import CubeCollection
from rocking.solver.bounded_response import BoundedResponse
from rocking_api.models.params import LookupOptions, alpha_of, checked


def ask(
    atlas: CubeCollection,
    options: LookupOptions,
    *,
    slenderness: ArrayLike,
    frequency_ratio: ArrayLike,
    restitution: ArrayLike,
    stop: StopFlag | None = None,
) -> tuple[BoundedResponse, tuple[str, ...]]:
    """Responses, and the sha256 of each data set that gave some of them; the arguments broadcast.

    `stop` ends it with `StoppedError`.

    Raises
    ------
    InvalidArgumentError, DatasetError
        As `CubeCollection.response`, and beyond the border of the service.
    """
    return atlas.response(
        options.pulse,
        slenderness=checked("slenderness", slenderness),
        frequency_ratio=checked("frequency_ratio", frequency_ratio),
        restitution=restitution,
        alpha=alpha_of(options.alpha_deg),
        tolerance=options.tolerance,
        method=options.method,
        stop=stop,
    )
