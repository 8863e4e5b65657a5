"""Master spectra: peak rotation over the whole control plane in the groups of (6.1), for blocks of any slenderness."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from rocking._boundary.tracing import boundaries_at_angles
from rocking._model.block import RectangularBlock
from rocking._solver.peak_response import peak_response
from rocking.plot.boundary_lines import Lines, draw_lines, outcome_lines
from rocking.plot.style import BLACK, WIDTH, shades
from workflow.figures.boundary_lines import line_variables, lines_of, lines_of_files
from workflow.figures.figure_13 import scale_of
from workflow.figures.style import panel_letters, plotted

PULSES = ("sine", "cosine")

PEAKS = (0.003, 1.0)  # range of the colours of the peaks [-]
SPREADS = {"one": (0.1, 100.0), "each": (10.0, 300.0)}
"""Range of the colours of the spread [%], for one restitution and for that of each angle."""

NODES = 81  # nodes in each direction of the grid from which boundaries are traced where no file holds them

OVERTURNS = "#E3E3E3"


def data(
    *,
    alpha_deg: Sequence[float],
    slenderness: Mapping[str, float],
    frequency_ratio: Mapping[str, float],
    restitution: float | None = None,
    **files: Path,
) -> xr.Dataset:
    """Peaks of each angle on a grid, their spread over the angles, and the boundaries of overturning.

    `alpha_deg`: slenderness angles [deg] beside the slender limit. `slenderness`, `frequency_ratio`: low, high [-] and
    points of the axes g tan(alpha)/a_g, in equal steps, and omega_g/p, in equal ratios. `restitution`: eta [-] of all
    blocks; by default that of Housner for the angle of each, (2.4), 1 in the slender limit. **files: traced boundaries
    of this restitution for sine and cosine; without them they are traced.
    """
    angles = np.array([0.0, *np.radians(alpha_deg)])
    eta = np.full(angles.size, restitution) if restitution is not None else housner_restitutions(angles)
    s = np.linspace(slenderness["low"], slenderness["high"], int(slenderness["points"]))
    omega = np.geomspace(frequency_ratio["low"], frequency_ratio["high"], int(frequency_ratio["points"]))
    peaks = np.array([[_peaks(pulse, s, omega, *block) for block in zip(eta, angles, strict=True)] for pulse in PULSES])
    lines = (
        lines_of_files([files[pulse] for pulse in PULSES], angles.tolist()) if files else _traced(s, omega, eta, angles)
    )
    dims = ("pulse", "slenderness", "frequency_ratio")
    return xr.Dataset(
        {
            "spectrum": plotted(
                ("pulse", "alpha", *dims[1:]), peaks, "g theta_max/(a_g cos alpha)", equation="6.1",
                comment="missing where the block overturns",
            ),
            "spread": plotted(
                dims, spread_of(peaks), "range over alpha, relative to the slender block",
                comment="missing where a block overturns or none uplifts",
            ),
            "restitution": plotted("alpha", eta, "coefficient of restitution", equation="2.4"),
            **line_variables(lines),
        },
        coords={
            "alpha": plotted("alpha", angles, "slenderness angle, 0 for the slender limit", units="rad"),
            "slenderness": plotted("slenderness", s, "dimensionless slenderness g tan(alpha)/a_g"),
            "frequency_ratio": plotted("frequency_ratio", omega, "frequency ratio omega_g/p"),
        },
        attrs={
            "title": "Master spectra: peak rotation of blocks of any slenderness",
            "summary": "Peak rotation over the whole response in the groups of (6.1), motion by (2.2), its spread over "
            "the slenderness angles, and the boundaries of overturning.",
            "pulse_names": " ".join(PULSES),
        },
    )  # fmt: skip


def spread_of(peaks: np.ndarray) -> np.ndarray:
    """Range over the angles, axis 1, relative to the slender block, the first [-]; nan where none rotates."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.ptp(peaks, axis=1) / peaks[:, 0])


def housner_restitutions(angles: np.ndarray) -> np.ndarray:
    """Restitution of rectangular blocks (2.4) [-]; 1 in the slender limit, angle 0."""
    return np.array(
        [RectangularBlock.from_slenderness_angle(a, 1.0).momentum_restitution if a else 1.0 for a in angles.tolist()]
    )


def _peaks(pulse: str, s: np.ndarray, omega: np.ndarray, eta: float, alpha: float) -> np.ndarray:
    found = peak_response(
        pulse, slenderness=s[:, None], frequency_ratio=omega, restitution=eta, alpha=float(alpha) or None
    )
    return found.peak_rotation * s[:, None] * scale_of(np.array(alpha))


