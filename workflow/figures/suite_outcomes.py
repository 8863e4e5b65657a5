"""Outcome of each record at each level, for each block of a suite."""

import math
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from rocking._datasets.cube import read_dataset
from rocking.plot.style import WIDTH, label_of, plain_numbers, shades
from workflow.figures.style import panel_letters, plotted

CLASSES = ("no uplift", "rotation below alpha/2", "below alpha", "above alpha, survives", "overturns")
"""What the colours stand for."""


def data(*, outcomes: Path) -> xr.Dataset:
    """The class of each outcome; the records in the order of the lowest level at which any block overturns."""
    given = read_dataset(outcomes)
    peak, overturned = given.peak_rotation.values, given.overturned.values.astype(bool)
    code = np.select([overturned, peak > 1.0, peak > 0.5, peak > 0.0], [4, 3, 2, 1], 0).astype(np.int8)
    first = np.where(overturned.any(axis=1), overturned.argmax(axis=1), overturned.shape[1]).min(axis=0)
    order = np.argsort(first, kind="stable")
    about = {"flag_values": np.arange(len(CLASSES), dtype=np.int8), "flag_meanings": " ".join(map(_flag, CLASSES))}
    variable = plotted(("block", "intensity", "record"), code, "class of the outcome", **about)
    sizes = given[["width", "height", "intensity", "record"]].reset_coords(["width", "height"])
    return (
        sizes.assign(outcome_class=variable)
        .isel(record=order)
        .assign_attrs(
            title=f"Outcomes of the suite {given.attrs['suite']} by record and level",
            summary="Class of the outcome of each block under each record at each level of intensity.",
            measure=given.attrs["measure"],
        )
    )


def draw(data: xr.Dataset) -> Figure:
    """One panel per block, a row per record."""
    blocks, records = data.sizes["block"], data.sizes["record"]
    figure = Figure(figsize=(WIDTH, 0.9 + blocks * max(0.9, min(4.0, 0.14 * records))))
    axes = figure.subplots(blocks, 1, sharex=True, squeeze=False)[:, 0]
    colours = ListedColormap(["#FFFFFF", *shades(4)[::-1]])
    norm = BoundaryNorm(np.arange(len(CLASSES) + 1) - 0.5, len(CLASSES))
    for k, ax in enumerate(axes):
        mesh = _panel(ax, data.isel(block=k), colours, norm)
        ax.set_title(block_title(data, k), loc="right")
    axes[-1].set_xlabel(intensity_label(data))
    bar = figure.colorbar(mesh, ax=axes, location="top", ticks=np.arange(len(CLASSES)), aspect=60, pad=0.02)
    bar.ax.set_xticklabels(CLASSES)
    panel_letters(axes)
    return figure


def _panel(ax: Axes, data: xr.Dataset, colours: ListedColormap, norm: BoundaryNorm) -> object:
    levels = np.log(data.intensity.values)
    between = 0.5 * (levels[1:] + levels[:-1])
    ends = [1.5 * levels[0] - 0.5 * levels[1], 1.5 * levels[-1] - 0.5 * levels[-2]] if levels.size > 1 else [-0.1, 0.1]
    edges = np.exp(np.array([ends[0], *between, ends[1]]) + (levels[0] if levels.size == 1 else 0.0))
    rows = np.arange(data.sizes["record"] + 1) - 0.5
    mesh = ax.pcolormesh(edges, rows, data.outcome_class.values.T, cmap=colours, norm=norm)
    plain_numbers(ax, "x")
    step = math.ceil(data.sizes["record"] / 30)
    ax.set_yticks(np.arange(0, data.sizes["record"], step), data.record.values[::step], fontsize=6)
    ax.invert_yaxis()
    return mesh


def block_title(data: xr.Dataset, k: int) -> str:
    """Width and height of a block in metres."""
    return f"{float(data.width[k]):g} m x {float(data.height[k]):g} m"


def intensity_label(data: xr.Dataset) -> str:
    """The measure with its unit, for an axis."""
    return label_of(data.intensity)


def _flag(text: str) -> str:
    return text.replace(" ", "_").replace(",", "").replace("/", "_over_")
