"""Additional figure: accuracy of the scaling of peak rotation with eta squared, (4.16), for the sine."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize, TwoSlopeNorm
from matplotlib.figure import Figure

from rocking._datasets.cube import read_spectrum
from rocking.paper.overturning import limit_amplitude, overturning_amplitudes
from rocking.paper.peak import small_peak
from rocking.paper.scale_law import largest_deviation, restitution_exponent
from rocking.plot.style import WIDTH
from workflow.figures.style import panel_letters, plotted

LARGEST = 12.0  # largest amplitude a shown [-], as in figure 4


def data(*, cubes: Sequence[Path], restitution: Sequence[float], reference: float) -> xr.Dataset:
    """Errors of the law where the block survives for every restitution.

    `cubes`: spectrum cubes of the sine, one for each restitution; `restitution`: eta [-]; `reference`: the eta from
    which the law predicts the other peaks [-].
    """
    opened = [read_spectrum(path).sel(alpha=0.0) for path in cubes]
    eta = np.array(restitution)
    peaks = np.stack([cube.peak_rotation.values for cube in opened])
    s, omega = opened[0].slenderness.values, opened[0].frequency_ratio.values
    survives = np.isfinite(peaks).all(axis=0)
    peaks[:, ~survives] = np.nan
    closed = small_peak(1 / s[:, None], omega, eta[:, None, None])
    closed_curves = overturning_amplitudes(omega, eta[:, None])
    lowest = np.fmin(closed_curves.overturns_from, closed_curves.direct).min(axis=0)
    dims = ("slenderness", "frequency_ratio")
    return xr.Dataset(
        {
            "deviation": plotted(
                dims,
                largest_deviation(peaks, eta, reference=reference),
                "largest relative error over eta, predicted from the reference eta",
                equation="4.16",
            ),
            "exponent": plotted(
                dims, restitution_exponent(peaks, eta), "exponent n of peak = constant eta^n", equation="4.16"
            ),
            "closed_form_error": plotted(
                dims, np.abs(closed / peaks - 1).max(axis=0), "largest relative error with f = 1 - D0*", equation="4.16"
            ),
        },
        coords={
            "slenderness": plotted("slenderness", s, "dimensionless slenderness g alpha/a_g"),
            "frequency_ratio": plotted("frequency_ratio", omega, "frequency ratio omega_g/p"),
            "overturns_from": plotted(
                "frequency_ratio",
                lowest,
                "smallest amplitude at which a block overturns for one eta",
                equation="3.20, 3.21",
            ),
            "limit": plotted("frequency_ratio", 1 / limit_amplitude(omega), "slenderness of (3.31)", equation="3.31"),
        },
        attrs={
            "title": "Error of the scale law for the coefficient of restitution, sine pulse",
            "summary": f"Peak rotation against eta squared for eta from {eta.min()} to {eta.max()}, relative to "
            f"eta = {reference}; missing where the block overturns for one of them.",
            "restitution": eta,
            "reference": reference,
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """Error with f measured at one eta; fitted exponent; error with the closed form f. Axes as in figure 4."""
    figure = Figure(figsize=(WIDTH, 3.1))
    axes = figure.subplots(1, 3, sharey=True)
    error = LogNorm(1e-3, 1.0)
    eta = data.attrs["reference"]
    panels: tuple[tuple[str, str, Normalize, str], ...] = (
        ("deviation", "viridis_r", error, f"error, from $\\eta={eta:.2f}$ [-]"),
        ("exponent", "PuOr", TwoSlopeNorm(2.0, 0.0, 4.0), "exponent of $\\eta$ [-]"),
        ("closed_form_error", "viridis_r", error, "error, $f=1-D_0^*$ [-]"),
    )  # fmt: skip
    for ax, (name, colours, norm, label) in zip(axes, panels, strict=True):
        _map(ax, data, name, colours, norm, label)
    axes[0].set_ylabel(r"amplitude $a=a_g/(g\alpha)$ [-]")
    axes[0].set_yscale("log")
    axes[0].set_ylim(1 / data.slenderness.values[-1], LARGEST)
    axes[0].set_yticks([1.2, 1.5, 2, 3, 5, 10], labels=["1.2", "1.5", "2", "3", "5", "10"])
    axes[0].minorticks_off()
    panel_letters(axes)
    return figure


def _map(ax: Axes, data: xr.Dataset, name: str, colours: str, norm: Normalize, label: str) -> None:
    omega, a = data.frequency_ratio.values, 1 / data.slenderness.values
    ax.set_facecolor("#DDDDDD")
    mesh = ax.pcolormesh(omega, a, data[name], cmap=colours, norm=norm, rasterized=True, shading="nearest")
    # overturns for one eta at least: above the first curve of the largest eta up to that without impact
    ax.fill_between(omega, data.overturns_from, LARGEST, color="#DDDDDD", linewidth=0)
    ax.plot(omega, data.overturns_from, color="#555555", linewidth=0.8)
    ax.plot(omega, 1 / data.limit, color="black", linewidth=1, linestyle=(0, (4, 2)))
    ax.text(
        omega[-1] * 0.99, 0.9 / float(data.limit[-1]), "(3.31)", ha="right", va="top", fontsize=7,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
    )  # fmt: skip
    ax.set_xlabel(r"frequency ratio $\omega_g/p$ [-]")
    ax.set_xlim(omega[0], omega[-1])
    ax.text(0.05, 0.95, "overturns", transform=ax.transAxes, fontsize=7, color="#555555", va="top")
    bar = ax.figure.colorbar(mesh, ax=ax, location="top", extend="both", pad=0.02)
    bar.set_label(label)
    bar.ax.tick_params(labelsize=6)
    bar.ax.minorticks_off()
