"""Outcomes of tests on a shaking table, and checks by standards, beside those of the planar block."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

BINS = np.geomspace(0.05, 20.0, 41)


def draw_checks(table: pd.DataFrame, clauses: Iterable[str], path: Path) -> None:
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


def draw_tests(table: pd.DataFrame, path: Path) -> None:
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
