"""Peaks at the nodes of a grid, the exact peaks between them, and the cells that are left to the solver."""

import matplotlib.pyplot as plt
import numpy as np

import rocking
from rocking.plot.style import BLUE, GREY, VERMILION

groups = {"frequency_ratio": 3.0, "restitution": 0.85}
exact = rocking.peak_response("sine", slenderness=(line := np.linspace(0.5, 0.9, 2000)), **groups)
found = rocking.peak_response("sine", slenderness=(nodes := np.linspace(0.5, 0.9, 25)), **groups)

figure, ax = plt.subplots(figsize=(7.0, 3.2), layout="constrained")
ax.plot(line, np.where(exact.overturned, np.nan, exact.peak_rotation), color=BLUE, label="exact, survives")
stays = ~found.overturned
ax.plot(nodes[stays], found.peak_rotation[stays], "o", color="black", markersize=4, label="node, survives")
ax.plot(nodes[~stays], np.full((~stays).sum(), 1.15), "x", color=GREY, label="node, overturns")
for left in np.flatnonzero(stays[:-1] != stays[1:]):
    ax.axvspan(nodes[left], nodes[left + 2], color=VERMILION, alpha=0.2, linewidth=0.0)
ax.set(xlabel="slenderness 1/a [-]", ylabel="peak rotation over alpha [-]", ylim=(0.0, 1.2))
ax.legend()
