"""Figure 6: the two histories of figure 5 in the groups of (4.1), in which they coincide."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking._history.time_history import time_history
from rocking._model.block import STANDARD_GRAVITY
from rocking.plot.style import BLUE, GREY, VERMILION, WIDTH
from workflow.figures import figure_05
from workflow.figures.style import panel_letters, plotted


def data(**settings: Any) -> xr.Dataset:
    """The histories of figure 5 scaled by (4.1), and the one that the solver of `rocking` computes from the groups."""
    dimensional = figure_05.data(**settings)
    p = dimensional.frequency_parameter
    intensity = dimensional.peak_acceleration / STANDARD_GRAVITY
    master = time_history(
        settings["pulse"],
        slenderness=settings["slenderness"],
        frequency_ratio=settings["frequency_ratio"],
        restitution=settings["restitution"],
        duration=settings["duration"],
        samples=1201,
    )
    inverse_a = settings["slenderness"]  # theta/alpha times 1/a is g theta/a_g, (4.1)
    dims = ("block", "sample")
    return xr.Dataset(
        {
            "rotation": plotted(dims, dimensional.rotation / intensity, "g theta/a_g", equation="4.1"),
            "angular_velocity": plotted(
                dims, dimensional.angular_velocity / intensity / p, "g theta'/(p a_g)", equation="4.1"
            ),
            "ground_acceleration": plotted(
                dims, dimensional.ground_acceleration / intensity, "ground acceleration/a_g"
            ),
            "master_rotation": plotted("tau_master", master.rotation * inverse_a, "g theta/a_g from the groups"),
            "master_angular_velocity": plotted(
                "tau_master", master.angular_velocity * inverse_a, "g theta'/(p a_g) from the groups"
            ),
        },
        coords={
            "tau": plotted(dims, dimensional.time * p, "time p t since the start of the pulse"),
            "tau_master": plotted("tau_master", master.tau, "time p t since the start of the pulse"),
            "alpha": dimensional.alpha,
        },
        attrs={
            **dimensional.attrs,
            "title": "Two rocking blocks with equal groups collapse to one curve",
            "summary": "Figure 5 in the groups of (4.1), and the response computed from the groups alone.",
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """Rotation and angular velocity over tau: the master curve in grey, the two blocks on top of it."""
    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots(2, 1, sharex=True)
    labels = {"rotation": r"$g\theta/a_g$ [-]", "angular_velocity": r"$g\dot{\theta}/(p\,a_g)$ [-]"}
    for ax, (name, label) in zip(axes, labels.items(), strict=True):
        ax.plot(data.tau_master, data[f"master_{name}"], color="#C8C8C8", linewidth=4, label="from the groups")
        for k, (colour, style) in enumerate(((BLUE, "-"), (VERMILION, (0, (3, 3))))):
            text = rf"block of $\alpha={np.degrees(data.alpha[k]):.1f}$°"
            ax.plot(data.tau[k], data[name][k], color=colour, linestyle=style, label=text)
        ax.axhline(0, color=GREY, linewidth=0.5)
        ax.set_ylabel(label)
    axes[0].legend(loc="upper right", ncols=3)
    axes[1].set_xlabel(r"time since the start of the pulse $\tau=pt$ [-]")
    axes[1].set_xlim(0, float(data.tau.max()))
    panel_letters(axes)
    return figure
