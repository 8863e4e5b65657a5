"""The MATLAB code `rock.assets` against this package: `python -m benchmarks.accuracy.rock_assets FOLDER`.

FOLDER is 2020/02/rock.assets/virb of the repository wshwwl/wshwwl.github.com. `ag.mat` holds five records, `4.fig` the
spectrum of one of them, theta/alpha over T = 2 pi/p and alpha. Nothing of it is run: the values of its figure are read.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat

import rocking
from benchmarks.measure import arguments
from rocking._base.constants import STANDARD_GRAVITY

RECORD, STEP, WINDOW = "a4", 0.025, slice(120, 521)
"""The record that the figure fits, its step [s], and the samples that `example.m` takes, 3 to 13 s."""

CRITICAL = 0.315034034
"""Peak of one cosine of 2 s that is printed beside p = 2 rad/s, alpha = 15 deg as next to overturning [g]."""


def critical() -> float:
    """The lowest peak of that cosine that overturns the block here [g]."""
    block = rocking.Block.from_slenderness_angle(np.deg2rad(15), 3 * STANDARD_GRAVITY / (4 * 2.0**2))
    return float(block.thresholds("cosine", period=2.0, highest="0.4 g").lowest) / STANDARD_GRAVITY


def surface(handle: Any) -> list[NDArray[np.float64]] | None:
    """T, alpha and height of the first surface of a figure as scipy reads it."""
    for one in np.atleast_1d(handle):
        found, children = one["properties"], one["children"]
        found = found.item() if found.dtype == object else found
        if "ZData" in (found.dtype.names or ()):
            return [np.asarray(found[name].item(), dtype=np.float64) for name in ("XData", "YData", "ZData")]
        below = children.item() if children.dtype == object and children.ndim == 0 else children
        if np.size(below) and (deeper := surface(below)) is not None:
            return deeper
    return None


if __name__ == "__main__":
    print(f"cosine: overturns from {critical():.9f} g, printed {CRITICAL} g")
    folder = arguments(__doc__, folder=Path).folder
    drawn = surface(loadmat(folder / "4.fig", squeeze_me=True)["hgS_070000"])
    assert drawn is not None
    period, alpha, height = drawn[0], drawn[1][:, None], drawn[2]
    record = rocking.Record(loadmat(folder / "ag.mat", squeeze_me=True)[RECORD][WINDOW], STEP, "g")
    radius = 3 * STANDARD_GRAVITY / 4 * (period / (2 * np.pi)) ** 2
    block = rocking.Block(2 * radius * np.sin(alpha), 2 * radius * np.cos(alpha))
    response = block.response(record, thresholds=False)
    ours = np.where(response.overturned, 1.0, np.minimum(np.nan_to_num(response.rotation / alpha), 1.0))
    apart = ours - height
    fell = (ours > 0.999).sum(), (height > 0.999).sum()
    print(f"{height.size} blocks, overturned {fell[0]} here, {fell[1]} there; median {np.median(abs(apart)):.1e}")
    print(
        f"equal to 0.001: {(abs(apart) < 1e-3).sum()}; more here: {(apart > 1e-3).sum()}, less {(apart < -1e-3).sum()}"
    )
