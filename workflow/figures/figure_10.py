"""Figure 10: overturning of blocks of several slenderness angles, with the limit of slender blocks of figure 4."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking.paper.overturning import overturning_amplitudes
from rocking.plot.style import BLACK, WIDTH, shades
from workflow.figures.boundary_lines import line_variables, lines_of, lines_of_files
from workflow.figures.style import frame_detail, panel_letters, plotted

WINDOWS = {"sine": (0.2, 8.5), "cosine": (0.2, 5.6)}
"""Frequency ratios shown [-]; beyond them almost no block overturns at the amplitudes shown."""

AMPLITUDES = (1.0, 12.0)  # amplitudes a shown [-], as in figure 4

DETAILS = {
    "(c)": ("sine", (0.3, 1.2), (1.03, 1.13)),
    "(d)": ("cosine", (1.2, 1.55), (2.3, 3.3)),
    "(e)": ("cosine", (0.3, 2.0), (1.02, 1.32)),
}
"""Windows that have a panel of their own: pulse, limits of omega and of a."""

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
    """Above a panel for each pulse, below the windows in which blocks overturn after two and more impacts."""
    figure = Figure(figsize=(WIDTH, 6.6))
    axes = figure.subplot_mosaic([["sine"] * 3 + ["cosine"] * 3, ["(c)"] * 2 + ["(d)"] * 2 + ["(e)"] * 2],
                                 height_ratios=[2, 1])  # fmt: skip
    pulses = data.attrs["pulse_names"].split()
    ticks = [1, 2, 3, 4, 5, 6, 8, 10, 12]
    for k, pulse in enumerate(pulses):
        ax = axes[pulse]
        _curves(ax, data, k, linewidth=0.9, detail=False)
        ax.set(xlim=WINDOWS[pulse], yscale="log", ylim=AMPLITUDES, title=f"{pulse} pulse")
        ax.set_yticks(ticks, labels=[str(tick) for tick in ticks])
        ax.minorticks_off()
    for name, (pulse, x, y) in DETAILS.items():
        _curves(axes[name], data, pulses.index(pulse), linewidth=0.9, detail=True)
        axes[name].set(xlim=x, ylim=y, title=pulse)
        frame_detail(axes[pulse], axes[name], name)
    for name in ("sine", "(c)"):
        axes[name].set_ylabel(r"amplitude $a=a_g/(g\tan\alpha)$ [-]")
    for ax in axes.values():
        ax.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
    pointer = {"fontsize": 7, "va": "center", "arrowprops": {"arrowstyle": "-", "linewidth": 0.5}}
    axes["sine"].annotate("upper surviving\nregion", (4.2, 5.2), (1.2, 6.2), **pointer)
    figure.legend(*axes["sine"].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    panel_letters(list(axes.values()))
    return figure


def _curves(ax: Axes, data: xr.Dataset, pulse: int, *, linewidth: float, detail: bool) -> None:
    """The curves of all angles; `detail`: those of overturning after two and more impacts too."""
    angles = data.alpha.values
    for colour, alpha in zip([SLENDER, *shades(angles.size - 1)], angles, strict=True):
        lines, slender = lines_of(data, pulse, float(alpha)), alpha == 0.0
        style = {
            "color": colour,
            "linewidth": 3 * linewidth if slender else linewidth,
            "label": "slender limit" if slender else rf"$\alpha={np.degrees(alpha):.0f}$°",
            "zorder": 2 if slender else 3,
        }
        one = lines if detail else lines.at_level(detail=False)
        ax.plot(one.frequency_ratio, one.amplitude, **style)
    if data.attrs["pulse_names"].split()[pulse] == "sine":
        style = {"color": BLACK, "linewidth": 0.7 * linewidth, "linestyle": (0, (1, 2)), "zorder": 4}
        for name in ("overturns_from", "survives_again", "direct"):
            label = {"label": "slender, closed forms"} if name == "direct" else {}
            ax.plot(data.frequency_ratio, data[name], **style, **label)
