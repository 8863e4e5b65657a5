"""The errors of every family in units of the conditioning, and the times of its cells relative to an ordinary cell."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rocking.plot.style import BLACK, BLUE, GREY, STYLE, VERMILION, WIDTH
from stress.speed import SLOW

FLOOR = 1e-3
"""Smaller errors, 0 included, are drawn here [units of the conditioning]."""

SPREAD = 0.28
"""Half the height over which the dots of one family are spread."""


@mpl.rc_context(STYLE)
def draw(parts: Mapping[str, Mapping[str, NDArray[Any]]], path: Path) -> None:
    """Write the figure as .png and .svg: by family (cells,) errors over conditioning, times over an ordinary cell."""
    figure, axes = plt.subplots(1, 2, sharey=True, figsize=(WIDTH, 0.27 * len(parts) + 0.9), width_ratios=(3, 2))
    for row, part in enumerate(parts.values()):
        _strip(axes[0], row, np.maximum(part["error"], FLOOR), part["rigid"])
        _strip(axes[1], row, np.maximum(part["time"], 1e-1), part["rigid"])
    for label, colour in (("slender", BLUE), ("rigid", VERMILION)):
        axes[0].plot([], [], "o", color=colour, markersize=3, label=label)
    axes[0].plot([], [], "|", color=BLACK, markersize=9, markeredgewidth=1.5, label="median")
    for ax in axes:
        ax.axvline(1.0, color=GREY, linewidth=0.8, zorder=0)
        ax.set(xscale="log")
        ax.tick_params(axis="y", length=0)
    axes[0].set(yticks=range(len(parts)), yticklabels=list(parts), ylim=(len(parts) - 0.5, -0.5))
    axes[0].set_xlabel("error of the peak over the effect of one ulp of the input [-]")
    axes[1].set_xlabel("time over the median ordinary cell [-]")
    axes[1].axvline(SLOW, color=GREY, linewidth=0.8, linestyle="--", zorder=0)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    for suffix in (".png", ".svg"):
        figure.savefig(path.with_suffix(suffix), dpi=180)
    plt.close(figure)


def _strip(ax: Axes, row: int, values: NDArray[np.float64], rigid: NDArray[Any]) -> None:
    """Draw one dot per cell in their order, slender above rigid, and the median."""
    for part, centre, colour in ((~rigid, row - 0.16, BLUE), (rigid, row + 0.16, VERMILION)):
        some = values[part & np.isfinite(values)]
        height = centre + SPREAD * (np.arange(len(some)) / max(len(some), 1) - 0.5)
        ax.plot(some, height, ".", color=colour, markersize=2.0, alpha=0.6, rasterized=True)
    known = values[np.isfinite(values)]
    if len(known) > 0:
        ax.plot(np.median(known), row, "|", color=BLACK, markersize=11, markeredgewidth=1.5)
