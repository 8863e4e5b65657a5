"""Layers of overturning after many impacts under the pulse c2: `python -m benchmarks.figures.layers docs/layers.png`.

Each panel enlarges the frame in the one before it.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

import rocking
from benchmarks.measure import arguments
from rocking.plot.style import STYLE, WIDTH
from workflow.figures.style import panel_letters

WINDOWS = (
    (0.3, 2.6, 0.86, 0.97),
    (0.5, 0.6, 0.92, 0.95),
    (0.55, 0.555, 0.9375, 0.9390),
    (0.5520, 0.5522, 0.9382, 0.9388),
)
"""Ranges of the frequency ratio and of 1/a [-]."""

NODES, MOST = 500, 90
"""Blocks in each direction; the colour stays the same after more impacts than this."""


@mpl.rc_context(STYLE)
def draw(path: Path) -> None:
    """Write the figure."""
    figure, panels = plt.subplots(2, 2, figsize=(WIDTH, 0.8 * WIDTH), layout="constrained")
    for ax, (left, right, bottom, top), frame in zip(panels.flat, WINDOWS, (*WINDOWS[1:], None), strict=True):
        omega, slenderness = np.linspace(left, right, NODES), np.linspace(bottom, top, NODES)
        found = rocking.peak_response("c2", slenderness=slenderness[:, None], frequency_ratio=omega, restitution=0.85)
        impacts = np.where(found.overturned, np.minimum(found.impacts, MOST), np.nan)
        shown = ax.pcolormesh(omega, slenderness, impacts, cmap="viridis", vmin=0, vmax=MOST, rasterized=True)
        ax.set(xlabel=r"$\omega_g/p$", ylabel=r"$1/a$")
        ax.ticklabel_format(useOffset=False)
        ax.locator_params(axis="x", nbins=4)
        if frame:
            ax.plot(np.take(frame, (0, 1, 1, 0, 0)), np.take(frame, (2, 2, 3, 3, 2)), color="red")
    figure.colorbar(shown, ax=panels, label="impacts before overturning; white: survives")
    panel_letters(list(panels.flat))
    figure.savefig(path)
    plt.close(figure)


if __name__ == "__main__":
    draw(arguments(__doc__, path=Path).path)
