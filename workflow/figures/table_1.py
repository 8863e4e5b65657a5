"""Table 1: products of the unit orientations, computed from Siano's rules (4.4) and (4.5)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking.paper.orientation import Orientation, multiplication_table
from workflow.figures.style import plotted


def data() -> xr.Dataset:
    """The table as indices of l_0, l_x, l_y, l_z."""
    order = list(Orientation)
    table = np.array([[order.index(product) for product in row] for row in multiplication_table()], dtype=np.int8)
    flags = {"flag_values": np.arange(len(order), dtype=np.int8), "flag_meanings": "l_0 l_x l_y l_z"}
    element = plotted("left", np.arange(len(order), dtype=np.int8), "left factor", **flags)
    return xr.Dataset(
        {"product": plotted(("left", "right"), table, "product of unit orientations", equation="4.4", **flags)},
        coords={"left": element, "right": plotted("right", element.values, "right factor", **flags)},
        attrs={
            "title": "Multiplication table of the unit orientations",
            "summary": "Row times column in the group of Siano (1985), a Klein four-group.",
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """The table, row times column."""
    symbols = ["$l_0$", "$l_x$", "$l_y$", "$l_z$"]
    figure = Figure(figsize=(2.6, 1.5))
    ax = figure.subplots()
    ax.set_axis_off()
    cells = [[symbols[int(k)] for k in row] for row in data["product"].values]
    # the row heads are cells of a first column: those of Matplotlib have a width of their own
    rows = [["", *symbols], *([symbol, *row] for symbol, row in zip(symbols, cells, strict=True))]
    table = ax.table(rows, cellLoc="center", bbox=(0.0, 0.0, 1.0, 1.0))
    for (row, column), cell in table.get_celld().items():
        cell.set_linewidth(0.4)
        if (row == 0) != (column == 0):
            cell.set_facecolor("#E4EEF6")
    table[0, 0].set_linewidth(0.0)
    return figure
