"""Figures 11 and 12: histories of blocks of different shape, in the groups of (4.11) and in those of (6.1)."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from rocking._history.time_history import time_history
from rocking.paper.groups import Groups, GroupSet, groups_of, problem_of_block, scaled_rotation
from rocking.plot.style import GREY, WIDTH, shades
from workflow.figures.style import panel_letters, plotted

GROUP_SETS = (GroupSet.SLENDER_BY_PULSE, GroupSet.RIGID_SMALL_ROTATION)
SAMPLES = 900


def data(
    *,
    pulses: Sequence[str],
    restitution: float,
    alpha_deg: Sequence[float],
    slenderness: float,
    frequency_ratio: float,
    duration: float,
) -> xr.Dataset:
    """Rotations by (2.2) of blocks that share the groups of (4.11), then of blocks that share those of (6.1).

    `restitution`: eta [-]; `alpha_deg`: slenderness angles [deg], > 0; `slenderness`, `frequency_ratio`: the group 1/a
    and omega [-]: g alpha/a_g in the first set, g tan(alpha)/a_g in the second; `duration`: tau = p t at the end [-].
    """
    tau = np.linspace(0.0, duration, SAMPLES)
    angles = np.radians(alpha_deg)
    shared = Groups(frequency_ratio, slenderness)

    def rotation(pulse: str, group_set: GroupSet, alpha: float) -> np.ndarray:
        # the size of the block enters omega only: any p gives the same history
        problem = problem_of_block(shared, group_set, alpha=alpha, frequency_parameter=1.0)
        found = time_history(
            pulse,
            slenderness=float(groups_of(problem, GroupSet.RIGID).slenderness),  # g tan(alpha)/a_g, the group of (2.2)
            frequency_ratio=frequency_ratio,
            restitution=restitution,
            alpha=alpha,
            duration=duration,
            samples=SAMPLES,
        )
        scaled = scaled_rotation(alpha * found.rotation, problem, group_set)
        return np.interp(tau, found.tau, scaled, right=np.nan)  # the history of a block ends where it overturns

    def master(pulse: str) -> np.ndarray:
        groups = {"slenderness": slenderness, "frequency_ratio": frequency_ratio, "restitution": restitution}
        found = time_history(pulse, **groups, duration=duration, samples=SAMPLES)
        return np.interp(tau, found.tau, slenderness * found.rotation, right=np.nan)

    blocks = np.array([[[rotation(p, group_set, a) for a in angles] for group_set in GROUP_SETS] for p in pulses])
    slender = np.array([master(pulse) for pulse in pulses])
    spread = np.ptp(blocks, axis=2).max(axis=-1) / np.abs(slender).max(axis=-1)[:, None]
    return xr.Dataset(
        {
            "rotation": plotted(
                ("pulse", "group_set", "alpha", "tau"),
                blocks,
                "g theta/a_g in the first set of groups, g theta/(a_g cos alpha) in the second",
                equation="4.11, 6.1",
            ),
            "slender_rotation": plotted(("pulse", "tau"), slender, "g theta/a_g of the slender block", equation="4.1"),
            "spread": plotted(
                ("pulse", "group_set"),
                spread,
                "largest difference of two blocks at one time, shifts of phase included, over the slender peak",
            ),
        },
        coords={
            "alpha": plotted("alpha", angles, "slenderness angle", units="rad"),
            "tau": plotted("tau", tau, "time p t since the start of the pulse"),
        },
        attrs={
            "title": f"Histories of blocks of different shape, slenderness group {slenderness:g}",
            "summary": "Blocks with equal groups of (4.11), then blocks with equal groups of (6.1); motion by (2.2).",
            "pulse_names": " ".join(pulses),
            "group_sets": " ".join(group_set.value for group_set in GROUP_SETS),
            "slenderness": slenderness,
            "frequency_ratio": frequency_ratio,
            "restitution": restitution,
        },
    )


def draw(data: xr.Dataset) -> Figure:
    """Left: groups of (4.11); right: groups of (6.1). One row for each pulse; the slender block in pale grey."""
    pulses = data.attrs["pulse_names"].split()
    figure = Figure(figsize=(WIDTH, 1.0 + 1.7 * len(pulses)))
    axes = figure.subplots(len(pulses), 2, sharex=True, sharey="row", squeeze=False)
    s = f"{data.attrs['slenderness']:g}"
    shared = (rf"all $g\alpha/a_g={s}$", rf"all $g\tan\alpha/a_g={s}$")
    labels = (r"$g\theta/a_g$ [-]", r"$g\theta/(a_g\cos\alpha)$ [-]")
    for i, (row, pulse) in enumerate(zip(axes, pulses, strict=True)):
        for j, ax in enumerate(row):
            ax.plot(data.tau, data.slender_rotation[i], color="#C8C8C8", linewidth=3.5, label="slender limit")
            for colour, alpha in zip(shades(data.alpha.size), data.alpha.values, strict=True):
                text = rf"$\alpha={np.degrees(alpha):.0f}$°"
                ax.plot(data.tau, data.rotation[i, j].sel(alpha=alpha), color=colour, linewidth=0.9, label=text)
            ax.axhline(0, color=GREY, linewidth=0.5)
            ax.set_title(f"{pulse}, {shared[j]}, spread {100 * float(data.spread[i, j]):.0f} %", loc="right")
            ax.set_ylabel(labels[j])
            ax.yaxis.set_tick_params(labelleft=True)
    for ax in axes[-1]:
        ax.set_xlabel(r"time since the start of the pulse $\tau=pt$ [-]")
        ax.set_xlim(0, float(data.tau.max()))
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=1 + data.alpha.size)
    panel_letters(axes.ravel())
    return figure
