"""Figure 13: rocking spectra of blocks of several slenderness angles, which nearly coincide in the groups of (6.1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking.datasets.cube import read_spectrum
from workflow.figures.style import BLACK, WIDTH, panel_letters, plotted, shades


def data(
    *,
    sine: Path,
    cosine: Path,
    restitution: float,
    slenderness: Sequence[float],
    frequency_ratio: Mapping[str, float],
) -> xr.Dataset:
    """Rows of the spectrum cubes at all their angles: g theta_max/(a_g cos alpha) over omega.

    Parameters
    ----------
    sine, cosine : path
        Spectrum cubes of this restitution.
    restitution : float
        eta [-].
    slenderness : sequence
        g tan(alpha)/a_g [-], one row of panels each; nodes of the cubes.
    frequency_ratio : mapping
        low and high [-] of what is shown.
    """
    rows = xr.concat([_rows(path, slenderness) for path in (sine, cosine)], dim="pulse")
    omega = rows.frequency_ratio.values
    rows = rows[..., (omega >= frequency_ratio["low"]) & (omega <= frequency_ratio["high"])]
    alpha, s = rows.alpha.values, np.array(slenderness)
    return xr.Dataset(
        {
            "spectrum": plotted(
                ("pulse", "alpha", "slenderness", "frequency_ratio"),
                rows.values * s[:, None] * scale_of(alpha)[:, None, None],
                "g theta_max/(a_g cos alpha)",
                equation="6.1",
                comment="missing where the block overturns",
            ),
        },
        coords={
            "alpha": plotted("alpha", alpha, "slenderness angle, 0 for the slender limit", units="rad"),
            "slenderness": plotted("slenderness", s, "dimensionless slenderness g tan(alpha)/a_g"),
            "frequency_ratio": plotted("frequency_ratio", rows.frequency_ratio.values, "frequency ratio omega_g/p"),
        },
        attrs={
            "title": "Rocking spectra of blocks of several slenderness angles",
            "summary": "Peak rotation over the whole response in the groups of (6.1).",
            "pulse_names": "sine cosine",
            "restitution": restitution,
        },
    )


def scale_of(alpha: np.ndarray) -> np.ndarray:
    """Factor from (theta/alpha) (g tan(alpha)/a_g) to g theta/(a_g cos(alpha)), (6.1): alpha/sin(alpha), 1 at 0."""
    return 1 / np.sinc(alpha / np.pi)


def _rows(path: Path, slenderness: Sequence[float]) -> xr.DataArray:
    cube = read_spectrum(path)
    return cube.peak_rotation.sel(slenderness=list(slenderness), method="nearest", tolerance=1e-9).drop_vars("pulse")


def draw(data: xr.Dataset) -> Figure:
    """Rows: slenderness; columns: pulses; a line for each angle, the slender limit in black."""
    figure = Figure(figsize=(WIDTH, 0.9 + 1.7 * data.slenderness.size))
    axes = figure.subplots(data.slenderness.size, 2, sharex=True, sharey="row", squeeze=False)
    omega, angles = data.frequency_ratio.values, data.alpha.values
    for row, s in zip(axes, data.slenderness.values, strict=True):
        for i, (ax, pulse) in enumerate(zip(row, data.attrs["pulse_names"].split(), strict=True)):
            for colour, alpha in zip([BLACK, *shades(angles.size - 1)], angles, strict=True):
                slender = alpha == 0.0
                ax.plot(
                    omega,
                    data.spectrum[i].sel(slenderness=s, alpha=alpha),
                    color=colour,
                    linewidth=1.6 if slender else 0.9,
                    label="slender limit" if slender else rf"$\alpha={np.degrees(alpha):.0f}$°",
                )
            ax.text(
                0.98, 0.96, rf"{pulse}, $g\tan\alpha/a_g={s:.2f}$", transform=ax.transAxes, ha="right", va="top"
            )  # fmt: skip
        row[0].set_ylabel(r"$g\,\theta_{\max}/(a_g\cos\alpha)$ [-]")
        row[0].set_ylim(0, 1.15 * float(data.spectrum.sel(slenderness=s).max()))
    for ax in axes[-1]:
        ax.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
        ax.set_xlim(omega[0], omega[-1])
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=angles.size)
    panel_letters(axes.ravel())
    return figure
