"""Run time of other integrators over that of the package, read from the tables of the page `benchmarks.md`."""

import re
from pathlib import Path

import matplotlib.pyplot as plt

from rocking.plot.style import BLUE, VERMILION

ERRORS = (1e-3, 1e-6, 1e-9, 1e-12)
sections = Path("../benchmarks.md").read_text(encoding="utf-8").split("Time of the fastest baseline over")[1]
best, scipy = re.split(r"\nThe fastest method of SciPy", sections)[:2]

figure, axes = plt.subplots(1, 2, figsize=(7.0, 3.2), sharey=True, layout="constrained")
for ax, table, title in zip(axes, (best, scipy), ("fastest other integrator", "fastest method of SciPy"), strict=True):
    for name, color in (("slender", BLUE), ("rigid", VERMILION)):
        for pulse, marker in (("sine", "o"), ("wavelet", "s")):
            cells = re.search(rf"^\| {name}, {pulse} \|(.*)\|$", table, re.MULTILINE)[1].split("|")
            ratio = [float(found[1].replace(",", "")) if (found := re.search(r" ([\d,.]+) \(", cell)) else float("nan")
                     for cell in cells]  # fmt: skip
            ax.plot(ERRORS, ratio, f"-{marker}", color=color, label=f"{name}, {pulse}", markersize=4)
    ax.set(
        title=title, xscale="log", yscale="log", xlabel="error of the peak, 99 % of the blocks [-]", xlim=(3e-3, 3e-13)
    )
    ax.grid(visible=True, linewidth=0.3, alpha=0.6)
axes[0].set_ylabel("its run time over that of rocking [-]")
axes[0].legend()
