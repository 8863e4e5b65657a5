"""The curves on the control space that separate the fates, found with the solver itself.

The way of overturning (directly, after one impact, after three, ...) is computed on a grid; the outline of the region
of each way is followed by contourpy, and every vertex, which lies on a grid edge with the region at one end only, is
moved along that edge to where the fate changes. So the grid decides which regions are seen, never where they end; and a
safe band far narrower than a cell still shows, as the gap between the outlines on its two sides.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import chain, islice
from typing import NamedTuple

import numpy as np
import xarray as xr
from contourpy import LineType, contour_generator
from numpy.typing import ArrayLike, NDArray

from rocking._numba.cancellation import StopFlag
from rocking.boundary.search import Classify, Codes, Floats, classifier, shrink
from rocking.errors import in_range
from rocking.excitation.pulses import AbstractPulse, as_pulse
from rocking.model.response import Outcome

DIRECTLY = int(Outcome.OVERTURNED_DIRECTLY)
"""Code of overturning without an impact."""

AT_ONCE = 500_000
"""Blocks of the grid that are solved in one call, about: a hundred megabytes [-]."""


def overturning_boundary(
    pulse: str | AbstractPulse,
    *,
    restitution: float,
    alpha: float | None = None,
    frequency_ratio: tuple[float, float] = (0.2, 15.0),
    slenderness: tuple[float, float] = (0.02, 1.0),
    nodes: int = 401,
    stop: StopFlag | None = None,
) -> xr.Dataset:
    """The boundary curves of overturning on a window of the control space.

    Parameters
    ----------
    pulse, restitution, alpha
        As for `peak_response`; scalars.
    frequency_ratio : (float, float)
        Window of omega [-], 0 < low < high.
    slenderness : (float, float)
        Window of 1/a [-], 0 < low < high <= 1.
    nodes : int
        Grid nodes in each direction, 16 to 4001: regions narrower than a cell can be missed.
    stop : StopFlag, optional
        Once another thread sets it, this ends soon with `StoppedError`.

    Returns
    -------
    xarray.Dataset
        Polylines in the contiguous ragged representation of CF: slenderness(point), frequency_ratio(point), each
        vertex good to `RESOLUTION`; row_size(curve); outcome(curve), impacts(curve) of the overturning region that
        the curve bounds; neighbour_outcome(curve), neighbour_impacts(curve) on the other side (SAFE, 0, or another
        way of overturning).

    Raises
    ------
    InvalidArgumentError
        For an argument out of range.
    StoppedError
        If `stop` was set.
    """
    return overturning_boundaries(
        pulse,
        restitution=[restitution],
        alpha=alpha,
        frequency_ratio=frequency_ratio,
        slenderness=slenderness,
        nodes=nodes,
        stop=stop,
    )[0]


def overturning_boundaries(
    pulse: str | AbstractPulse,
    *,
    restitution: ArrayLike,
    alpha: float | None = None,
    frequency_ratio: tuple[float, float] = (0.2, 15.0),
    slenderness: tuple[float, float] = (0.02, 1.0),
    nodes: int = 401,
    stop: StopFlag | None = None,
) -> list[xr.Dataset]:
    """`overturning_boundary` for each of some coefficients of restitution (l,), bit by bit, with less work.

    They share the first flights on the grid, and the curves of overturning without an impact.
    """
    in_range("nodes", nodes, 16, 4001)
    low, high = (float(in_range("frequency_ratio", x, 0.0, np.inf, closed="neither")) for x in frequency_ratio)
    in_range("frequency_ratio[1]", high, low, np.inf, closed="neither")
    bottom, top = (float(in_range("slenderness", x, 0.0, 1.0, closed="right")) for x in slenderness)
    in_range("slenderness[1]", top, bottom, 1.0, closed="right")
    etas = in_range("restitution", restitution, 0.0, 1.0)
    made = as_pulse(pulse)
    classify = classifier(made, alpha, stop)
    axes = _spaced(bottom, top, int(nodes)), np.linspace(np.log(low), np.log(high), int(nodes))
    shares = np.array_split(axes[0], math.ceil(nodes * nodes * etas.size / AT_ONCE))
    codes = np.concatenate([classify(rows[:, None, None], axes[1][:, None], etas)[0] for rows in shares])

    # without an impact restitution does not count: the curves of 0, the cheapest, serve all
    groups = [[*_outlines(codes[..., 0], axes, 0.0, directly=True)]]
    groups += [[*_outlines(codes[..., k], axes, eta, directly=False)] for k, eta in enumerate(etas)]
    lines = iter(_shrunk([*chain(*groups)], classify))
    shared, *own = ([*islice(lines, len(group))] for group in groups)
    return [
        _curves([*shared, *mine], eta, classify).assign_attrs(
            pulse=made.name, restitution=float(eta), alpha=float(alpha or 0.0)
        )
        for eta, mine in zip(etas, own, strict=True)
    ]


class _Line(NamedTuple):
    """A polyline around a region of one way of overturning, its code: points (points, 3) just inside and outside."""

    code: int
    inside: Floats
    outside: Floats


def _spaced(low: float, high: float, nodes: int) -> Floats:
    """Nodes from `low` to `high`, as dense as half of them uniform and half of them uniform in the logarithm.

    Near onset the regions are thin in 1/a, under strong pulses in a.
    """
    fine = np.linspace(low, high, 16 * nodes)
    passed = (fine - low) / (high - low) + np.log(fine / low) / np.log(high / low)
    return np.interp(np.linspace(0.0, 2.0, nodes), passed, fine)


def _outlines(codes: Codes, axes: tuple[Floats, Floats], eta: float, *, directly: bool) -> Iterator[_Line]:
    """The lines around the regions of overturning without an impact, or of all others, by the ends of grid edges."""
    ways = np.unique(codes[codes > 0])
    for code in ways[(ways == DIRECTLY) == directly]:
        region = codes == code
        for line in contour_generator(z=region.astype(np.float64), line_type=LineType.Separate).lines(0.5):
            yield _Line(code, *_grid_edges(np.asarray(line), axes, eta, region))


def _grid_edges(
    line: Floats, axes: tuple[Floats, Floats], eta: float, region: NDArray[np.bool_]
) -> tuple[Floats, Floats]:
    """Ends inside and outside the region of the grid edges that the vertices (points, 2) of `line` halve.

    contourpy gives (column, row) in units of the grid; the ends are (1/a, log omega, eta).
    """
    first = np.floor(line[:, ::-1]).astype(int)
    last = np.ceil(line[:, ::-1]).astype(int)
    swap = region[last[:, 0], last[:, 1]][:, None]

    def points(nodes: NDArray[np.int64]) -> Floats:
        return np.stack([axes[0][nodes[:, 0]], axes[1][nodes[:, 1]], np.full(len(nodes), eta)], axis=1)

    return points(np.where(swap, last, first)), points(np.where(swap, first, last))


def _shrunk(lines: Sequence[_Line], classify: Classify) -> list[_Line]:
    """The lines with their points moved to where the fate changes, all at once."""
    if not lines:
        return []
    codes, inside, outside = zip(*lines, strict=True)
    sizes = [len(points) for points in inside]
    found = shrink(np.concatenate(inside), np.concatenate(outside), np.repeat(codes, sizes), classify)
    within, beyond = (np.split(points, np.cumsum(sizes)[:-1]) for points in found)
    return [*map(_Line, codes, within, beyond)]


def _curves(lines: Sequence[_Line], eta: float, classify: Classify) -> xr.Dataset:
    """The lines at one restitution, cut into curves where the fate on their other side changes."""
    sizes = [len(line.inside) for line in lines]
    own = np.repeat(np.array([line.code for line in lines], dtype=np.int64), sizes)
    points = np.concatenate([np.empty((0, 3)), *(line.inside for line in lines)])
    beyond = np.concatenate([np.empty((0, 3)), *(line.outside for line in lines)])
    neighbour, _ = classify(beyond[:, 0], beyond[:, 1], np.asarray(eta))
    starts = _curve_starts(sizes, neighbour)
    return _as_dataset(points, starts, own[starts], neighbour[starts])


def _curve_starts(sizes: list[int], neighbour: Codes) -> NDArray[np.int64]:
    """First points of the curves: where a line begins, and where the fate on its other side changes."""
    new = np.zeros(len(neighbour), dtype=bool)
    new[1:] = np.diff(neighbour) != 0
    new[np.cumsum([0, *sizes])[:-1]] = True
    return np.flatnonzero(new)


def _as_dataset(points: Floats, starts: NDArray[np.int64], own: Codes, neighbour: Codes) -> xr.Dataset:
    def outcome(code: Codes) -> NDArray[np.int8]:
        return np.where(code > 0, code % 4, Outcome.SAFE).astype(np.int8)

    def impacts(code: Codes) -> NDArray[np.int32]:
        return (code // 4).astype(np.int32)

    def curve(values: NDArray[np.int64] | NDArray[np.int32] | NDArray[np.int8], long_name: str) -> tuple[object, ...]:
        return ("curve", values, {"long_name": long_name, "units": "1"})

    sizes = np.diff([*starts, len(points)]).astype(np.int32)
    return xr.Dataset(
        {
            "slenderness": (
                "point",
                points[:, 0],
                {"long_name": "dimensionless slenderness g tan(alpha)/a_g (3.6)", "units": "1"},
            ),
            "frequency_ratio": (
                "point",
                np.exp(points[:, 1]),
                {"long_name": "frequency ratio omega_g/p (3.6)", "units": "1"},
            ),
            "row_size": ("curve", sizes, {"long_name": "points", "units": "1", "sample_dimension": "point"}),
            "outcome": curve(outcome(own), "fate in the region that the curve bounds"),
            "impacts": curve(impacts(own), "impacts before overturning there"),
            "neighbour_outcome": curve(outcome(neighbour), "fate on the other side"),
            "neighbour_impacts": curve(impacts(neighbour), "impacts before overturning on the other side"),
        }
    )
