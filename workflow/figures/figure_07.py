"""Figure 7: histories of one block for several coefficients of restitution, the damping of the motion."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking._history.time_history import time_history
from rocking.plot.style import GREY, WIDTH, shades
from workflow.figures.style import panel_letters, plotted

SAMPLES = 900


def data(
    *,
    pulses: Sequence[str],
    restitution: Sequence[float],
    slenderness: float,
    frequency_ratio: float,
    duration: float,
) -> xr.Dataset:
    """Rotation and angular velocity in the groups of (4.1), over pulse and restitution.

    `restitution`: eta [-]; `slenderness`, `frequency_ratio`: 1/a and omega [-]; `duration`: tau = p t at the end [-].
    """
    tau = np.linspace(0.0, duration, SAMPLES)
    shape = (len(pulses), len(restitution), tau.size)
    rotation, velocity = np.empty(shape), np.empty(shape)
    for i, pulse in enumerate(pulses):
        for j, eta in enumerate(restitution):
            history = time_history(
                pulse,
                slenderness=slenderness,
                frequency_ratio=frequency_ratio,
                restitution=eta,
                duration=duration,
                samples=SAMPLES,
            )
            # samples include the events, which differ with eta: interpolated to common times
            rotation[i, j] = slenderness * np.interp(tau, history.tau, history.rotation)
            velocity[i, j] = slenderness * np.interp(tau, history.tau, history.angular_velocity)
    dims = ("pulse", "restitution", "tau")
    return xr.Dataset(
        {
            "rotation": plotted(dims, rotation, "g theta/a_g", equation="4.1"),
            "angular_velocity": plotted(dims, velocity, "g theta'/(p a_g)", equation="4.1"),
        },
        coords={
            "restitution": plotted("restitution", restitution, "coefficient of restitution"),
            "tau": plotted("tau", tau, "time p t since the start of the pulse"),
        },
        attrs={
            "title": "Histories for several coefficients of restitution",
            "summary": f"1/a = {slenderness}, omega = {frequency_ratio}, one pulse per column.",
            "pulse_names": " ".join(pulses),
            "slenderness": slenderness,
            "frequency_ratio": frequency_ratio,
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """Rotation above, angular velocity below, one column per pulse."""
    pulses = data.attrs["pulse_names"].split()
    figure = Figure(figsize=(WIDTH, 4.0))
    axes = figure.subplots(2, len(pulses), sharex=True, sharey="row", squeeze=False)
    labels = {"rotation": r"$g\theta/a_g$ [-]", "angular_velocity": r"$g\dot{\theta}/(p\,a_g)$ [-]"}
    colours = shades(data.restitution.size)
    for row, (name, label) in zip(axes, labels.items(), strict=True):
        for i, ax in enumerate(row):
            for colour, eta in zip(colours, data.restitution.values, strict=True):
                ax.plot(data.tau, data[name][i].sel(restitution=eta), color=colour, label=f"{eta:.2f}", linewidth=0.9)
            ax.axhline(0, color=GREY, linewidth=0.5)
        row[0].set_ylabel(label)
    for ax, pulse in zip(axes[0], pulses, strict=True):
        ax.set_title(f"{pulse} pulse")
    for ax in axes[1]:
        ax.set_xlabel(r"time since the start of the pulse $\tau=pt$ [-]")
        ax.set_xlim(0, float(data.tau.max()))
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, [rf"$\eta={label}$" for label in labels], loc="outside upper center", ncols=len(labels))
    panel_letters(axes.ravel())
    return figure
