"""Additional figure: the scaling of peak rotation with eta squared, (4.16), under every pulse and under records."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from string import ascii_lowercase
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from rocking._base.arrays import Array
from rocking._excitation.pulses import PULSE_NAMES
from rocking._excitation.records.readers.read_record import read_record
from rocking._solver.peak_response import peak_response
from rocking._solver.records.record_response import record_response
from rocking.paper.scale_law import largest_deviation, restitution_exponent
from rocking.plot.style import WIDTH
from workflow.claims.area import node_areas, share_of_area
from workflow.figures.style import panel_letters, plotted

MOTIONS = Path(__file__).parents[1] / "motions"
LAW = 0.10  # error up to which the law is said to hold [-]
LEVELS = (0.003, 0.01, 0.03, LAW, 0.3, 1.0)  # of the colours of the error [-]
COLOURS = ("#08306B", "#2171B5", "#6BAED6", "#C6DBEF", "#FDBE85", "#E6550D", "#7F2704")  # blue where the law holds
OVERTURNS = "#DDDDDD"


class Axis(NamedTuple):
    """The axis across a panel: omega_g/p of a pulse, p of a record."""

    name: str
    label: str
    ticks: tuple[float, ...]


ACROSS = {
    "pulse": Axis("frequency_ratio", r"$\omega_g/p$ [-]", (0.5, 1, 2, 5, 10)),
    "record": Axis("frequency_parameter", r"$p$ [rad/s]", (1, 2, 4, 8)),
}


def data(
    *,
    records: Sequence[str],
    restitution: Sequence[float],
    reference: float,
    slenderness: Mapping[str, float],
    frequency_ratio: Mapping[str, float],
    frequency_parameter: Mapping[str, float],
) -> xr.Dataset:
    """Errors of the law and exponents under each excitation, where the slender block survives for every restitution.

    `records`: files of `workflow/motions`; `restitution`: eta [-]; `reference`: the eta from which
    the law predicts the other peaks [-]. Low, high and points of the axes: `slenderness` [-], g alpha/a_g, for records
    with their peak ground acceleration in place of a_g, in equal steps; `frequency_ratio` [-] for pulses and
    `frequency_parameter` p [rad/s] for records, in equal ratios.
    """
    s = np.linspace(slenderness["low"], slenderness["high"], int(slenderness["points"]))
    eta = np.array(restitution)
    omega, p = (
        np.geomspace(axis["low"], axis["high"], int(axis["points"])) for axis in (frequency_ratio, frequency_parameter)
    )
    blocks = {"slenderness": s[:, None], "restitution": eta[:, None, None]}
    peaks = {
        "pulse": [peak_response(name, frequency_ratio=omega, **blocks).peak_rotation for name in PULSE_NAMES],
        "record": [
            record_response(read_record(MOTIONS / name), frequency_parameter=p, **blocks).peak_rotation
            for name in records
        ],
    }
    nodes = {"pulse": omega, "record": p}
    variables, summary = {}, []
    for kind, found in peaks.items():
        errors, exponents, rows = zip(*_judged(found, eta, reference, node_areas(s, nodes[kind])), strict=True)
        dims = (kind, "slenderness", ACROSS[kind].name)
        variables[f"{kind}_deviation"] = plotted(
            dims, errors, "largest relative error over eta, predicted from the reference eta", equation="4.16"
        )
        variables[f"{kind}_exponent"] = plotted(dims, exponents, "exponent n of peak = constant eta^n", equation="4.16")
        summary += rows
    share, median = np.transpose(summary)
    return xr.Dataset(
        {
            **variables,
            "share": plotted("excitation", share, f"share of the surviving area with an error up to {LAW:g}"),
            "median_exponent": plotted("excitation", median, "median exponent over that area"),
        },
        coords={
            "slenderness": plotted("slenderness", s, "g alpha over the peak ground acceleration"),
            "frequency_ratio": plotted("frequency_ratio", omega, "frequency ratio omega_g/p"),
            "frequency_parameter": plotted("frequency_parameter", p, "frequency parameter p", units="rad s-1"),
        },
        attrs={
            "title": "Error of the scale law for the coefficient of restitution, nine pulses and recorded motions",
            "summary": f"Peak rotation of slender blocks against eta squared for eta from {eta.min()} to {eta.max()}, "
            f"relative to eta = {reference}; missing where the block overturns for one of them or does not uplift.",
            "excitation_names": " ".join([*PULSE_NAMES, *(Path(name).stem for name in records)]),
            "restitution": eta,
            "reference": reference,
        },
    )


def _judged(
    found: Sequence[Array], eta: Array, reference: float, areas: Array
) -> Iterator[tuple[Array, Array, tuple[float, float]]]:
    """Errors and exponents (slenderness, across) of each excitation; its share and its median exponent."""
    for peak in found:
        survives = np.isfinite(peak).all(axis=0) & (peak > 0).all(axis=0)
        kept = np.where(survives, peak, np.nan)
        error, exponent = largest_deviation(kept, eta, reference=reference), restitution_exponent(kept, eta)
        held = np.nan_to_num(error, nan=np.inf) <= LAW
        yield error, exponent, (share_of_area(held, survives, areas), float(np.nanmedian(exponent)))


def draw(data: xr.Dataset) -> Figure:
    """A map of the error for each excitation, and the share of area on which the law holds beside the exponents."""
    names = data.attrs["excitation_names"].split()
    rows = -(-(len(names) + 1) // 3)
    figure = Figure(figsize=(WIDTH, 0.6 + 1.65 * rows))
    axes = figure.subplots(rows, 3).ravel()
    maps = [(kind, one) for kind in ACROSS for one in data[f"{kind}_deviation"]]
    for k, (ax, name, (kind, error)) in enumerate(zip(axes, names, maps, strict=False)):
        mesh = _map(ax, data, kind, error)
        ax.set_title(name.replace("_", " "), loc="right")
        if k % 3 == 0:
            ax.set_ylabel(r"$a=a_g/(g\alpha)$ [-]")
    _summary(axes[len(names)], names, data)
    for ax in axes[len(names) + 1 :]:
        ax.set_axis_off()
    bar = figure.colorbar(mesh, ax=axes, location="top", extend="both", aspect=60, pad=0.01, ticks=LEVELS)
    bar.ax.set_xticklabels([f"{100 * level:g}" for level in LEVELS])
    bar.set_label(rf"largest error of the scaling with $\eta^2$ from $\eta={data.attrs['reference']:.2f}$ [%]")
    panel_letters(axes[: len(names) + 1])
    return figure


def _map(ax: Axes, data: xr.Dataset, kind: str, error: xr.DataArray) -> Any:
    across = ACROSS[kind]
    ax.set_facecolor(OVERTURNS)
    mesh = ax.pcolormesh(
        data[across.name], 1 / data.slenderness, error, cmap=ListedColormap(COLOURS),
        norm=BoundaryNorm(LEVELS, len(COLOURS), extend="both"), rasterized=True, shading="nearest",
    )  # fmt: skip
    ax.set(xscale="log", yscale="log", xlabel=across.label, ylim=(1.02, 12.0))
    ax.set_xticks(across.ticks, labels=[f"{tick:g}" for tick in across.ticks])
    ax.set_yticks([1.2, 2, 3, 5, 10], labels=["1.2", "2", "3", "5", "10"])
    ax.minorticks_off()
    return mesh


def _summary(ax: Axes, names: Sequence[str], data: xr.Dataset) -> None:
    place = np.arange(len(names))
    ax.barh(place, 100 * data.share, color=COLOURS[1], height=0.7)
    ax.set(xlim=(0, 100), ylim=(len(names) - 0.5, -0.5), xlabel=f"area with an error up to {100 * LAW:g} % [%]")
    ax.set_title("median exponent", loc="right")
    ax.set_yticks(place, labels=[f"({letter})" for letter in ascii_lowercase[: len(names)]])
    ax.tick_params(axis="y", length=0, labelsize=5, pad=1)
    for k, exponent in enumerate(data.median_exponent.values):
        ax.text(99, k, f"{round(exponent, 1) + 0.0:.1f}", fontsize=5.5, ha="right", va="center")
