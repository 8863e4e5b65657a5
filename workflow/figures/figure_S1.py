"""Figure S1: the sine of the excitation and the ad hoc exponentials (3.27) that approximate it around tau = 1."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking.paper.approximation import EXPANSION_TIME, ad_hoc_sine
from rocking.paper.motion import pulse_end, uplift_phase
from rocking.plot.style import BLUE, GREY, VERMILION, WIDTH
from workflow.figures.style import panel_letters, plotted


def data(*, slenderness: float, frequency_ratio: Sequence[float]) -> xr.Dataset:
    """sin(omega tau + psi) and (3.27) on 0 <= tau <= 2.

    `slenderness`: 1/a [-], which sets the phase psi of uplift, (3.3); `frequency_ratio`: omega [-], one panel each.
    """
    a, omega, tau = 1 / slenderness, np.array(frequency_ratio), np.linspace(0.0, 2.0, 201)
    dims = ("frequency_ratio", "tau")
    return xr.Dataset(
        {
            "exact": plotted(
                dims, np.sin(omega[:, None] * tau + uplift_phase(a)), "sin(omega tau + psi)", equation="3.2"
            ),
            "approximation": plotted(
                dims, ad_hoc_sine(a, omega[:, None], tau), "ad hoc approximation around tau = 1", equation="3.27"
            ),
        },
        coords={
            "pulse_end": plotted("frequency_ratio", pulse_end(a, omega), "p T_ex, end of the pulse since uplift"),
            "frequency_ratio": plotted("frequency_ratio", omega, "frequency ratio omega_g/p"),
            "tau": plotted("tau", tau, "time p t since uplift"),
        },
        attrs={
            "title": "Approximation of the sine by two exponentials and a constant",
            "summary": f"Equation (3.27) against the sine for slenderness 1/a = {slenderness}.",
            "slenderness": slenderness,
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """One panel per frequency ratio."""
    figure = Figure(figsize=(WIDTH, 3.6))
    axes = figure.subplots(2, -(-data.frequency_ratio.size // 2), sharex=True, sharey=True).ravel()
    for ax, omega in zip(axes, data.frequency_ratio.values, strict=False):
        one = data.sel(frequency_ratio=omega)
        ax.axvline(EXPANSION_TIME, color=GREY, linewidth=0.6, linestyle=":")
        acting = data.tau <= one.pulse_end
        ax.plot(data.tau, one.exact.where(acting), color=BLUE, label=r"$\sin(\omega\tau+\psi)$ while the pulse acts")
        ax.plot(data.tau, one.exact, color=BLUE, alpha=0.35, linewidth=0.8, label="and beyond its end")
        ax.plot(data.tau, one.approximation, color=VERMILION, linestyle="--", label="(3.27)")
        ax.text(0.98, 0.96, rf"$\omega={omega:g}$", transform=ax.transAxes, ha="right", va="top")
        ax.set_ylim(-1.6, 1.6)
        ax.set_xlim(0, 2)
        ax.set_xticks([0, 0.5, 1, 1.5, 2])
    for ax in axes[data.frequency_ratio.size :]:
        ax.remove()
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    panel_letters(axes)
    figure.supxlabel(r"time since uplift $\tau=pt$ [-]", fontsize=8)
    figure.supylabel(r"ground acceleration $\ddot{u}_g/a_g$ [-]", fontsize=8)
    return figure
