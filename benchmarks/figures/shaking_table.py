"""Outcomes of tests on a shaking table, and where the planar block has others."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd


def draw(table: pd.DataFrame, path: Path) -> None:
    """Write a picture of all tests in the plane of PGV and PGA; columns as in benchmarks.accuracy.shaking_table."""
    groups = table.groupby("specimen")
    figure, axes = plt.subplots(1, len(groups), figsize=(9.0, 4.2), sharey=True, layout="constrained")
    for ax, (specimen, tests) in zip(axes, groups, strict=True):
        wrong = tests["predicted"] != tests["overturned"]
        for chosen, size, face, edge, label in (
            (~tests["overturned"], 14, "none", "C0", "stands"),
            (tests["overturned"], 14, "C0", "C0", "overturns"),
            (wrong, 60, "none", "C3", "predicted otherwise"),
        ):
            at = tests[chosen]
            ax.scatter(at["peak_velocity"], at["peak_acceleration"], size, facecolor=face, edgecolor=edge, label=label)
        ax.set(xscale="log", yscale="log", xlabel="PGV [m/s]", title=f"specimen {specimen}")
    axes[0].set_ylabel("PGA [m/s2]")
    axes[0].legend()
    figure.savefig(path, dpi=100)
    plt.close(figure)