def _traced(
    s: np.ndarray, omega: np.ndarray, eta: np.ndarray, angles: np.ndarray
) -> Iterator[tuple[int, float, Lines]]:
    window = (omega[0], omega[-1]), (s[0], min(s[-1], 1.0))
    blocks = [(one, alpha, NODES) for one, alpha in zip(eta.tolist(), angles.tolist(), strict=True)]
    for k, pulse in enumerate(PULSES):
        for (_, alpha, _), curves in zip(blocks, boundaries_at_angles(pulse, blocks, *window), strict=True):
            yield k, alpha, outcome_lines(curves)


def draw(data: xr.Dataset) -> Figure:
    """For each pulse a map for each angle, one of the spread, and the boundaries of all angles."""
    count, columns = data.alpha.size + 2, 3
    rows = -(-count // columns)
    height = 1.3 * 2 * rows
    figure = Figure(figsize=(WIDTH, height + 0.85))
    top, bottom = figure.subfigures(2, 1, height_ratios=[height, 0.85])
    axes = top.subplots(2 * rows, columns, sharex=True, sharey=True)
    for i, (panels, pulse) in enumerate(zip(axes.reshape(2, -1), data.attrs["pulse_names"].split(), strict=True)):
        for ax, alpha in zip(panels, data.alpha.values, strict=False):
            peaks = _map(ax, data, data.spectrum[i].sel(alpha=alpha), PEAKS, "viridis_r")
            lines = lines_of(data, i, alpha)
            draw_lines(ax, lines.frequency_ratio, 1 / lines.amplitude, lines, color=BLACK, linewidth=0.7)
            ax.set_title(f"{pulse}, {_named(data, alpha)}", loc="right", fontsize=7)
        range_ = SPREADS["each" if np.ptp(data.restitution.values) > 0 else "one"]
        spread = _map(panels[count - 2], data, 100 * data.spread[i], range_, "magma_r")
        panels[count - 2].set_title(f"{pulse}, spread", loc="right", fontsize=7)
        _contours(panels[count - 1], data, i)
        panels[count - 1].set_title(f"{pulse}, all boundaries", loc="right", fontsize=7)
        for ax in panels[count:]:
            ax.set_axis_off()
    _label(axes, data)
    panel_letters([ax for panels in axes.reshape(2, -1) for ax in panels[:count]])
    bars = bottom.subplots(1, 2, width_ratios=[1, 1])
    for bar, mesh, label in zip(
        bars, (peaks, spread), (r"$g\,\theta_{\max}/(a_g\cos\alpha)$ [-]", r"spread over $\alpha$ [%]"), strict=True
    ):
        bottom.colorbar(mesh, cax=bar, orientation="horizontal", extend="both", label=label)
    handles, labels = axes.reshape(2, -1)[0, count - 1].get_legend_handles_labels()
    bottom.legend(handles, labels, loc="outside upper center", ncols=len(labels), handlelength=1.4, columnspacing=1.2)
    return figure


def _named(data: xr.Dataset, alpha: float) -> str:
    eta = float(data.restitution.sel(alpha=alpha))
    block = "slender" if alpha == 0.0 else rf"$\alpha={np.degrees(alpha):.0f}$°"
    return rf"{block}, $\eta={eta:.2f}$"


def _map(ax: Axes, data: xr.Dataset, values: xr.DataArray, limits: tuple[float, float], colours: str) -> Any:
    ax.set_facecolor(OVERTURNS)
    return ax.pcolormesh(
        data.frequency_ratio, data.slenderness, values, cmap=colours, norm=LogNorm(*limits), rasterized=True,
        shading="nearest",
    )  # fmt: skip


def _contours(ax: Axes, data: xr.Dataset, pulse: int) -> None:
    angles = data.alpha.values
    for colour, alpha in zip([BLACK, *shades(angles.size - 1)], angles, strict=True):
        lines = lines_of(data, pulse, alpha)
        label = "slender limit" if alpha == 0.0 else rf"{np.degrees(alpha):.0f}°"
        style = {"color": colour, "label": label, "linewidth": 1.1 if alpha == 0.0 else 0.7}
        draw_lines(ax, lines.frequency_ratio, 1 / lines.amplitude, lines, **style)


def _label(axes: np.ndarray, data: xr.Dataset) -> None:
    first = axes[0, 0]
    first.set_xscale("log")
    first.set_xlim(float(data.frequency_ratio[0]), float(data.frequency_ratio[-1]))
    first.set_ylim(float(data.slenderness[0]), float(data.slenderness[-1]))
    first.set_xticks([0.5, 1, 2, 5, 10], labels=["0.5", "1", "2", "5", "10"])
    first.set_yticks([0.2, 0.4, 0.6, 0.8, 1.0])
    first.minorticks_off()
    for ax in axes[-1]:
        ax.set_xlabel(r"$\omega=\omega_g/p$ [-]")
    for ax in axes[:, 0]:
        ax.set_ylabel(r"$g\tan\alpha/a_g$ [-]")
