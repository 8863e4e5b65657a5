"""Calibration of `rocking_assessment.unexceeded`: `python -m benchmarks.accuracy.unexceeded`.

Synthetic records, filtered noise in an envelope, are scaled to factors from uplift to ten times it. Suites are drawn
from them; the share of the other records that overturn the block at the PGA that the suite states for their PGV/PGA is
counted, where it is within the factors that were tried.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rocking_assessment._evidence.old_rocks import FEWEST, _line, _Outcomes, _outcomes

import rocking
from benchmarks.measure import arguments

SUITES = {5: 200, 8: 120, 12: 100, 20: 60, 30: 60, 60: 30, 100: 20, 200: 10, 500: 6}
"""Number of suites for each number of records."""


class Library(NamedTuple):
    """Records by ln(PGV/PGA), and their outcomes."""

    ratio: NDArray[np.float64]
    outcomes: _Outcomes


class Coverage(NamedTuple):
    """Records that overturn over those for which a pair is stated, of all suites, and the least share of a suite.

    And the share of the records for which a pair is stated.
    """

    overturned: float
    least: float
    stated: float


def record(seed: int) -> rocking.Record:
    """Noise of 0.4 to 4 Hz and 8 to 25 s in an envelope."""
    draw = np.random.default_rng(seed)
    step = 0.01
    samples = int(draw.uniform(800, 2500))
    time = np.arange(samples) * step
    frequency = np.fft.rfftfreq(samples, step)
    centre, width = np.exp(draw.uniform(np.log(0.4), np.log(4.0))), draw.uniform(0.4, 0.9)
    band = np.exp(-0.5 * (np.log(np.maximum(frequency, 1e-3) / centre) / width) ** 2)
    noise = np.fft.irfft(np.fft.rfft(draw.standard_normal(samples)) * band, samples)
    acceleration = noise * np.exp(-0.5 * ((time / time[-1] - 0.4) / draw.uniform(0.08, 0.2)) ** 2)
    return rocking.Record(3.0 * acceleration / np.abs(acceleration).max(), step, "m/s2", name=f"noise {seed}")


def library(block: rocking.Block, records: int, resolution: float) -> Library:
    """Solve a block under records at all factors."""
    motions = [record(seed) for seed in range(records)]
    ratio = np.log([motion.peak_velocity / motion.peak_acceleration for motion in motions])
    return Library(ratio, _outcomes(block, motions, resolution, None))


def coverage(records: Library, size: int, suites: int, share: float, seed: int = 0) -> Coverage:
    """Count the records that overturn at what suites of a size state."""
    draw = np.random.default_rng([seed, size])
    overturned, stated = [], []
    for _ in range(suites):
        order = draw.permutation(records.ratio.size)
        suite, others = order[:size], order[size:]
        if records.outcomes.overturned[suite].any(axis=1).sum() < FEWEST:
            continue
        line = _line(records.ratio[suite], _taken(records.outcomes, suite), share)
        level = line.intercept + line.slope * records.ratio[others] + line.margin
        held_out = _taken(records.outcomes, others)
        counted = level <= held_out.highest
        stated.append(counted.sum() / others.size)
        overturned.append((held_out.at(level) & counted).sum() / others.size)
    shares = np.array(overturned)[np.array(stated) > 0.0] / np.array(stated)[np.array(stated) > 0.0]
    return Coverage(float(np.sum(overturned) / np.sum(stated)), float(shares.min()), float(np.mean(stated)))


def _taken(outcomes: _Outcomes, index: NDArray[np.intp]) -> _Outcomes:
    """Some of the records."""
    return _Outcomes(outcomes.level[index], outcomes.overturned[index], outcomes.step, outcomes.highest[index])


if __name__ == "__main__":
    given = arguments(__doc__, records=1500, resolution=0.02, probability=0.95, width=0.6, height=2.0)
    solved = library(rocking.Block(given.width, given.height), given.records, given.resolution)
    print(f"{'records':>8}{'suites':>8}{'overturned':>12}{'least':>8}{'stated':>8}")
    for size, suites in SUITES.items():
        found = coverage(solved, size, suites, given.probability)
        print(f"{size:8}{suites:8}{found.overturned:12.3f}{found.least:8.2f}{found.stated:8.2f}")
