"""Fragility curves of each block of a suite: observed fractions with intervals, fitted curves, first exceedance."""

import math
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking._datasets.cube import read_dataset
from rocking.plot.pictures.fragility import CURVES, POINTS, draw_fractions
from rocking.plot.style import WIDTH
from rocking.suites.curve import curve_probability
from workflow.figures.style import panel_letters, plotted
from workflow.figures.suite_outcomes import block_title, intensity_label

COLUMNS = 3  # panels in a row


def data(*, fragility: Path) -> xr.Dataset:
    """Counts and curves of the first limit state of a suite."""
    given = read_dataset(fragility).isel(demand=0)
    levels = given.intensity.values
    fine = np.geomspace(levels[0], levels[-1], POINTS)
    curves = [
        [
            curve_probability(
                model, fine, *(float(given[name].sel(model=model)[k]) for name in ("median_intensity", "dispersion"))
            )
            for k in range(given.sizes["block"])
        ]
        for model in given.model.values.tolist()
    ]
    names = ("fraction", "fraction_lower", "fraction_upper", "first_fraction")
    shown = given[[*names, "median_intensity", "median_intensity_lower", "median_intensity_upper", "dispersion"]]
    shown = shown.drop_vars([name for name in shown.coords if shown[name].dims == ("record",)])
    return shown.assign(
        curve=plotted(("model", "block", "fine_intensity"), curves, "probability of the fitted curve"),
        fine_intensity=plotted("fine_intensity", fine, given.intensity.long_name, units=given.intensity.units),
    ).assign_attrs(
        title=f"Fragility curves of the suite {given.attrs['suite']}, limit state {given.demand.item()}",
        summary="Fraction of records with binomial interval at each level, curves fitted by maximum likelihood, and "
        "the curve of first exceedance for comparison.",
        measure=given.attrs["measure"],
        confidence=given.attrs["confidence"],
    )


def draw(data: xr.Dataset) -> Figure:
    """One panel per block."""
    blocks = data.sizes["block"]
    rows = math.ceil(blocks / COLUMNS)
    figure = Figure(figsize=(WIDTH, 0.4 + 2.2 * rows))
    axes = figure.subplots(rows, min(blocks, COLUMNS), sharex=True, sharey=True, squeeze=False)
    for k, ax in enumerate(axes.flat):
        if k < blocks:
            _panel(ax, data.isel(block=k))
            ax.set_title(block_title(data, k), loc="right")
        else:
            ax.set_axis_off()
    panel_letters([*axes.flat][:blocks])
    for ax in axes[-1]:
        ax.set_xlabel(intensity_label(data))
    for ax in axes[:, 0]:
        ax.set_ylabel(f"probability of {data.demand.item()} [-]")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4)
    return figure


def _panel(ax: Axes, data: xr.Dataset) -> None:
    draw_fractions(ax, data)
    for model, (colour, line) in CURVES.items():
        ax.plot(data.fine_intensity, data.curve.sel(model=model), line, color=colour, label=model)
