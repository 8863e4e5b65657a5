"""Demand over capacity by checks of standards, of bodies that overturn and of others."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

BINS = np.geomspace(0.05, 20.0, 41)


def draw(table: pd.DataFrame, clauses: Iterable[str], path: Path) -> None:
    """Write one histogram a clause; columns as in benchmarks.accuracy.standards."""
    names = list(clauses)
    figure, axes = plt.subplots(len(names), 1, figsize=(7.0, 1.5 * len(names)), sharex=True, layout="constrained")
    for ax, name in zip(axes, names, strict=True):
        groups = [table[name][table["overturned"] == fell].clip(BINS[0], BINS[-1]) for fell in (False, True)]
        ax.hist(groups, BINS, stacked=True, color=["C0", "C3"], label=["does not overturn", "overturns"])
        ax.axvline(1.0, color="black")
        ax.set(xscale="log", yticks=[], ylabel=name)
    axes[0].legend()
    axes[-1].set_xlabel("demand over capacity; the check passes left of 1")
    figure.savefig(path, dpi=100)
    plt.close(figure)
