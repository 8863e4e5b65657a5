"""Figure 3: overturning after an impact inside the pulse (case 1.1), exact against semi-analytical."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking.closed_form import case_1_1_amplitudes, case_1_1_end, semi_analytical_amplitudes, within_pulse
from workflow.figures.style import GREY, WIDTH, panel_letters, plotted, shades


def data(*, restitution: Sequence[float], frequency_ratio: Mapping[str, float]) -> xr.Dataset:
    """Amplitudes between which case 1.1 overturns, by (3.20) with (3.21) and by (3.30), over frequency ratio.

    Parameters
    ----------
    restitution : sequence
        eta [-].
    frequency_ratio : mapping
        low, high [-] and points of the axis.
    """
    eta = np.array(restitution)
    omega = np.linspace(frequency_ratio["low"], frequency_ratio["high"], int(frequency_ratio["points"]))
    # each curve ends at its own frequency ratio, which is added so that the tip is drawn to its end
    tips = case_1_1_end(eta) * (1 - 1e-9)
    omega = np.union1d(omega, tips[(tips > omega[0]) & (tips < omega[-1])])
    exact = case_1_1_amplitudes(omega, eta[:, None])
    approximate = semi_analytical_amplitudes(omega, eta[:, None]).lower
    known = np.isfinite(approximate)
    valid = known & within_pulse(np.where(known, approximate, 2.0), omega)
    dims = ("restitution", "frequency_ratio")
    return xr.Dataset(
        {
            "lower": plotted(dims, exact.lower, "amplitude a from which case 1.1 overturns", equation="3.20, 3.21"),
            "upper": plotted(dims, exact.upper, "amplitude a up to which case 1.1 overturns", equation="3.31"),
            "semi_analytical": plotted(
                dims, np.where(valid, approximate, np.nan), "smallest solution a inside the pulse", equation="3.30"
            ),
        },
        coords={
            "restitution": plotted("restitution", eta, "coefficient of restitution"),
            "frequency_ratio": plotted("frequency_ratio", omega, "frequency ratio omega_g/p"),
        },
        attrs={
            "title": "Overturning after one impact inside the sine pulse (case 1.1)",
            "summary": "Amplitudes a = a_g/(g alpha) by the exact impact time and by the ad hoc approximation of it.",
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """Curves on the left, relative difference of the lower branch on the right."""
    figure = Figure(figsize=(WIDTH, 3.0))
    left, right = figure.subplots(1, 2, width_ratios=[1.35, 1])
    omega = data.frequency_ratio.values
    for colour, eta in zip(shades(data.restitution.size), data.restitution.values, strict=True):
        one = data.sel(restitution=eta)
        left.plot(omega, one.lower, color=colour)
        left.plot(omega, one.semi_analytical, color=colour, linestyle=(0, (1, 1.6)), linewidth=2.4)
        last = int(np.flatnonzero(np.isfinite(one.lower))[-1])
        tip = (omega[last], float(one.upper[last]))
        left.annotate(
            f"{eta:.2f}", tip, xytext=(0, 5), textcoords="offset points", color=colour, fontsize=7, ha="center"
        )
        right.semilogy(omega, np.abs(one.semi_analytical / one.lower - 1), color=colour, label=rf"$\eta={eta:.2f}$")
    left.plot(omega, data.upper.max("restitution"), color=GREY, linewidth=0.9)
    left.annotate("(3.31)", (omega[40], float(data.upper.max("restitution")[40])), xytext=(-4, 5),
                  textcoords="offset points", ha="right", color=GREY)  # fmt: skip
    left.text(omega[0] + 3.3, 2.86, r"$\eta=$", ha="right", va="center")
    left.plot([], [], color="black", label="exact impact time, (3.20) and (3.21)")
    left.plot([], [], color="black", linestyle=(0, (1, 1.6)), linewidth=2.4, label="semi-analytical, (3.30)")
    left.legend(loc="upper left")
    left.set_ylim(1.0, 3.6)
    left.set_xlim(omega[0], omega[-1])
    left.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
    left.set_ylabel(r"amplitude $a=a_g/(g\alpha)$ [-]")
    right.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
    right.set_ylabel("relative difference of the lower branch [-]")
    right.legend(loc="lower left")
    right.set_xlim(omega[0], omega[-1])
    panel_letters([left, right])
    return figure
