"""Figure 2: the response sequences of a block under one sine, and a history of each way of overturning."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking._history.time_history import time_history
from rocking.plot.style import BLUE, GREY, VERMILION, WIDTH
from workflow.figures.style import plotted

DURATION = 9.0  # tau after which every outcome is visible
SAMPLES = 451


def data(*, pulse: str, restitution: float, cases: Mapping[str, Mapping[str, Any]]) -> xr.Dataset:
    """Two histories of each case: amplitudes on either side of an overturning threshold.

    `restitution`: eta [-]; `cases`: for each case its frequency_ratio omega [-] and two amplitudes a [-].
    """
    tau = np.linspace(0.0, DURATION, SAMPLES)
    rotation = np.full((len(cases), 2, tau.size), np.nan)
    omega, amplitude = np.empty(len(cases)), np.empty((len(cases), 2))
    pulse_end, first_impact = np.empty(len(cases)), np.full((len(cases), 2), np.nan)
    for i, case in enumerate(cases.values()):
        omega[i], amplitude[i] = case["frequency_ratio"], case["amplitudes"]
        for j, a in enumerate(amplitude[i]):
            history = time_history(
                pulse, slenderness=1 / a, frequency_ratio=omega[i], restitution=restitution, duration=DURATION
            )
            rotation[i, j] = np.interp(tau, history.tau, history.rotation, right=np.nan)
            pulse_end[i] = history.attrs["pulse_end"]
            first_impact[i, j] = history.impact_time[0] if history.impact_time.size else np.nan
    dims = ("case", "history")
    return xr.Dataset(
        {
            "rotation": plotted((*dims, "tau"), rotation, "rotation theta/alpha", equation="3.4"),
            "amplitude": plotted(dims, amplitude, "amplitude a = a_g/(g alpha)", equation="3.6"),
            "omega": plotted("case", omega, "frequency ratio omega_g/p", equation="3.6"),
            "pulse_end": plotted("case", pulse_end, "tau at the end of the pulse"),
            "first_impact": plotted(dims, first_impact, "tau of the first impact"),
        },
        coords={"tau": plotted("tau", tau, "time p t since the start of the pulse", equation="3.6")},
        attrs={
            "title": "Response sequences of a block under one full sine",
            "summary": f"Histories on either side of overturning, eta = {restitution}.",
            "case_names": " ".join(cases),
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """The tree of stages above, the histories below."""
    figure = Figure(figsize=(WIDTH, 5.2))
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.25, 1])
    _tree(top.subplots())
    axes = bottom.subplots(1, data.sizes["case"], sharey=True)
    for i, (ax, name) in enumerate(zip(axes, data.attrs["case_names"].split(), strict=True)):
        _histories(ax, data.isel(case=i), name)
    axes[0].set_ylabel(r"rotation $\theta/\alpha$ [-]")
    return figure


def _histories(ax: Axes, one: xr.Dataset, name: str) -> None:
    for j, (colour, style) in enumerate(((VERMILION, "-"), (BLUE, "--"))):
        history = one.isel(history=j)
        ax.plot(one.tau, history.rotation, color=colour, linestyle=style, label=f"$a={float(history.amplitude):.2f}$")
        impact = float(history.first_impact)
        if np.isfinite(impact):
            ax.plot(impact, 0, "o", color=colour, markersize=3.5)
    ax.axvline(float(one.pulse_end), color=GREY, linewidth=0.7, linestyle=":")
    ax.annotate("pulse ends", (float(one.pulse_end), 1.5), xytext=(3, 0), textcoords="offset points", fontsize=6.5,
                color=GREY)  # fmt: skip
    for level in (-1, 0, 1):
        ax.axhline(level, color="black" if level == 0 else GREY, linewidth=0.5)
    ax.set_title(rf"case {name}, $\omega={float(one.omega):g}$")
    ax.set_ylim(-1.7, 1.7)
    ax.set_xlim(0, float(one.tau[-1]))
    ax.set_xlabel(r"$\tau=pt$ [-]")
    ax.legend(loc="lower right", handlelength=1.6)


BOXES = {
    "rest": (0.055, 0.5, "at rest\n$\\theta=0$"),
    "up": (0.235, 0.5, "pulse acts\n$A_0, B_0$ (3.7)\n$\\theta<0$"),
    "free0": (0.465, 0.83, "pulse is over\n$A_{ex0}, B_{ex0}$\n$\\theta<0$"),
    "case2": (0.905, 0.93, "case 2 overturns\n$B_{ex0}=0$ (3.10)"),
    "i2": (0.70, 0.62, "after impact\n$A_{i2}, B_{i2}$\n$\\theta>0$"),
    "case12": (0.905, 0.62, "case 1.2 overturns\n$B_{i2}=0$ (3.18)"),
    "i1": (0.465, 0.2, "after impact,\npulse acts\n$A_{i1}, B_{i1}$\n$\\theta>0$"),
    "ex1": (0.70, 0.2, "pulse is over\n$A_{ex1}, B_{ex1}$\n$\\theta>0$"),
    "case11": (0.905, 0.2, "case 1.1 overturns\n$B_{ex1}=0$ (3.20)"),
}
"""Stages of figure 2: place in the panel and text; the constants of (3.4) and (3.5) and the sign of the rotation."""

ARROWS = (
    ("rest", "up", "uplift"),
    ("up", "free0", "$\\tau=pT_{ex}$"),
    ("up", "i1", "impact $\\tau_{i1}$"),
    ("free0", "case2", ""),
    ("free0", "i2", "impact $\\tau_{i2}$"),
    ("i2", "case12", ""),
    ("i1", "ex1", "$\\tau=pT_{ex}$"),
    ("ex1", "case11", ""),
)


def _tree(ax: Axes) -> None:
    ax.set_axis_off()
    ax.set_xlim(0, 1)
    ax.set_ylim(0, 1)
    placed = {}
    for key, (x, y, text) in BOXES.items():
        overturns = key.startswith("case")
        colour = VERMILION if overturns else GREY if key == "rest" else BLUE
        placed[key] = ax.annotate(
            text, (x, y), ha="center", va="center", fontsize=7, annotation_clip=False,
            bbox={"boxstyle": "round,pad=0.35", "facecolor": "white", "edgecolor": colour, "linewidth": 0.9},
        )  # fmt: skip
    for start, end, text in ARROWS:
        ax.annotate(
            "", BOXES[end][:2], BOXES[start][:2],
            arrowprops={"arrowstyle": "-|>", "patchA": placed[start].get_bbox_patch(),
                        "patchB": placed[end].get_bbox_patch(), "linewidth": 0.8, "color": "black",
                        "shrinkA": 0, "shrinkB": 1},
        )  # fmt: skip
        x, y = (0.5 * (BOXES[start][k] + BOXES[end][k]) for k in (0, 1))
        lift = 0.05 if BOXES[start][1] == BOXES[end][1] else 0.0
        gap = {"facecolor": "white", "edgecolor": "none", "pad": 0.8} if text and not lift else None
        ax.text(x, y + lift, text, ha="center", va="center", fontsize=6.5, color="#333333", bbox=gap)
