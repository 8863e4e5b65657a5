"""Rocking spectra as curves that end where the block overturns, sampled with the solver.

A curve is the peak rotation over the frequency ratio on one connected range of it on which the block survives. Curves
of many blocks stand one after the other, `row_size` points each, as in the files of overturning boundaries.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import xarray as xr

from rocking._base.arrays import Array
from rocking._boundary.frequency import critical_frequency_ratio
from rocking._boundary.search import RESOLUTION
from rocking._solver.peak_response import peak_response
from workflow.figures.style import plotted

STRAIGHT = 5e-4  # largest distance between a curve and the straight line between two of its points, in theta/alpha [-]
FIRST_POINTS = 200  # points per decade of omega from which the sampling starts [-]
ROUNDS = 40  # times that intervals are halved: the shortest one is far below the resolution of the boundary [-]


class SpectrumBlock(NamedTuple):
    """What a spectrum is computed for."""

    pulse: str
    slenderness: float  # g tan(alpha)/a_g [-]
    restitution: float  # eta [-]
    alpha: float = 0.0  # slenderness angle [rad], 0 for the slender limit


class Branch(NamedTuple):
    """One connected part of a spectrum."""

    frequency_ratio: Array  # omega, ascending [-]
    peak: Array  # max |theta|/alpha [-]
    overturns_beyond: tuple[bool, bool]  # whether the block overturns beyond its lower and its upper end


def peaks(block: SpectrumBlock, frequency_ratio: Array) -> Array:
    """max |theta|/alpha [-] of a block at several omega, nan where it overturns."""
    return peak_response(
        block.pulse,
        slenderness=block.slenderness,
        frequency_ratio=frequency_ratio,
        restitution=block.restitution,
        alpha=block.alpha or None,
    ).peak_rotation


def branches(block: SpectrumBlock, window: tuple[float, float]) -> list[Branch]:
    """Every range of omega in `window` on which the block survives, sampled until it is straight between its points."""
    found = critical_frequency_ratio(
        block.pulse,
        slenderness=block.slenderness,
        restitution=block.restitution,
        window=window,
        alpha=block.alpha or None,
    )
    edges = [window[0], *found.frequency_ratio, window[1]]
    overturns = [found.overturns_at_ends[0], *found.overturns_above]
    return [
        sampled(block, (low, high), (k > 0, k < len(overturns) - 1))
        for k, ((low, high), inside) in enumerate(zip(pairwise(edges), overturns, strict=True))
        if not inside
    ]


def sampled(block: SpectrumBlock, ends: tuple[float, float], overturns_beyond: tuple[bool, bool]) -> Branch:
    """The points of one branch; at an end beyond which the block overturns, the last point at which it survives."""
    low, high = (
        _last_surviving(block, end, inwards) if beyond else end
        for end, inwards, beyond in zip(ends, (1, -1), overturns_beyond, strict=True)
    )
    x = np.linspace(np.log(low), np.log(high), 3 + int(FIRST_POINTS * np.log10(high / low)))
    x[[0, -1]] = np.log([low, high])
    omega = np.exp(x)
    omega[[0, -1]] = low, high  # exactly: rounding must not lead across the boundary
    y = peaks(block, omega)
    bent = np.ones(omega.size - 1, dtype=bool)
    for _ in range(ROUNDS):
        at = np.flatnonzero(bent)
        if not at.size:
            break
        middle = np.sqrt(omega[at] * omega[at + 1])
        value = peaks(block, middle)
        split = np.abs(value - 0.5 * (y[at] + y[at + 1])) > STRAIGHT
        # both halves of an interval that is not straight are examined again
        bent = np.insert(np.isin(np.arange(omega.size - 1), at[split]), at[split], True)
        omega, y = np.insert(omega, at[split] + 1, middle[split]), np.insert(y, at[split] + 1, value[split])
    return Branch(omega, y, overturns_beyond)


def _last_surviving(block: SpectrumBlock, boundary: float, inwards: int) -> float:
    """The point next to the boundary at which the block survives, at a few times its resolution at most."""
    omega = boundary * (1 + inwards * RESOLUTION * 2.0 ** np.arange(10))
    return float(omega[np.flatnonzero(np.isfinite(peaks(block, omega)))[0]])


def curve_variables(
    blocks: Sequence[SpectrumBlock], window: Mapping[str, float], scale: Sequence[float]
) -> dict[str, xr.Variable]:
    """The spectra of several blocks as variables over `curve` and `point`.

    `window`: low and high of omega [-]; `scale`: factor of max |theta|/alpha for each block [-].
    """
    limits = window["low"], window["high"]
    found = [(k, branch) for k, block in enumerate(blocks) for branch in branches(block, limits)]
    pulses = list(dict.fromkeys(block.pulse for block in blocks))
    curves = [(blocks[k], branch) for k, branch in found]
    ends = np.array([branch.overturns_beyond for _, branch in curves], dtype=np.int8)
    omega = np.concatenate([branch.frequency_ratio for _, branch in curves])
    scaled = np.concatenate([scale[k] * branch.peak for k, branch in found])
    over_curves = {
        "curve_pulse": ([pulses.index(block.pulse) for block, _ in curves], "index of the pulse"),
        "curve_slenderness": ([block.slenderness for block, _ in curves], "g tan(alpha)/a_g"),
        "curve_restitution": ([block.restitution for block, _ in curves], "coefficient of restitution"),
        "overturns_below": (ends[:, 0], "whether the block overturns below the first point"),
        "overturns_above": (ends[:, 1], "whether the block overturns above the last point"),
    }
    alpha = [block.alpha for block, _ in curves]
    sizes = [branch.peak.size for _, branch in curves]
    return {name: plotted("curve", values, text) for name, (values, text) in over_curves.items()} | {
        "curve_alpha": plotted("curve", alpha, "slenderness angle, 0: slender", units="rad"),
        "row_size": plotted("curve", sizes, "number of points of the curve", sample_dimension="point"),
        "frequency_ratio": plotted("point", omega, "frequency ratio omega_g/p"),
        "spectrum": plotted("point", scaled, "peak rotation in the groups of the figure"),
    }


def rows_of(data: xr.Dataset, **labels: float) -> list[xr.Dataset]:
    """The curves whose labels, such as `pulse=0` or `alpha=0.1`, are equal to these: a data set of points for each."""
    wanted = np.all([data[f"curve_{name}"].values == value for name, value in labels.items()], axis=0)
    ends = np.cumsum(data.row_size.values)
    starts = ends - data.row_size.values
    return [data.isel(curve=k, point=slice(starts[k], ends[k])) for k in np.flatnonzero(wanted)]
