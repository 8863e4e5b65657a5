"""Boundary curves against thresholds on random lines omega = const: `python -m benchmarks.accuracy.boundary_lines`.

Every threshold of `thresholds` should lie on a curve of `overturning_boundary`, within its chord error, and at
every crossing of a line with a curve the outcome should change. `thresholds` does not use the curves. A
threshold without a curve belongs to a region that the nodes did not show, or to one below the stated resolution;
`few` counts those of overturning after at most twelve impacts, and `widest` is the largest distance from such a
threshold to the next one, of the lines that have another one.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import rocking
from benchmarks.measure import arguments
from rocking._boundary.search import MANY_IMPACTS
from rocking._boundary.tracer import END
from rocking._model.response import Outcome

Array = NDArray[np.float64]

CLOSER = (2001, 200_001)
"""Points at which a change of outcome is looked for at a crossing; the more where the fewer show none [-]."""


class Chords:
    """The chords of boundary curves, in the plane of 1/a and log omega."""

    def __init__(self, curves: xr.Dataset) -> None:
        sizes = curves.row_size.values
        points = np.stack([curves.slenderness.values, np.log(curves.frequency_ratio.values)])
        first = np.delete(np.arange(points.shape[1]), np.cumsum(sizes) - 1)
        self.start, self.end = points[:, first], points[:, first + 1]
        self.to_safety = np.repeat(curves.neighbour_outcome.values <= Outcome.RECOVERS, sizes)[first]

    def distance(self, x: float, y: float) -> float:
        """Distance of a point from the nearest chord."""
        chord, offset = self.end - self.start, np.array([[x], [y]]) - self.start
        share = np.clip((offset * chord).sum(axis=0) / np.maximum((chord**2).sum(axis=0), 1e-300), 0.0, 1.0)
        return float(np.hypot(*(offset - share * chord)).min())

    def crossings(self, y: float) -> tuple[Array, Array]:
        """1/a at which a line log omega = y crosses chords between overturning and survival, and their slopes."""
        step = self.end[1] - self.start[1]
        cut = np.flatnonzero(((self.start[1] - y) * (self.end[1] - y) < 0.0) & self.to_safety)
        slope = (self.end[0] - self.start[0])[cut] / step[cut]
        return self.start[0, cut] + slope * (y - self.start[1, cut]), slope


def compare(
    pulse: str,
    alpha: float | None,
    nodes: int,
    lines: int,
    restitution: float,
    ratios: tuple[float, float] = (0.2, 15.0),
) -> dict[str, float]:
    """Trace curves and compare them with thresholds on random lines, whose frequency ratio is between `ratios`."""
    curves = rocking.overturning_boundary(pulse, restitution=restitution, alpha=alpha, nodes=nodes)
    chords = Chords(curves)
    limits = curves.chord_error + 1.1 * END, curves.uncounted_chord_error + 1.1 * curves.end_distance
    thresholds = unlisted = few = crossings = wrong = 0
    widest = 0.0
    groups = {"restitution": restitution, "alpha": alpha}
    for y in np.random.default_rng(1).uniform(*np.log(ratios), lines):
        omega = float(np.exp(y))
        on_line = rocking.thresholds(pulse, frequency_ratio=omega, **groups, highest=50.0)
        found = 1.0 / on_line.amplitude
        thresholds += found.size
        for k, (x, impacts) in enumerate(zip(found, on_line.impacts, strict=True)):
            if chords.distance(x, y) > limits[int(impacts > MANY_IMPACTS)]:
                unlisted += 1
                few += int(impacts <= MANY_IMPACTS)
                others = np.delete(found, k)
                if others.size:
                    widest = max(widest, np.abs(others - x).min())
        x, slope = chords.crossings(y)
        crossings += x.size
        for points in CLOSER:
            reach = 1.1 * curves.chord_error * np.hypot(1.0, slope) * np.linspace(-1.0, 1.0, points)[:, None]
            overturned = rocking.peak_response(
                pulse, slenderness=np.clip(x + reach, 1e-3, 1.0), frequency_ratio=omega, **groups
            ).overturned
            alike = overturned.all(axis=0) | ~overturned.any(axis=0)
            x, slope = x[alike], slope[alike]
        wrong += x.size
    sizes = curves.row_size.values
    return {
        "curves": sizes.size, "short": int((sizes < 6).sum()),
        "thresholds": thresholds, "unlisted": unlisted, "few": few, "widest": widest,
        "crossings": crossings, "wrong": wrong,
    }  # fmt: skip


if __name__ == "__main__":
    options = arguments(
        __doc__, lines=400, restitution=0.85, nodes=301, pulses=["sine", "cosine"], degrees=[0.0, 10.0, 20.0, 30.0]
    )
    for pulse, degrees in product(options.pulses, options.degrees):
        alpha = float(np.radians(degrees)) or None
        found = compare(pulse, alpha, options.nodes, options.lines, options.restitution)
        print(
            f"{pulse} {degrees:g} deg:", ", ".join(f"{name} {value:.3g}" for name, value in found.items()), flush=True
        )
