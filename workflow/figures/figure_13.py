"""Figure 13: rocking spectra of blocks of several slenderness angles, which nearly coincide in the groups of (6.1)."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking.plot.style import BLACK, WIDTH, shades
from workflow.figures.spectrum_curves import SpectrumBlock, curve_variables, peaks, rows_of
from workflow.figures.style import panel_letters, plotted

PULSES = ("sine", "cosine")

LINEAR = 1.0  # difference to the slender block up to which the scale of the lower panels is linear [%]


def data(
    *,
    restitution: float,
    slenderness: Sequence[float],
    alpha_deg: Sequence[float],
    frequency_ratio: Mapping[str, float],
) -> xr.Dataset:
    """Spectra of each angle and of the slender limit, g theta_max/(a_g cos alpha) over omega, up to their ends.

    `restitution`: eta [-]; `slenderness`: g tan(alpha)/a_g [-], one row of panels each; `alpha_deg`: slenderness angles
    [deg]; `frequency_ratio`: low and high [-] of what is shown.
    """
    angles = [0.0, *(float(alpha) for alpha in np.radians(alpha_deg))]
    blocks = [SpectrumBlock(pulse, s, restitution, alpha) for pulse in PULSES for s in slenderness for alpha in angles]
    scale = [block.slenderness * float(scale_of(np.array(block.alpha))) for block in blocks]
    curves = xr.Dataset(curve_variables(blocks, frequency_ratio, scale))
    slender = [
        curve_slenderness * peaks(SpectrumBlock(PULSES[pulse], curve_slenderness, restitution), omega)
        for pulse, curve_slenderness, omega in zip(
            curves.curve_pulse.values,
            curves.curve_slenderness.values,
            np.split(curves.frequency_ratio.values, np.cumsum(curves.row_size.values)[:-1]),
            strict=True,
        )
    ]
    curves["slender_spectrum"] = plotted(
        "point",
        np.concatenate(slender),
        "g theta_max/a_g of the slender block",
        comment="missing where it overturns",
    )
    return curves.assign_attrs(
        title="Rocking spectra of blocks of several slenderness angles",
        summary="Peak rotation over the whole response in the groups of (6.1). Each curve ends at the boundary of "
        "overturning or at the edge of the panel.",
        pulse_names=" ".join(PULSES),
        window=[frequency_ratio["low"], frequency_ratio["high"]],
        restitution=restitution,
    )


def scale_of(alpha: np.ndarray) -> np.ndarray:
    """Factor from (theta/alpha) (g tan(alpha)/a_g) to g theta/(a_g cos(alpha)), (6.1): alpha/sin(alpha), 1 at 0."""
    return 1 / np.sinc(alpha / np.pi)


def draw(data: xr.Dataset) -> Figure:
    """Rows: slenderness; columns: pulses; a line for each angle, and below it its difference to the slender block."""
    rows = np.unique(data.curve_slenderness)
    largest = 1.3 * 100 * float(np.abs(data.spectrum / data.slender_spectrum - 1).max())
    figure = Figure(figsize=(WIDTH, 0.8 + 2.1 * rows.size))
    axes = figure.subplots(
        2 * rows.size, 2, sharex=True, sharey="row", squeeze=False, height_ratios=[1.6, 1] * rows.size
    )
    for (row, below), s in zip(axes.reshape(-1, 2, 2), rows, strict=True):
        for i, (ax, difference) in enumerate(zip(row, below, strict=True)):
            _panel(ax, difference, data, i, s)
            ax.set_title(rf"{data.attrs['pulse_names'].split()[i]}, $g\tan\alpha/a_g={s:.2f}$", loc="right")
        row[0].set_ylabel("$g\\,\\theta_{\\max}/(a_g\\cos\\alpha)$ [-]", fontsize=7)
        below[0].set_ylabel("difference [%]", fontsize=7)
        shown = np.isin(np.repeat(data.curve_slenderness.values, data.row_size.values), s)
        row[0].set_ylim(0, 1.08 * float(data.spectrum.values[shown].max()))
        below[0].set_yscale("symlog", linthresh=LINEAR, linscale=0.7)
        below[0].set(ylim=(-largest, largest), yticks=[-10, -1, 0, 1, 10], yticklabels=["-10", "-1", "0", "1", "10"])
    for ax in axes[-1]:
        ax.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
        ax.set_xlim(data.attrs["window"])
    figure.align_ylabels(axes[:, 0])
    handles, labels = axes[0, 0].get_legend_handles_labels()
    first = dict(zip(labels, handles, strict=True))  # a curve of several branches has several handles
    figure.legend(first.values(), first.keys(), loc="outside upper center", ncols=len(first))
    panel_letters(axes[::2].ravel())
    return figure


def _panel(ax: Axes, difference: Axes, data: xr.Dataset, pulse: int, slenderness: float) -> None:
    angles = np.unique(data.curve_alpha)
    for colour, alpha in zip([BLACK, *shades(angles.size - 1)], angles, strict=True):
        slender = alpha == 0.0
        for curve in rows_of(data, pulse=pulse, slenderness=slenderness, alpha=alpha):
            style = {"color": colour, "linewidth": 1.6 if slender else 0.9}
            label = "slender limit" if slender else rf"$\alpha={np.degrees(alpha):.0f}$°"
            ax.plot(curve.frequency_ratio, curve.spectrum, label=label, **style)
            relative = 100 * (curve.spectrum / curve.slender_spectrum - 1)
            difference.plot(curve.frequency_ratio, relative, **style)
