"""Run time against error, four diagrams: `python -m benchmarks.figures.work_precision FOLDER` of their records."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from benchmarks.measure import arguments, spread
from benchmarks.tables import DIAGRAMS
from rocking.plot.style import BLACK, BLUE, VERMILION, WIDTH
from workflow.figures.style import panel_letters

ORANGE, SKY, PURPLE = "#E69F00", "#56B4E9", "#CC79A7"
STYLES: dict[str, dict[str, Any]] = {
    "rocking": {"color": BLACK, "marker": "*", "markersize": 7, "linewidth": 1.6},
    "heyoka": {"color": BLUE, "marker": "o"},
    "RK4, fixed steps": {"color": VERMILION, "marker": "^"},
    "scipy RK45": {"color": ORANGE, "marker": "v"},
    "scipy DOP853": {"color": PURPLE, "marker": "s"},
    "scipy LSODA": {"color": PURPLE, "marker": "D", "linestyle": "--"},
    "scipy Radau": {"color": SKY, "marker": "p"},
}
MEASURES = {"error_99": "99 % quantile of the relative error [-]", "median_error": "median relative error [-]"}


def panel(ax: Axes, record: dict[str, Any], measure: str) -> None:
    """Draw one diagram: median time over error, bars over the rounds; hollow markers have wrong outcomes."""
    for name, rows in record["methods"].items():
        style: dict[str, Any] = {"markersize": 4, **STYLES[name]}
        error = np.array([row[measure] for row in rows])
        times = [spread(row["us"]) for row in rows]
        middle = np.array([time["median"] for time in times])
        bars = [middle - [time["smallest"] for time in times], [time["largest"] for time in times] - middle]
        ax.errorbar(error, middle, bars, label=name, capsize=1.5, elinewidth=0.7, **style)
        wrong = np.array([row["wrong_outcomes"] > 0 for row in rows])
        hollow = {"linestyle": "", "markerfacecolor": "white", "zorder": 5}
        ax.plot(error[wrong], middle[wrong], **{**style, **hollow})
    kind, pulse = record["diagram"].split("-")
    names = {"slender": "slender block", "rigid": "rigid block, 20°", "sine": "one sine", "ricker": "Ricker wavelet"}
    ax.set_title(f"{names[kind]}, {names[pulse]}")
    ax.set(xscale="log", yscale="log", xlim=(1e0, 1e-16), ylim=(0.03, 5e4))
    ax.grid(visible=True, which="major", linewidth=0.3, alpha=0.5)


def draw(records: list[dict[str, Any]], measure: str, path: Path) -> None:
    """Draw four panels, slender blocks in the upper row."""
    figure, axes = plt.subplots(2, 2, figsize=(WIDTH, 1.05 * WIDTH), sharex=True, sharey=True, layout="constrained")
    for ax, record in zip(axes.flat, records, strict=True):
        panel(ax, record, measure)
    panel_letters(list(axes.flat))
    figure.supxlabel(MEASURES[measure], size="medium")
    figure.supylabel("processor time of a cell, one core [µs]", size="medium")
    handles, labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4)
    figure.savefig(path)
    plt.close(figure)


if __name__ == "__main__":
    folder = arguments(__doc__, folder=Path).folder
    measured = [json.loads((folder / f"work-precision-{name}.json").read_text()) for name in DIAGRAMS]
    for error in MEASURES:
        draw(measured, error, folder / f"work-precision-{error}.png")
