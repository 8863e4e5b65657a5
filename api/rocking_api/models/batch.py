"""Many blocks in the groups: the columns of a CSV or netCDF-3 file, and what a request gives beside them."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
import xarray as xr

from rocking._base.arrays import Array
from rocking._base.errors import InvalidArgumentError
from rocking._numba.cancellation import StopFlag
from rocking_api.http.errors import TooLargeError
from rocking_api.models.params import GROUPS, LookupOptions

Columns = Mapping[str, Array]

CHUNK_LINES = 10_000  # lines of CSV that are parsed at once: 5 ms, for which numpy holds the interpreter lock
MAX_LINE = 1000  # characters of a line of CSV


@dataclass(frozen=True)
class Batch:
    """Points to evaluate, arrays of shape (points,), and the options."""

    options: LookupOptions
    groups: dict[str, Array]

    @property
    def points(self) -> int:
        return self.groups["slenderness"].size


def batch_of(options: LookupOptions, columns: Columns, given: Mapping[str, Any], max_points: int) -> Batch:
    """The points of the columns of a body, and of the groups that are given beside it: numbers or lists, or None."""
    groups = dict(columns)
    for name in GROUPS:
        if given.get(name) is not None:
            if name in groups:
                raise InvalidArgumentError(name, given[name], "either in the body or in the URL")
            groups[name] = np.atleast_1d(np.array(given[name], dtype=np.float64))
        elif name not in groups:
            raise InvalidArgumentError(name, None, "required: a column of the body or a parameter in the URL")
    sizes = {name: column.size for name, column in groups.items()}
    points = max(sizes.values()) if min(sizes.values()) else 0
    for name, size in sizes.items():
        if size not in (1, points):
            raise InvalidArgumentError(name, f"{size} values", f"one value, or as many as the others: {points}")
    if points > max_points:
        raise TooLargeError("points", points, f"at most {max_points}")
    for name, column in groups.items():
        GROUPS[name].convert(column)
    return Batch(options, {name: np.broadcast_to(groups[name], (points,)) for name in GROUPS})


def parse_csv(body: bytes, max_points: int, stop: StopFlag) -> Columns:
    """The columns of a CSV body with a header line; by line, as the whole text would take five times its memory."""
    lines = _lines(io.TextIOWrapper(io.BytesIO(body), encoding="utf-8-sig", newline="\n"))
    tables: list[Array] = []
    first, points = 2, 0
    try:
        names = _group_names(name.strip() for name in next(lines, "").split(","))
        while chunk := [*islice(lines, CHUNK_LINES)]:
            stop.check()
            if rows := [line for line in chunk if not line.isspace()]:
                tables.append(np.loadtxt(rows, delimiter=",", ndmin=2, comments=None))
                if tables[-1].shape[1] != len(names):
                    columns = f"{tables[-1].shape[1]} columns"
                    raise InvalidArgumentError("body", columns, f"{len(names)}, as in the header line")
            first, points = first + len(chunk), points + len(rows)
            if points > max_points:
                raise TooLargeError("points", points, f"at most {max_points}")
    except InvalidArgumentError:
        raise
    except ValueError as error:  # UnicodeDecodeError among them
        allowed = "CSV: a header line, then numbers separated by commas"
        raise InvalidArgumentError("body", f"from line {first}: {error}", allowed) from None
    table = np.concatenate(tables) if tables else np.empty((0, len(names)))
    return dict(zip(names, table.T, strict=True))


def _lines(stream: io.TextIOWrapper) -> Iterator[str]:
    while line := stream.readline(MAX_LINE + 1):
        if len(line) > MAX_LINE:
            raise InvalidArgumentError("body", line[:40], f"lines of at most {MAX_LINE} characters")
        yield line


def _group_names(names: Iterator[str]) -> list[str]:
    """The names of columns, each that of a group."""
    found: list[str] = []
    for name in names:
        if name not in GROUPS or name in found:
            raise InvalidArgumentError("body", name, "columns " + ", ".join(GROUPS) + ", each at most once")
        found.append(name)
    return found


def parse_netcdf(body: bytes, max_points: int) -> Columns:
    """Variables of any dimensions broadcast by dimension name; points follow in C order of the dimensions."""
    if not body.startswith((b"CDF\x01", b"CDF\x02")):
        raise InvalidArgumentError("body", repr(body[:4]), "netCDF-3, as written by Dataset.to_netcdf(engine='scipy')")
    try:
        with xr.open_dataset(io.BytesIO(body), engine="scipy", decode_times=False) as opened:
            dataset = opened.load()
        names = [str(name) for name in dataset.variables]
        columns = [dataset[name].astype(np.float64) for name in names]
    except Exception as error:  # noqa: BLE001  (whatever scipy and xarray meet in a damaged file)
        raise InvalidArgumentError("body", repr(error)[:100], "an undamaged netCDF-3 file of numbers") from None
    _group_names(iter(names))
    points = math.prod(dataset.sizes.values())
    if points > max_points:  # before broadcasting
        raise TooLargeError("points", points, f"at most {max_points}")
    return {str(column.name): np.ravel(column.values) for column in xr.broadcast(*columns)}
