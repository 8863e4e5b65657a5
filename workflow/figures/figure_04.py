"""Figure 4: overturning curves of the sine in closed form, their regions, and the islands that they do not contain."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking._boundary.curves import curves_at
from rocking._datasets.cube import read_dataset
from rocking.paper.overturning import case_1_1_end, case_1_2_amplitudes, limit_amplitude, overturning_amplitudes
from rocking.plot.boundary_lines import Lines, outcome_lines
from rocking.plot.style import BLACK, GREY, WIDTH, shades
from workflow.figures.style import panel_letters, plotted

POINTS = 401


def data(*, boundaries: Sequence[Path], restitution: Sequence[float]) -> xr.Dataset:
    """Closed forms over frequency ratio, and the traced points of islands, as amplitudes a = a_g/(g alpha).

    `boundaries`: traced boundaries of the sine, one file for each restitution; `restitution`: eta [-].
    """
    eta = np.array(restitution)
    tips = _tips(eta)
    near = tips[:, None] * (1 - 0.05 * np.linspace(0.0, 1.0, 21) ** 2)  # the curves have a turning point there
    omega = np.union1d(np.geomspace(0.2, 8.5, POINTS), near[near < 8.5])
    closed = overturning_amplitudes(omega, eta[:, None])
    islands = [_islands(path) for path in boundaries]
    between = {"comment": "missing between two lines"}
    dims = ("restitution", "frequency_ratio")
    return xr.Dataset(
        {
            "overturns_from": plotted(
                dims, closed.overturns_from, "overturns after one impact from here", equation="3.18, 3.20, 3.21"
            ),
            "survives_again": plotted(
                dims, closed.survives_again, "overturns after one impact up to here", equation="3.18"
            ),
            "direct": plotted("frequency_ratio", closed.direct[0], "overturns without impact above", equation="3.10"),
            "limit": plotted(
                "frequency_ratio", limit_amplitude(omega), "first impact at the end of the pulse", equation="3.31"
            ),
            "island_amplitude": plotted(
                "point", np.concatenate([one.amplitude for one in islands]), "boundary of an island", **between
            ),
            "island_frequency_ratio": plotted(
                "point", np.concatenate([one.frequency_ratio for one in islands]), "omega there", **between
            ),
            "island_impacts": plotted(
                "point", np.concatenate([one.impacts for one in islands]), "impacts before overturning, -1: not counted"
            ),
            "island_restitution": plotted(
                "point", np.repeat(eta, [one.impacts.size for one in islands]), "restitution of an island"
            ),
            "tip_frequency_ratio": plotted("restitution", tips, "largest omega of overturning after one impact"),
            "tip_amplitude": plotted(
                "restitution", overturning_amplitudes(tips, eta).overturns_from, "amplitude a at that omega"
            ),
        },
        coords={
            "restitution": plotted("restitution", eta, "coefficient of restitution"),
            "frequency_ratio": plotted("frequency_ratio", omega, "frequency ratio omega_g/p"),
        },
        attrs={
            "title": "Overturning of the slender block by one full sine",
            "summary": "Curves in closed form and the boundaries of overturning after three or more impacts.",
        },
    )


def _tips(eta: np.ndarray) -> np.ndarray:
    """Frequency ratios just below those at which the two branches of each restitution meet."""
    low, high = np.full(eta.size, 2.0), np.full(eta.size, 60.0)
    during = case_1_1_end(eta)
    for _ in range(40):  # there is no overturning after one impact beyond the tip
        middle = 0.5 * (low + high)
        overturns = np.isfinite(case_1_2_amplitudes(middle, eta).upper) | (middle < during)
        low, high = np.where(overturns, middle, low), np.where(overturns, high, middle)
    return low


def _islands(path: Path) -> Lines:
    """Boundaries between survival and overturning after several impacts, which the closed forms do not contain."""
    curves = curves_at(read_dataset(path), 0.0)
    return outcome_lines(
        curves.isel(
            curve=np.flatnonzero(curves.island.values == 1),
            point=np.flatnonzero(np.repeat(curves.island.values == 1, curves.row_size.values)),
        )
    )


def draw(data: xr.Dataset) -> Figure:
    """The whole control plane on the left, the islands near the tip of the surviving region on the right."""
    figure = Figure(figsize=(WIDTH, 3.9))
    left, right = figure.subplots(1, 2, width_ratios=[1.7, 1])
    _curves(left, data, islands=False)
    _curves(right, data, islands=True)
    left.set_yscale("log")
    left.set_ylim(1, 12)
    left.set_yticks([1, 2, 3, 4, 5, 6, 8, 10, 12], labels=["1", "2", "3", "4", "5", "6", "8", "10", "12"])
    left.minorticks_off()
    left.set_xlim(0.2, 8.5)
    for x, y, text in (
        (1.75, 6.0, "overturns without impact,\ncase 2"),
        (3.4, 2.85, "overturns,\ncase 1.2"),
        (2.65, 1.7, "overturns,\ncase 1.1"),
        (6.6, 1.5, "survives, first impact\nwhile the pulse acts"),
        (7.3, 4.0, "survives, first impact\nafter the pulse"),
    ):
        left.text(x, y, text, ha="center", va="center", fontsize=7, color="#333333")
    left.annotate("(3.10)", (5.6, 8.9), ha="right", va="bottom", fontsize=7)
    left.annotate("(3.31)", (8.4, 2.98), ha="right", va="bottom", fontsize=7, color=GREY)
    right.set_xlim(0.3, 1.35)
    right.set_ylim(1.04, 1.18)
    right.text(
        0.97, 0.06, "thin: overturning after\n3, 5, ... impacts", transform=right.transAxes, ha="right", fontsize=7
    )
    left.legend(loc="lower right", ncols=2, fontsize=6.5)
    for ax in (left, right):
        ax.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
    left.indicate_inset([0.3, 1.04, 1.05, 0.14], edgecolor=GREY)
    left.text(1.42, 1.09, "(b)", fontsize=7, color=GREY, va="center")
    left.set_ylabel(r"amplitude $a=a_g/(g\alpha)$ [-]")
    panel_letters([left, right])
    return figure


def _curves(ax: Axes, data: xr.Dataset, *, islands: bool) -> None:
    omega = data.frequency_ratio.values
    for colour, eta in zip(shades(data.restitution.size), data.restitution.values, strict=True):
        one = data.sel(restitution=eta)
        known = np.isfinite(one.overturns_from.values)
        # down one branch and back along the other, joined at the tip unless that lies outside the panel
        joint = [np.nan] if known[-1] else []
        ax.plot(
            np.concatenate([omega[known], joint, omega[known][::-1]]),
            np.concatenate([one.overturns_from.values[known], joint, one.survives_again.values[known][::-1]]),
            color=colour,
            label=rf"$\eta={eta:.2f}$",
        )
        here = data.island_restitution.values == eta
        if islands:
            ax.plot(data.island_frequency_ratio[here], data.island_amplitude[here], color=colour, linewidth=0.5)
    ax.plot(omega, data.direct, color=BLACK, linewidth=1.4)
    ax.plot(omega, data.limit, color=GREY, linewidth=0.9, linestyle=(0, (4, 2)))
