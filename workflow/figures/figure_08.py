"""Figure 8: rocking spectra for many coefficients of restitution, with the closed form (4.13) for the sine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from rocking.closed_form import case_1_2_peak_by_pulse
from rocking.datasets.cube import read_spectrum
from workflow.figures.style import WIDTH, panel_letters, plotted, shades

DASHED = {"color": "black", "linestyle": (0, (2, 3)), "linewidth": 0.6}


def data(
    *,
    sine: Sequence[Path],
    cosine: Sequence[Path],
    restitution: Sequence[float],
    slenderness: Sequence[float],
    frequency_ratio: Mapping[str, float],
) -> xr.Dataset:
    """Rows of the spectrum cubes, in the groups of (4.11): g theta_max/a_g over omega.

    Parameters
    ----------
    sine, cosine : sequences of paths
        Spectrum cubes, one for each restitution.
    restitution : sequence
        eta [-].
    slenderness : sequence
        1/a [-], one row of panels each; nodes of the cubes.
    frequency_ratio : mapping
        low and high [-] of what is shown.
    """
    found = xr.concat(
        [xr.concat([_rows(path, slenderness) for path in paths], dim="restitution") for paths in (sine, cosine)],
        dim="pulse",
    )
    omega = found.frequency_ratio.values
    found = found[..., (omega >= frequency_ratio["low"]) & (omega <= frequency_ratio["high"])]
    s, omega, eta = np.array(slenderness), found.frequency_ratio.values, np.array(restitution)
    dims = ("restitution", "slenderness", "frequency_ratio")
    closed = case_1_2_peak_by_pulse(1 / s[:, None], omega, eta[:, None, None])
    spectra = found.values * s[:, None]  # theta/alpha times 1/a is g theta/a_g
    return xr.Dataset(
        {
            "spectrum": plotted(("pulse", *dims), spectra, "g theta_max/a_g", equation="4.11"),
            "closed_form": plotted(dims, closed, "g theta_max/a_g of the sine in closed form", equation="4.13"),
        },
        coords={
            "restitution": plotted("restitution", eta, "coefficient of restitution"),
            "slenderness": plotted("slenderness", s, "dimensionless slenderness g alpha/a_g"),
            "frequency_ratio": plotted("frequency_ratio", omega, "frequency ratio omega_g/p"),
        },
        attrs={
            "title": "Self-similar rocking spectra",
            "summary": "Peak rotation over the whole response, free rocking included; missing if overturned.",
            "pulse_names": "sine cosine",
        },
    )


def _rows(path: Path, slenderness: Sequence[float]) -> xr.DataArray:
    cube = read_spectrum(path).sel(alpha=0.0)
    return cube.peak_rotation.sel(slenderness=list(slenderness), method="nearest", tolerance=1e-9).drop_vars(
        ["alpha", "pulse"]
    )


def draw(data: xr.Dataset) -> Figure:
    """Rows: slenderness; columns: sine, with (4.13) dashed, and cosine."""
    figure = Figure(figsize=(WIDTH, 6.4))
    axes = figure.subplots(data.slenderness.size, 2, sharex=True, sharey="row", squeeze=False)
    eta, omega = data.restitution.values, data.frequency_ratio.values
    colours = shades(eta.size)
    for row, s in zip(axes, data.slenderness.values, strict=True):
        for i, (ax, pulse) in enumerate(zip(row, data.attrs["pulse_names"].split(), strict=True)):
            for colour, one in zip(colours, eta, strict=True):
                place = {"slenderness": s, "restitution": one}
                ax.plot(omega, data.spectrum[i].sel(place), color=colour, linewidth=0.9)
                if pulse == "sine":
                    ax.plot(omega, data.closed_form.sel(place), **DASHED)
            ax.text(
                0.98, 0.96, rf"{pulse}, $g\alpha/a_g={s:.2f}$", transform=ax.transAxes, ha="right", va="top"
            )  # fmt: skip
        row[0].set_ylabel(r"$g\,\theta_{\max}/a_g$ [-]")
        row[0].set_ylim(0, 1.15 * float(data.spectrum.sel(slenderness=s).max()))
    for ax in axes[-1]:
        ax.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
        ax.set_xlim(omega[0], omega[-1])
    axes[0, 0].plot([], [], color=colours[eta.size // 2], label="solved event by event")
    axes[0, 0].plot([], [], label="closed form (4.13)", **DASHED)
    axes[0, 0].legend(loc="upper right", bbox_to_anchor=(1.0, 0.9))
    steps = np.diff(eta, prepend=2 * eta[0] - eta[1] if eta.size > 1 else eta[0] - 0.02)
    norm = BoundaryNorm([*(eta - steps / 2), eta[-1] + steps[-1] / 2], eta.size)
    bar = figure.colorbar(ScalarMappable(norm, ListedColormap(colours)), ax=axes, ticks=eta, aspect=40, pad=0.01)
    bar.set_label(r"coefficient of restitution $\eta$ [-]")
    bar.ax.minorticks_off()
    panel_letters(axes.ravel())
    return figure
