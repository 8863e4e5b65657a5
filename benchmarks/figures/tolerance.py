"""Errors over the requested tolerance: one dot per cell, quantiles as lines."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

from rocking.plot.style import BLACK, BLUE, GREY, STYLE, VERMILION, WIDTH

MIN_ERROR = 1e-17
"""Errors of 0 are drawn here."""

DOT_SPREAD = 0.6
"""Share of the distance between two tolerances over which the dots of one are spread."""


@mpl.rc_context(STYLE)
def draw(tolerances: NDArray[np.float64], errors: NDArray[np.float64], path: Path) -> None:
    """Write the figure of relative errors (tolerances, cells), nan where a block overturns."""
    figure, ax = plt.subplots(figsize=(WIDTH, 0.6 * WIDTH))
    drawn = np.maximum(errors, MIN_ERROR)
    offsets = np.linspace(-0.5, 0.5, errors.shape[1]) * DOT_SPREAD
    for tolerance, row in zip(tolerances, drawn, strict=True):
        ax.plot(tolerance * 10.0**offsets, row, ".", color=GREY, markersize=1.0, alpha=0.5, rasterized=True)
    for share, label in ((0.5, "median"), (0.99, "99 %"), (1.0, "largest")):
        style = {0.5: ":", 0.99: "--", 1.0: "-"}[share]
        ax.plot(tolerances, np.nanquantile(drawn, share, axis=1), style, color=BLUE, label=f"{label} of the cells")
    ends = np.array([tolerances.min() / 3.0, tolerances.max() * 3.0])
    ax.plot(ends, ends, color=BLACK, label="error = tolerance")
    ax.plot(ends, 10.0 * ends, color=VERMILION, label="error = 10 tolerance")
    ax.set(xscale="log", yscale="log", xlim=ends[::-1], ylim=(MIN_ERROR / 3.0, 1e-2))
    ax.set(xlabel="requested tolerance [-]", ylabel="relative error of the peak [-]")
    ax.legend(loc="upper right")
    figure.savefig(path)
    plt.close(figure)
