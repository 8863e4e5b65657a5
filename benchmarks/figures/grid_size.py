"""Interpolation errors over the size of the grid, file size over error, and the share of points a cube can answer."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from rocking.plot.style import BLACK, BLUE, GREY, VERMILION, WIDTH
from workflow.figures.style import panel_letters

SCHEMES = {"linear": ("linear", VERMILION), "package": ("rocking", BLUE)}
SHARES = {"0.5": ("-", "50 %"), "0.9": ("--", "90 %")}
BOUNDS = {"1e-04": ("$10^{-4}$", BLACK), "1e-06": ("$10^{-6}$", GREY)}
SLENDER: dict[str, Any] = {"marker": "o", "markersize": 3.5}
RIGID: dict[str, Any] = {"marker": "s", "markersize": 6, "markerfacecolor": "none", "linestyle": "", "linewidth": 0.7}


def draw(record: dict[str, Any], paths: list[Path]) -> None:
    """Write the figure of a record of `benchmarks.accuracy.grid_size`; the grid of paper.yaml is marked."""
    grids = record["grids"]
    nodes = np.array([row["nodes"][0] * row["nodes"][1] for row in grids])
    size = np.array([row["bytes"] for row in grids])
    default = [row["scale"] for row in grids].index(1.0) if any(row["scale"] == 1.0 for row in grids) else None
    figure, (errors, bytes_, shares) = plt.subplots(1, 3, figsize=(WIDTH, 0.45 * WIDTH))
    slender, rigid = ([row["alpha_deg"][angle] for row in grids] for angle in ("0", "20"))
    for scheme, (name, color) in SCHEMES.items():
        for share, (line, cells) in SHARES.items():
            kept = [one[scheme]["error"][share] for one in slender]
            style = {"color": color, "linestyle": line, **SLENDER}
            errors.plot(nodes, kept, label=f"{name}, {cells} of points", **style)
            bytes_.plot(kept, size, **style)
            kept = [one[scheme]["error"][share] for one in rigid]
            errors.plot(nodes, kept, color=color, **RIGID)
            bytes_.plot(kept, size, color=color, **RIGID)
    for limit, (name, color) in BOUNDS.items():
        share_of = [[100.0 * one["package"]["within"][limit] for one in found] for found in (slender, rigid)]
        shares.plot(nodes, share_of[0], color=color, label=f"within {name}, slender", **SLENDER)
        shares.plot(nodes, share_of[1], color=color, label=f"within {name}, 20°", **RIGID)
    if default is not None:
        for ax in (errors, shares):
            ax.axvline(nodes[default], color=GREY, linewidth=0.6, linestyle=":")
        bytes_.axhline(size[default], color=GREY, linewidth=0.6, linestyle=":")
        errors.annotate("paper.yaml", (nodes[default], 0.97), xycoords=("data", "axes fraction"), fontsize=7, ha="left")
    error = "error of the peak [-]"
    errors.set(xscale="log", yscale="log", xlabel="nodes of a layer", ylabel=error)
    bytes_.set(xscale="log", yscale="log", xlabel=error, ylabel="bytes of a layer in its file [B]")
    bytes_.invert_xaxis()
    shares.set(xscale="log", xlabel="nodes of a layer", ylabel="points that the cube answers [%]", ylim=(0.0, 100.0))
    errors.legend(loc="lower left")
    errors.set_ylim(bottom=1e-13)
    shares.legend(loc="lower right")
    panel_letters([errors, bytes_, shares])
    for path in paths:
        figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
    plt.close(figure)
