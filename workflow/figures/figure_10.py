"""Figure 10: overturning of blocks of several slenderness angles, with the limit of slender blocks of figure 4."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking.closed_form import overturning_amplitudes
from rocking.datasets.cube import read_dataset
from workflow.figures.boundary_lines import line_variables, lines_of, lines_of_files
from workflow.figures.style import BLACK, WIDTH, panel_letters, plotted, shades

WINDOWS = {"sine": (0.2, 8.5), "cosine": (0.2, 4.5)}
"""Frequency ratios shown [-]; beyond them almost no block overturns at the amplitudes shown."""

AMPLITUDES = (1.0, 12.0)
"""Amplitudes a shown [-], as in figure 4."""


def data(*, sine: Path, cosine: Path, restitution: float) -> xr.Dataset:
    """Boundaries of both pulses at all angles traced, and the closed forms of the slender block under the sine.

    Parameters
    ----------
    sine, cosine : path
        Traced boundaries of this restitution.
    restitution : float
        eta [-].
    """
    files = {"sine": sine, "cosine": cosine}
    low, high = WINDOWS["sine"]
    omega = np.geomspace(low, high, 801)
    closed = overturning_amplitudes(omega, restitution)
    dims = "frequency_ratio"
    return xr.Dataset(
        {
            **line_variables(lines_of_files(list(files.values()))),
            "falls_from": plotted(
                dims, closed.falls_from, "slender: overturns after one impact", equation="3.18, 3.20, 3.21"
            ),
            "safe_again": plotted(dims, closed.safe_again, "slender: survives again", equation="3.18"),
            "direct": plotted(dims, closed.direct, "slender: overturns without impact", equation="3.10"),
        },
        coords={
            "alpha": plotted("alpha", np.unique(read_dataset(sine).alpha), "slenderness angle", units="rad"),
            "frequency_ratio": plotted(dims, omega, "frequency ratio omega_g/p"),
        },
        attrs={
            "title": "Overturning of blocks of several slenderness angles",
            "summary": "Amplitudes a_g/(g tan alpha) at which the final outcome changes, traced with the solver; "
            "alpha = 0 is the slender limit.",
            "pulse_names": " ".join(files),
            "restitution": restitution,
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """One panel for each pulse: a line for each angle, the slender limit in black, its closed forms dashed on top."""
    figure = Figure(figsize=(WIDTH, 4.1))
    axes = figure.subplots(1, 2, sharey=True)
    for k, (ax, pulse) in enumerate(zip(axes, data.attrs["pulse_names"].split(), strict=True)):
        _panel(ax, data, k)
        ax.set_xlim(WINDOWS[pulse])
        ax.set_title(f"{pulse} pulse")
        ax.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
    for name in ("falls_from", "safe_again", "direct"):
        axes[0].plot(data.frequency_ratio, data[name], color="white", linewidth=0.6, linestyle=(0, (2, 3)), zorder=4)
    pointer = {"fontsize": 7, "va": "center", "arrowprops": {"arrowstyle": "-", "linewidth": 0.5}}
    axes[0].annotate("upper safe region", (4.2, 5.2), (0.9, 6.5), **pointer)
    axes[0].annotate("white: closed forms\nof figure 4", (4.1, 2.1), (5.3, 1.6), **pointer)
    axes[0].set_yscale("log")
    axes[0].set_ylim(AMPLITUDES)
    ticks = [1, 2, 3, 4, 5, 6, 8, 10, 12]
    axes[0].set_yticks(ticks, labels=[str(tick) for tick in ticks])
    for ax in axes:
        ax.minorticks_off()
    axes[0].set_ylabel(r"amplitude $a=a_g/(g\tan\alpha)$ [-]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=data.alpha.size)
    panel_letters(axes)
    return figure


def _panel(ax: Axes, data: xr.Dataset, pulse: int) -> None:
    angles = data.alpha.values
    for colour, alpha in zip([BLACK, *shades(angles.size - 1)], angles, strict=True):
        lines = lines_of(data, pulse, float(alpha))
        slender = alpha == 0.0
        ax.plot(
            lines.frequency_ratio,
            lines.amplitude,
            color=colour,
            linewidth=1.4 if slender else 0.9,
            marker="o",  # a region between two lines of the grid has no line
            markersize=0.9,
            markeredgewidth=0,
            zorder=3 if slender else 2,
            label="slender limit" if slender else rf"$\alpha={np.degrees(alpha):.0f}$°",
        )
