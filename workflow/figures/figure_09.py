"""Figure 9: overturning of two geometrically similar blocks, two curves in SI units and one in groups."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking._base.arrays import Array
from rocking._boundary.amplitude import thresholds
from rocking._model.block import STANDARD_GRAVITY, RectangularBlock
from rocking._solver.peak_response import peak_response
from rocking.paper.groups import Groups, GroupSet, Problem, groups_of, problem_of_block
from rocking.plot.boundary_lines import Lines
from rocking.plot.style import BLACK, BLUE, GREY, VERMILION, WIDTH
from workflow.figures.boundary_lines import line_variables, lines_of, lines_of_files
from workflow.figures.dimensional import DimensionalProblem
from workflow.figures.style import frame_detail, panel_letters, plotted

HIGHEST = 12.0  # largest amplitude a shown [-], as in figure 4
WIDEST = {"sine": 7.2, "cosine": 6.0}  # largest frequency ratio shown, beyond the tip of the overturning region [-]

FEWEST, NODES = 0.2, 301
"""Smallest frequency ratio shown, and number of grid nodes in each direction for `upper_surviving_region` [-]."""

HALVINGS = 40  # times that the distance of two nodes is halved to find a bound of the upper surviving region [-]
MAIN = 1  # thresholds of overturning after more impacts than this are marked in the inset only [-]
DETAIL = ((0.4, 2.0), (1.03, 1.38))  # limits of omega and of a in the inset of the cosine [-]
STEP = 1e-6  # relative distance from a threshold at which the block is integrated in SI units [-]

COLOURS, SURVIVES = (BLUE, VERMILION), "#D9D9D9"


def data(
    *,
    sine: Path,
    cosine: Path,
    alpha_deg: float,
    half_diagonal: Sequence[float],
    restitution: float,
    period: Sequence[float],
) -> xr.Dataset:
    """The traced boundary, thresholds of each block in SI units, and where blocks pass alpha and survive.

    `sine`, `cosine`: overturning boundaries of this restitution; `alpha_deg`: slenderness angle [deg]
    of all blocks; `half_diagonal`: R [m] of each block; `restitution`: eta [-]; `period`: T_p [s] at which thresholds
    are found and checked.
    """
    alpha = float(np.radians(alpha_deg))
    pulses = ["sine", "cosine"]
    blocks = [RectangularBlock.from_slenderness_angle(alpha, R) for R in half_diagonal]
    rows = [
        {"pulse": i, "block": j, "period": one, **row}
        for i, pulse in enumerate(pulses)
        for j, block in enumerate(blocks)
        for one in period
        for row in block_thresholds(pulse, block, one, restitution)
    ]
    frequency_ratio = np.geomspace(FEWEST, max(WIDEST.values()), NODES)
    survives = np.array([upper_surviving_region(pulse, frequency_ratio, restitution, alpha) for pulse in pulses])
    names = {
        "pulse": ("index of the pulse", "1"),
        "block": ("index of the block", "1"),
        "period": ("period T_p of the pulse", "s"),
        "acceleration": ("threshold a_g", "m s-2"),
        "frequency_ratio": ("frequency ratio omega_g/p of the threshold", "1"),
        "amplitude": ("amplitude a_g/(g tan alpha) of the threshold", "1"),
        "impacts": ("impacts before overturning on the overturning side", "1"),
        "overturns_above": ("whether the block overturns just above, from the groups", "1"),
        "falls_below": ("whether it overturns just below, integrated in SI units", "1"),
        "falls_above": ("whether it overturns just above, integrated in SI units", "1"),
    }
    return xr.Dataset(
        {
            **line_variables(lines_of_files([sine, cosine], [alpha])),
            **{
                f"threshold_{name}": plotted("threshold", [row[name] for row in rows], text, units=units)
                for name, (text, units) in names.items()
            },
            "survives_from": plotted(
                ("pulse", "frequency_ratio"), survives[:, 0], "amplitude from which it passes alpha and survives"
            ),
            "survives_to": plotted(("pulse", "frequency_ratio"), survives[:, 1], "amplitude up to which it does"),
            "frequency_parameter": plotted(
                "block", [block.frequency_parameter for block in blocks], "frequency parameter p", units="rad s-1"
            ),
        },
        coords={
            "frequency_ratio": plotted("frequency_ratio", frequency_ratio, "frequency ratio omega_g/p"),
            "half_diagonal": plotted("block", half_diagonal, "half diagonal R", units="m"),
        },
        attrs={
            "title": "Overturning of two geometrically similar blocks of different size",
            "summary": "Thresholds in SI units, each integrated with its dimensions by (2.2) a relative "
            f"{STEP:g} below and above; and in the groups of (5.3).",
            "pulse_names": " ".join(pulses),
            "alpha": alpha,
            "restitution": restitution,
            "step": STEP,
        },
    )


def upper_surviving_region(pulse: str, frequency_ratio: Array, restitution: float, alpha: float) -> tuple[Array, Array]:
    """The largest range of amplitudes, up to `HIGHEST`, in which a block passes alpha and survives, for each omega.

    Returns `lower`, `upper`: amplitudes a [-], bisected between nodes; nan where no node is inside.
    """

    def recovers(amplitude: Array) -> NDArray[np.bool_]:
        found = peak_response(
            pulse, slenderness=1 / amplitude, frequency_ratio=frequency_ratio, restitution=restitution, alpha=alpha
        )
        return found.exceeded_alpha & ~found.overturned

    nodes = np.geomspace(1, HIGHEST, NODES)
    inside = recovers(nodes[:, None])
    # the longest run of nodes in each column
    run = np.zeros(inside.shape, dtype=int)
    run[0] = inside[0]
    for k in range(1, NODES):
        run[k] = np.where(inside[k], run[k - 1] + 1, 0)
    last, length = run.argmax(axis=0), run.max(axis=0)
    first = last - np.maximum(length, 1) + 1
    ends = []
    for inner, outer in ((first, np.maximum(first - 1, 0)), (last, np.minimum(last + 1, NODES - 1))):
        good, bad = nodes[inner], nodes[outer]
        for _ in range(HALVINGS):
            middle = np.sqrt(good * bad)
            here = recovers(middle)
            good, bad = np.where(here, middle, good), np.where(here, bad, middle)
        ends.append(np.where(length > 0, good, np.nan))
    return ends[0], ends[1]


def block_thresholds(
    pulse: str, block: RectangularBlock, period: float, restitution: float
) -> Iterator[dict[str, Any]]:
    """Peak accelerations at which the outcome of a block changes, from the groups, and outcomes integrated in SI units.

    `period`: T_p [s]; `restitution`: eta [-].
    """
    p, frequency = block.frequency_parameter, 2 * np.pi / period
    groups = groups_of(Problem(block.alpha, p, block.uplift_acceleration, frequency), GroupSet.RIGID)  # (5.3)
    found = thresholds(
        pulse,
        frequency_ratio=float(groups.frequency_ratio),
        restitution=restitution,
        alpha=block.alpha,
        highest=HIGHEST,
    )
    at_threshold = Groups(groups.frequency_ratio, 1 / found.amplitude, groups.cos_alpha)
    problem = problem_of_block(at_threshold, GroupSet.RIGID, alpha=block.alpha, frequency_parameter=p)
    for acceleration, amplitude, above, impacts in zip(
        np.atleast_1d(problem.peak_acceleration), found.amplitude, found.overturns_above, found.impacts, strict=True
    ):
        below, beyond = (
            DimensionalProblem(block, pulse, acceleration * (1 + step), period, restitution, rigid=True).overturns()
            for step in (-STEP, STEP)
        )
        yield {
            "acceleration": float(acceleration),
            "frequency_ratio": float(groups.frequency_ratio),
            "amplitude": float(amplitude),
            "impacts": int(impacts),
            "overturns_above": int(above),
            "falls_below": int(below),
            "falls_above": int(beyond),
        }


def draw(data: xr.Dataset) -> Figure:
    """Above: acceleration against frequency, a curve for each block; below: the groups. One column for each pulse."""
    figure = Figure(figsize=(WIDTH, 6.2))
    axes = figure.subplots(2, 2, sharey="row")
    uplift = np.tan(data.attrs["alpha"])  # in units of g
    p = data.frequency_parameter.values
    for k, (top, bottom, pulse) in enumerate(zip(*axes, data.attrs["pulse_names"].split(), strict=True)):
        lines = lines_of(data, k, data.attrs["alpha"])
        for colour, one in zip(COLOURS, p, strict=True):
            x, y = lines.frequency_ratio * one / (2 * np.pi), lines.amplitude * uplift
            once = np.isfinite(lines.at_level(detail=False).amplitude)
            top.plot(np.where(once, x, np.nan), np.where(once, y, np.nan), color=colour, linewidth=1.0)
        _in_groups(bottom, data, k, lines)
        _markers(top, bottom, data, k, detail=False)
        top.set_title(f"{pulse} pulse")
        top.set_xlabel(r"pulse frequency $1/T_p$ [Hz]")
        bottom.set_xlabel(r"frequency ratio $\omega=\omega_g/p$ [-]")
        bottom.set_xlim(FEWEST, WIDEST[pulse])
        top.set_xlim(FEWEST * p.min() / (2 * np.pi), WIDEST[pulse] * p.max() / (2 * np.pi))
        if pulse == "cosine":
            inset = bottom.inset_axes((0.64, 0.06, 0.35, 0.42))
            _in_groups(inset, data, k, lines, detail=True)
            _markers(None, inset, data, k, detail=True)
            inset.set(xlim=DETAIL[0], ylim=DETAIL[1])
            inset.tick_params(labelsize=6, length=2, pad=1.5)
            frame_detail(bottom, inset)
    for (ax, _), scale in zip(axes, (uplift, 1.0), strict=True):
        ax.set_yscale("log")
        ax.set_ylim(scale, HIGHEST * scale)
    axes[0, 0].set_yticks([0.4, 0.6, 1, 2, 3, 4], labels=["0.4", "0.6", "1", "2", "3", "4"])
    axes[1, 0].set_yticks([1, 2, 3, 4, 6, 8, 12], labels=["1", "2", "3", "4", "6", "8", "12"])
    for ax in axes.ravel():
        ax.minorticks_off()
    axes[0, 0].set_ylabel(r"peak ground acceleration $a_g$ [$g$]")
    axes[1, 0].set_ylabel(r"amplitude $a=a_g/(g\tan\alpha)$ [-]")
    _legend(figure, axes[0, 0], data)
    panel_letters(axes.ravel())
    return figure


def _in_groups(ax: Axes, data: xr.Dataset, pulse: int, lines: Lines, *, detail: bool = False) -> None:
    """The one curve of both blocks, and the region in which they pass alpha and survive.

    `detail`: draw the curves of overturning after two and more impacts too.
    """
    for level in (False, True) if detail else (False,):
        one = lines.at_level(detail=level)
        ax.plot(one.frequency_ratio, one.amplitude, color=BLACK, linewidth=0.6 if level else 1.0)
    ax.fill_between(
        data.frequency_ratio, data.survives_from[pulse], data.survives_to[pulse], color=SURVIVES, linewidth=0, zorder=0
    )


def _markers(top: Axes | None, bottom: Axes, data: xr.Dataset, pulse: int, *, detail: bool) -> None:
    """Half-filled on the side on which the block overturns in SI units; a cross if both sides have the same outcome."""
    several = (data.threshold_impacts.values > MAIN) | (data.threshold_impacts.values < 0)
    shown = (data.threshold_pulse.values == pulse) & (several <= detail)
    for k in np.flatnonzero(shown):
        one = data.isel(threshold=k)
        below, above = bool(one.threshold_falls_below), bool(one.threshold_falls_above)
        size = 3.2 if detail else 4.4
        style = {"color": COLOURS[int(one.threshold_block)], "markersize": size, "markeredgewidth": 0.6, "zorder": 4}
        style |= {"marker": "x"} if below == above else {
            "marker": "o", "fillstyle": "top" if above else "bottom", "markerfacecoloralt": "white"
        }  # fmt: skip
        if top is not None:
            top.plot(1 / one.threshold_period, one.threshold_acceleration / STANDARD_GRAVITY, **style)
        bottom.plot(one.threshold_frequency_ratio, one.threshold_amplitude, **style)


def _legend(figure: Figure, ax: Axes, data: xr.Dataset) -> None:
    for colour, R in zip(COLOURS, data.half_diagonal.values, strict=True):
        ax.plot([], [], color=colour, label=rf"$R={R:g}$ m")
    marker = {"color": GREY, "linestyle": "", "marker": "o", "markersize": 5, "markerfacecoloralt": "white"}
    ax.plot([], [], fillstyle="top", label="in SI units: overturns above", **marker)
    ax.plot([], [], fillstyle="bottom", label="overturns below", **marker)
    ax.fill_between([], [], color=SURVIVES, label=r"passes $\alpha$ and survives")
    figure.legend(*ax.get_legend_handles_labels(), loc="outside upper center", ncols=5)
