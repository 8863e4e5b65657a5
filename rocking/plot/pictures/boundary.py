"""Boundary curves of overturning."""

from __future__ import annotations

from typing import Any

import xarray as xr
from matplotlib.axes import Axes

from rocking._base.errors import InvalidArgumentError
from rocking._model.outcome import Outcome
from rocking.plot.boundary_lines import draw_lines, outcome_lines
from rocking.plot.style import BLACK, LABELS, VERMILION, axes_of, plain_numbers

_REGIONS = (
    (Outcome.OVERTURNED_AFTER_IMPACT, VERMILION, "overturns after impacts"),
    (Outcome.OVERTURNED_DIRECTLY, BLACK, "overturns without impact"),
)


def boundary(data: xr.Dataset, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the boundaries between survival and overturning: amplitude, logarithmic, against frequency ratio or period.

    A block overturns without impact above the black lines, after impacts inside the coloured ones. The outlines of
    regions of more than one impact are thin.

    Parameters
    ----------
    data : xarray.Dataset
        Curves of one angle: result of `rocking.overturning_boundary`, or of a file of the workflow. Curves in SI units
        (`Block.boundary`) are drawn over the period, as peak ground accelerations.
    ax : matplotlib.axes.Axes, optional
        Where to draw, for instance over `control_map`; by default in a new figure.
    **style
        Properties of the lines, which replace those of both regions; with one `color` for both there is no legend.
    """
    if "row_size" not in data or "neighbour_outcome" not in data:
        raise InvalidArgumentError("data", sorted(map(str, data)), "boundary curves of overturning")
    ax = axes_of(ax)
    in_si = "peak_acceleration" in data
    for outcome, colour, label in _REGIONS:
        lines = outcome_lines(_of_outcome(data, outcome))
        if not lines.amplitude.size:
            continue
        x, y = lines.frequency_ratio, lines.amplitude
        if in_si:
            # both products are constant along the curves of one block
            x = float(data["period"][0] * data["frequency_ratio"][0]) / x if data.sizes["point"] else x
            y = float(data["peak_acceleration"][0] * data["slenderness"][0]) * y if data.sizes["point"] else y
        shown: dict[str, Any] = {"linewidth": 1.1, "color": colour, "label": label}
        draw_lines(ax, x, y, lines, **(shown | style))
    plain_numbers(ax, "y")
    if in_si:
        plain_numbers(ax, "x")
    if "color" not in style and ax.lines:
        ax.legend()
    ax.set_xlabel(f"{LABELS['period']} [s]" if in_si else f"{LABELS['frequency_ratio']} [-]")
    ax.set_ylabel(f"{LABELS['peak_acceleration']} [m/s$^2$]" if in_si else f"{LABELS['amplitude']} [-]")
    return ax


def _of_outcome(data: xr.Dataset, outcome: Outcome) -> xr.Dataset:
    """The curves that bound regions of one way of overturning."""
    wanted = data["outcome"].values == outcome
    return data.isel(curve=wanted, point=wanted.repeat(data["row_size"].values))
