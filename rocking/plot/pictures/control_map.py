"""Maps of the control space: peak rotation and outcome over amplitude and frequency, and the cubes they come from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.patches import Patch
from numpy.typing import NDArray

from rocking._base.errors import InvalidArgumentError
from rocking._model.outcome import Outcome
from rocking.plot.style import LABELS, axes_of, label_of, plain_numbers

_COLOURS = {
    Outcome.NO_UPLIFT: ("#FFFFFF", "never uplifts"),
    Outcome.OVERTURNED_AFTER_IMPACT: ("#9A9A9A", "overturns after impacts"),
    Outcome.OVERTURNED_DIRECTLY: ("#4A4A4A", "overturns without impact"),
}
"""Colours of the outcomes without a peak rotation, and their meaning in few words."""

_PEAKS = "viridis_r"


def control_map(data: xr.Dataset, ax: Axes | None = None, *, key: bool = True) -> Axes:
    """Draw a map: peak rotation as a colour, overturning in greys, amplitude on a logarithmic axis.

    Parameters
    ----------
    data : xarray.Dataset
        `peak_rotation` and `outcome` along two dimensions with coordinates: one angle of a spectrum cube, or
        `rocking.Response.to_xarray()` of a grid. A `slenderness` 1/a is drawn as the amplitude a.
    ax : matplotlib.axes.Axes, optional
        Where to draw; by default in a new figure.
    key : bool
        Whether to add the colour bar and the meaning of the greys that are in the map.
    """
    if "peak_rotation" not in data or data["peak_rotation"].ndim != 2:
        raise InvalidArgumentError("data", dict(data.sizes), "peak_rotation and outcome along two dimensions")
    ax = axes_of(ax)
    rows, columns = (data[str(dim)] for dim in data["peak_rotation"].dims)
    if rows.name in ("frequency_ratio", "period"):
        rows, columns = columns, rows
        data = data.transpose(rows.name, columns.name)
    y, label = rows.values, label_of(rows)
    if rows.name == "slenderness":
        y, label = 1.0 / y, f"{LABELS['amplitude']} [-]"
    outcome = data["outcome"].values
    without_peak = np.isin(outcome, list(_COLOURS))
    peak = np.ma.masked_where(without_peak, data["peak_rotation"].values)
    options: dict[str, Any] = {"shading": "nearest", "rasterized": True}
    ax.pcolormesh(columns.values, y, peak, cmap=_PEAKS, vmin=0.0, vmax=1.0, **options)
    classes = np.ma.masked_where(~without_peak, np.searchsorted(list(_COLOURS), outcome, sorter=_ORDER))
    ax.pcolormesh(columns.values, y, classes, cmap=_CLASSES, vmin=-0.5, vmax=len(_COLOURS) - 0.5, **options)
    plain_numbers(ax, "y")
    if columns.name == "period":
        plain_numbers(ax, "x")
    ax.set_xlabel(label_of(columns))
    ax.set_ylabel(label)
    if key:
        _add_key([ax], outcome)
    return ax


_ORDER = np.argsort(list(_COLOURS))
_CLASSES = ListedColormap([_COLOURS[outcome][0] for outcome in sorted(_COLOURS)])


def cube(data: xr.Dataset, axes: Sequence[Axes] | None = None) -> Sequence[Axes]:
    """Draw the map of each slenderness angle of a spectrum cube.

    Parameters
    ----------
    data : xarray.Dataset
        A spectrum cube, results/spectra/PULSE/eta-0.85.nc, or some of its angles.
    axes : sequence of matplotlib.axes.Axes, optional
        One for each angle, in one figure; by default a row in a new figure.
    """
    if "alpha" not in data.dims or "peak_rotation" not in data:
        raise InvalidArgumentError("data", dict(data.sizes), "a spectrum cube with the dimension alpha")
    angles = data["alpha"].values
    if axes is None:
        figure = plt.figure(figsize=(1.2 + 2.8 * angles.size, 3.4), layout="constrained")
        axes = figure.subplots(1, angles.size, sharex=True, sharey=True, squeeze=False)[0].tolist()
    if len(axes) != angles.size:
        raise InvalidArgumentError("axes", len(axes), f"one for each of {angles.size} angles")
    for k, ax in enumerate(axes):
        control_map(data.isel(alpha=k), ax, key=False)
        ax.set_title(f"alpha = {np.degrees(angles[k]):.3g} deg" if angles[k] else "slender limit", loc="right")
        ax.label_outer()
    _add_key(list(axes), data["outcome"].values)
    return axes


def _add_key(axes: list[Axes], outcome: NDArray[Any]) -> None:
    """Add the colour bar, and a legend of those classes that are among the outcomes."""
    figure = axes[0].figure
    figure.colorbar(
        ScalarMappable(Normalize(0.0, 1.0), _PEAKS), ax=axes, extend="max",
        label=r"peak rotation $\theta_{\max}/\alpha$ [-]",
    )  # fmt: skip
    handles = [
        Patch(facecolor=colour, edgecolor="#808080", linewidth=0.5, label=meaning)
        for kind, (colour, meaning) in _COLOURS.items()
        if (outcome == kind).any()
    ]
    if not handles:
        return
    # compact, so that it fits a figure of 5.6 inches
    spacing = {"handlelength": 1.2, "handletextpad": 0.5, "columnspacing": 1.2}
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), **spacing)
