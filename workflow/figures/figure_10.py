"""Figure 10: overturning of blocks of several slenderness angles, with the limit of slender blocks of figure 4."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking.paper.overturning import overturning_amplitudes
from rocking.plot.boundary_lines import draw_lines
from rocking.plot.style import BLACK, GREY, WIDTH, shades
from workflow.figures.boundary_lines import line_variables, lines_of, lines_of_files
from workflow.figures.style import panel_letters, plotted

WINDOWS = {"sine": (0.2, 8.5), "cosine": (0.2, 5.6)}
"""Frequency ratios shown [-]; beyond them almost no block overturns at the amplitudes shown."""

AMPLITUDES = (1.0, 12.0)  # amplitudes a shown [-], as in figure 4

DETAILS = {
    "sine": [((0.10, 0.70, 0.31, 0.27), ((0.3, 1.2), (1.03, 1.13)))],
    "cosine": [
        ((0.11, 0.70, 0.19, 0.27), ((1.2, 1.55), (2.3, 3.3))),
        ((0.76, 0.09, 0.23, 0.37), ((0.3, 2.0), (1.02, 1.32))),
    ],
}
"""Inset windows of each pulse: place in the panel, and limits of omega and of a."""

SLENDER = "#BDBDBD"


def data(*, sine: Path, cosine: Path, restitution: float, alpha_deg: Sequence[float]) -> xr.Dataset:
    """Boundaries of both pulses at several angles, and the closed forms of the slender block under the sine.

    `sine`, `cosine`: traced boundaries of this restitution. `restitution`: eta [-]. `alpha_deg`: slenderness angles
    [deg] beside the slender limit; angles of the files.
    """
    angles = [0.0, *(float(alpha) for alpha in np.radians(alpha_deg))]
    files = {"sine": sine, "cosine": cosine}
    low, high = WINDOWS["sine"]
    omega = np.geomspace(low, high, 801)
    closed = overturning_amplitudes(omega, restitution)
    dims = "frequency_ratio"
    return xr.Dataset(
        {
            **line_variables(lines_of_files(list(files.values()), angles)),
            "overturns_from": plotted(
                dims, closed.overturns_from, "slender: overturns after one impact", equation="3.18, 3.20, 3.21"
            ),
            "survives_again": plotted(dims, closed.survives_again, "slender: survives again", equation="3.18"),
            "direct": plotted(dims, closed.direct, "slender: overturns without impact", equation="3.10"),
        },
        coords={
            "alpha": plotted("alpha", angles, "slenderness angle", units="rad"),
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
    """One panel for each pulse: a line for each angle, the slender limit as a band, its closed forms dashed on top."""
    figure = Figure(figsize=(WIDTH, 4.3))
    axes = figure.subplots(1, 2, sharey=True)
    for k, (ax, pulse) in enumerate(zip(axes, data.attrs["pulse_names"].split(), strict=True)):
        _curves(ax, data, k, linewidth=0.9)
        ax.set_xlim(WINDOWS[pulse])
        ax.set_title(f"{pulse} pulse")
        ax.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
    axes[0].set_yscale("log")
    axes[0].set_ylim(AMPLITUDES)
    ticks = [1, 2, 3, 4, 5, 6, 8, 10, 12]
    axes[0].set_yticks(ticks, labels=[str(tick) for tick in ticks])
    for ax in axes:
        ax.minorticks_off()
    for k, (ax, windows) in enumerate(zip(axes, DETAILS.values(), strict=True)):
        for place, (x, y) in windows:
            inset = ax.inset_axes(place)
            _curves(inset, data, k, linewidth=0.8)
            inset.set(xlim=x, ylim=y)
            inset.tick_params(labelsize=6, length=2, pad=1.5)
            ax.indicate_inset_zoom(inset, edgecolor=GREY, linewidth=0.6)
    pointer = {"fontsize": 7, "va": "center", "arrowprops": {"arrowstyle": "-", "linewidth": 0.5}}
    axes[0].annotate("upper surviving\nregion", (4.2, 5.2), (1.5, 4.2), **pointer)
    axes[0].set_ylabel(r"amplitude $a=a_g/(g\tan\alpha)$ [-]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    panel_letters(axes)
    return figure


def _curves(ax: Axes, data: xr.Dataset, pulse: int, *, linewidth: float) -> None:
    angles = data.alpha.values
    for colour, alpha in zip([SLENDER, *shades(angles.size - 1)], angles, strict=True):
        lines = lines_of(data, pulse, float(alpha))
        slender = alpha == 0.0
        style = {
            "color": colour,
            "linewidth": 3 * linewidth if slender else linewidth,
            "label": "slender limit" if slender else rf"$\alpha={np.degrees(alpha):.0f}$°",
            "zorder": 2 if slender else 3,
        }
        draw_lines(ax, lines.frequency_ratio, lines.amplitude, lines, **style)
    if data.attrs["pulse_names"].split()[pulse] == "sine":
        style = {"color": BLACK, "linewidth": 0.7 * linewidth, "linestyle": (0, (1, 2)), "zorder": 4}
        for name in ("overturns_from", "survives_again", "direct"):
            label = {"label": "slender, closed forms"} if name == "direct" else {}
            ax.plot(data.frequency_ratio, data[name], **style, **label)
