"""What all figures share: size, type, colours that stay apart for colour-blind eyes, and how they are saved."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from rocking.cube import MODEL_RESULT, describe, write_dataset

WIDTH = 6.7
"""Width of a figure in print [in]."""

BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILION, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7",
)  # fmt: skip
"""Colours of Okabe and Ito (2008)."""

GREY = "#6B6B6B"

mpl.rcParams.update({
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "legend.fontsize": 7,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.1,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "mathtext.fontset": "dejavusans",
    "savefig.dpi": 300,
    "svg.hashsalt": "rocking",  # identifiers inside the file are the same on every run
    "figure.constrained_layout.use": True,
})  # fmt: skip


def shades(count: int) -> list[Any]:
    """`count` colours from dark to light of a perceptually ordered map, without its palest end."""
    return [mpl.colormaps["viridis"](x) for x in np.linspace(0.0, 0.85, count)]


def panel_letters(axes: Sequence[Axes]) -> None:
    """(a), (b), ... above the top left corner of each panel."""
    for letter, ax in zip("abcdefghijkl", axes, strict=False):
        ax.set_title(f"({letter})", loc="left", fontweight="bold")


def plotted(dims: str | Sequence[str], values: ArrayLike, long_name: str, **attributes: Any) -> xr.Variable:
    """A variable of plotted data; dimensionless unless `units` says otherwise."""
    return xr.Variable(dims, np.asarray(values), {**MODEL_RESULT, "long_name": long_name, **attributes})


def make_figure(
    data: Callable[..., xr.Dataset],
    draw: Callable[[xr.Dataset], Figure],
    *,
    svg: Path,
    png: Path,
    nc: Path,
    provenance: Mapping[str, str],
    paper: Mapping[str, Any] | None = None,
    ours: Mapping[str, Any] | None = None,
    **inputs: Any,
) -> None:
    """Compute the plotted data, save them, draw them, save the drawing twice.

    Parameters
    ----------
    data : callable
        Takes the input paths and the configured values by name, returns what is plotted, with `title` and `summary`.
    draw : callable
        Draws that data set and nothing else.
    svg, png, nc : path
        Outputs.
    provenance : mapping
        Digests of the code and settings.
    paper, ours : mapping, optional
        Values that the paper prints, and values that it does not print and that we chose.
    **inputs : path or list of paths
        Data sets to read.
    """
    dataset = data(**inputs, **(paper or {}), **(ours or {}))
    chosen = {"values_chosen_here": ", ".join(ours)} if ours else {}
    write_dataset(describe(dataset, id=nc.stem, history=f"workflow/figures/{nc.stem}", **chosen, **provenance), nc)
    figure = draw(dataset)
    figure.savefig(svg, metadata={"Date": None, "Creator": None})
    figure.savefig(png, metadata={"Software": None})
