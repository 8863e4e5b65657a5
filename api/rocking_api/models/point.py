"""One block's answer as plain numbers."""

from __future__ import annotations

from typing import NamedTuple

from rocking.solver.bounded_response import BoundedResponse


class Point(NamedTuple):
    """The fields of a `BoundedResponse` for one block, and the sha256 of the data set that answered."""

    peak_rotation: float
    outcome: int
    impacts: int
    exceeded_alpha: bool
    error_bound: float
    source: str
    data_version: str | None


def points_of(found: BoundedResponse, versions: tuple[str, ...]) -> list[Point]:
    """Answers of one restitution, one by one."""
    columns = [getattr(found, name).ravel().tolist() for name in Point._fields[:-1]]
    version = versions[0] if versions else None
    return [Point._make((*row, version if row[-1] == "cube" else None)) for row in zip(*columns, strict=True)]
