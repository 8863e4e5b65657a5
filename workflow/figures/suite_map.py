"""Probability of overturning over size and slenderness, at one level of intensity."""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking._datasets.cube import read_dataset
from rocking.plot.style import UNITS
from workflow.figures.style import plotted


def data(*, outcomes: Path) -> xr.Dataset:
    """The fraction of the records that overturn each block of the map, from `map_overturned`."""
    given = read_dataset(outcomes)
    overturned = given.map_overturned
    probability = plotted(
        ("map_half_diagonal", "map_alpha"), overturned.mean("record"), "fraction of records that overturn the block"
    )
    return xr.Dataset(
        {"probability": probability},
        {name: given[name] for name in ("map_half_diagonal", "map_alpha")},
        {
            "title": f"Probability of overturning under the suite {given.attrs['suite']}",
            "summary": "Fraction of the records that overturn a block, over its half diagonal and its slenderness "
            "angle, at one level of intensity.",
            "records": given.sizes["record"],
            "intensity": overturned.attrs["intensity"],
            "intensity_units": given.intensity.units,
            "measure": given.intensity.long_name,
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """A map."""
    figure = Figure(figsize=(4.4, 3.2))
    ax = figure.subplots()
    angle = np.degrees(data.map_alpha.values)
    mesh = ax.pcolormesh(
        angle, data.map_half_diagonal, data.probability, cmap="viridis_r", vmin=0.0, vmax=1.0, shading="nearest"
    )
    ax.set_xlabel(r"slenderness angle $\alpha$ [deg]")
    ax.set_ylabel(r"half diagonal $R$ [m]")
    unit = UNITS[data.attrs["intensity_units"]]
    ax.set_title(f"{data.attrs['measure']} {data.attrs['intensity']:g} {unit}, {data.attrs['records']} records")
    figure.colorbar(mesh, ax=ax, label="fraction that overturn [-]")
    return figure
