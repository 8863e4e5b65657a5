"""The curves on the control space that separate the fates, found with the solver itself.

The way of overturning (directly, after one impact, after three, ...) is computed on a grid; the outline of the region
of each way is followed by contourpy, and every vertex, which lies on a grid edge with the region at one end only, is
moved along that edge to where the fate changes. So the grid decides which regions are seen, never where they end; and a
safe band far narrower than a cell still shows, as the gap between the outlines on its two sides.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from contourpy import LineType, contour_generator
from numpy.typing import NDArray

from rocking.boundary_points import Codes, Floats, classifier, shrink
from rocking.errors import in_range
from rocking.pulses import AbstractPulse
from rocking.response import Outcome
from rocking.solve import as_pulse


def overturning_boundary(
    pulse: str | AbstractPulse,
    *,
    restitution: float,
    alpha: float | None = None,
    frequency_ratio: tuple[float, float] = (0.2, 15.0),
    slenderness: tuple[float, float] = (0.02, 1.0),
    nodes: int = 401,
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
    """
    in_range("nodes", nodes, 16, 4001)
    low, high = (float(in_range("frequency_ratio", x, 0.0, np.inf, closed="neither")) for x in frequency_ratio)
    in_range("frequency_ratio[1]", high, low, np.inf, closed="neither")
    bottom, top = (float(in_range("slenderness", x, 0.0, 1.0, closed="right")) for x in slenderness)
    in_range("slenderness[1]", top, bottom, 1.0, closed="right")
    made = as_pulse(pulse)
    classify = classifier(made, restitution, alpha)
    axes = _spaced(bottom, top, int(nodes)), np.linspace(np.log(low), np.log(high), int(nodes))
    codes, _ = classify(*np.meshgrid(*axes, indexing="ij"))

    inside, outside, sizes, own = [np.empty((0, 2))], [np.empty((0, 2))], [], [np.empty(0, np.int64)]
    for code in np.unique(codes[codes > 0]):
        region = codes == code
        for line in contour_generator(z=region.astype(np.float64), line_type=LineType.Separate).lines(0.5):
            within, beyond = _grid_edges(np.asarray(line), axes, region)
            inside.append(within)
            outside.append(beyond)
            own.append(np.full(len(within), code))
            sizes.append(len(within))
    code = np.concatenate(own)
    points, beyond = shrink(np.concatenate(inside), np.concatenate(outside), code, classify)
    neighbour, _ = classify(beyond[:, 0], beyond[:, 1])
    starts = _curve_starts(sizes, neighbour)
    return _as_dataset(points, starts, code[starts], neighbour[starts]).assign_attrs(
        pulse=made.name, restitution=float(restitution), alpha=float(alpha or 0.0)
    )


def _spaced(low: float, high: float, nodes: int) -> Floats:
    """Nodes from `low` to `high`, as dense as half of them uniform and half of them uniform in the logarithm.

    Near onset the regions are thin in 1/a, under strong pulses in a.
    """
    fine = np.linspace(low, high, 16 * nodes)
    passed = (fine - low) / (high - low) + np.log(fine / low) / np.log(high / low)
    return np.interp(np.linspace(0.0, 2.0, nodes), passed, fine)


def _grid_edges(line: Floats, axes: tuple[Floats, Floats], region: NDArray[np.bool_]) -> tuple[Floats, Floats]:
    """Ends inside and outside the region of the grid edges that the vertices (points, 2) of `line` halve.

    contourpy gives (column, row) in units of the grid; the ends are (1/a, log omega).
    """
    first = np.floor(line[:, ::-1]).astype(int)
    last = np.ceil(line[:, ::-1]).astype(int)
    swap = region[last[:, 0], last[:, 1]][:, None]
    within, beyond = np.where(swap, last, first), np.where(swap, first, last)
    return (
        np.stack([axes[0][within[:, 0]], axes[1][within[:, 1]]], axis=1),
        np.stack([axes[0][beyond[:, 0]], axes[1][beyond[:, 1]]], axis=1),
    )


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
