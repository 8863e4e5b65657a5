"""Figure 8: rocking spectra for many coefficients of restitution, with the closed form (4.13) for the sine."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from rocking.paper.overturning import limit_amplitude
from rocking.paper.peak import case_1_2_peak_by_pulse
from rocking.plot.style import VERMILION, WIDTH, shades
from workflow.figures.spectrum_curves import SpectrumBlock, curve_variables, rows_of
from workflow.figures.style import panel_letters, plotted

PULSES = ("sine", "cosine")

EXACT = 1e-9  # relative difference up to which (4.13) and the solver are considered equal [-]

HOLDS = {"color": VERMILION, "linestyle": (0, (4, 4)), "linewidth": 0.9, "zorder": 3}
APPROXIMATE = {"color": VERMILION, "linestyle": (0, (1, 2)), "linewidth": 0.9, "zorder": 3}


def data(
    *, restitution: Sequence[float], slenderness: Sequence[float], frequency_ratio: Mapping[str, float]
) -> xr.Dataset:
    """Spectra in the groups of (4.11), g theta_max/a_g over omega, sampled with the solver up to their ends.

    `restitution`: eta [-]; `slenderness`: 1/a [-], one row of panels each; `frequency_ratio`: low and high [-] of what
    is shown.
    """
    blocks = [SpectrumBlock(pulse, s, eta) for pulse in PULSES for s in slenderness for eta in restitution]
    # theta/alpha times 1/a is g theta/a_g
    curves = xr.Dataset(curve_variables(blocks, frequency_ratio, [block.slenderness for block in blocks]))
    names = ("pulse", "slenderness", "restitution")
    pulse, s, eta = (np.repeat(curves[f"curve_{name}"].values, curves.row_size.values) for name in names)
    omega, peak = curves.frequency_ratio.values, curves.spectrum.values
    closed = np.where(pulse == PULSES.index("sine"), case_1_2_peak_by_pulse(1 / s, omega, eta), np.nan)
    follows = 1 / s > limit_amplitude(omega)  # the first impact follows the pulse, (3.31)
    holds = follows & (np.abs(closed / peak - 1) < EXACT)
    curves["closed_form"] = plotted("point", closed, "g theta_max/a_g of the sine in closed form", equation="4.13")
    curves["closed_form_holds"] = plotted("point", holds.astype(np.int8), "whether it is the peak of the response")
    curves["first_impact_follows_pulse"] = plotted(
        "point", follows.astype(np.int8), "whether the first impact follows the sine", equation="3.31"
    )
    return curves.assign_attrs(
        title="Self-similar rocking spectra",
        summary="Peak rotation over the whole response, free rocking included. Each curve ends at the boundary of "
        "overturning or at the edge of the panel.",
        pulse_names=" ".join(PULSES),
        window=[frequency_ratio["low"], frequency_ratio["high"]],
    )


def draw(data: xr.Dataset) -> Figure:
    """Rows: slenderness; columns: sine, with (4.13), and cosine."""
    rows, eta = np.unique(data.curve_slenderness), np.unique(data.curve_restitution)
    figure = Figure(figsize=(WIDTH, 0.7 + 1.9 * rows.size))
    axes = figure.subplots(rows.size, 2, sharex=True, sharey="row", squeeze=False)
    colours = shades(eta.size)
    compared = eta[[0, eta.size // 2, -1]]  # a line on every curve would hide the curves
    for row, s in zip(axes, rows, strict=True):
        for i, (ax, pulse) in enumerate(zip(row, data.attrs["pulse_names"].split(), strict=True)):
            for colour, one in zip(colours, eta, strict=True):
                for curve in rows_of(data, pulse=i, slenderness=s, restitution=one):
                    chosen = one in compared
                    ax.plot(curve.frequency_ratio, curve.spectrum, color=colour, linewidth=1.8 if chosen else 0.6)
                    if not chosen:
                        continue
                    ax.plot(curve.frequency_ratio, curve.closed_form.where(curve.closed_form_holds == 1), **HOLDS)
                    during = curve.first_impact_follows_pulse == 0
                    ax.plot(curve.frequency_ratio, curve.closed_form.where(during), **APPROXIMATE)
            ax.set_title(rf"{pulse}, $g\alpha/a_g={s:.2f}$", loc="right")
            ax.axhline(s, color="#999999", linewidth=0.5, zorder=0)
            ax.text(
                0.995, s, r"$\theta_{\max}=\alpha$", transform=ax.get_yaxis_transform(), ha="right", va="bottom",
                fontsize=6.5, color="#555555",
            )  # fmt: skip
        row[0].set_ylabel(r"$g\,\theta_{\max}/a_g$ [-]")
        shown = np.isin(np.repeat(data.curve_slenderness.values, data.row_size.values), s)
        row[0].set_ylim(0, 1.08 * float(data.spectrum.values[shown].max()))
    for ax in axes[-1]:
        ax.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
        ax.set_xlim(data.attrs["window"])
    axes[0, 0].plot([], [], color=colours[eta.size // 2], label="solved event by event")
    axes[0, 0].plot([], [], label="(4.13), exact", **HOLDS)
    of_which = ", ".join(f"{one:.2f}" for one in np.unique(compared))
    axes[0, 0].plot([], [], label=f"(4.13), approximate (both for $\\eta=$ {of_which})", **APPROXIMATE)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    steps = np.diff(eta, prepend=2 * eta[0] - eta[1] if eta.size > 1 else eta[0] - 0.02)
    norm = BoundaryNorm([*(eta - steps / 2), eta[-1] + steps[-1] / 2], eta.size)
    bar = figure.colorbar(ScalarMappable(norm, ListedColormap(colours)), ax=axes, ticks=eta, aspect=40, pad=0.01)
    bar.set_label(r"coefficient of restitution $\eta$ [-]")
    bar.ax.minorticks_off()
    panel_letters(axes.ravel())
    return figure
