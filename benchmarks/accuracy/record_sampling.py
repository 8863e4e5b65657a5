"""Effect of the sampling of a record on the answer: `python -m benchmarks.accuracy.record_sampling [--files FILE ...]`.

Between its samples a record is taken as linear. Here each record is compared with its band-limited interpolation at an
eighth of the step: outcomes that change, and differences of the peak where the block survives both. Slender blocks of R
from 0.5 to 4 m, restitution 0.9, amplitudes PGA/(g tan(alpha)) from 1.1 to 5.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import arguments
from rocking._base.constants import STANDARD_GRAVITY
from rocking._excitation.records.readers.read_record import read_record
from rocking._excitation.records.record import Record
from rocking._solver.records.record_response import record_response

FOLDER = Path(__file__).parents[2] / "workflow" / "motions"
FILES = [FOLDER / f"{name}.csv" for name in ("napa_HNE", "napa_HNN", "synthetic_31", "synthetic_32", "synthetic_33")]
FACTOR = 8
LARGE = 0.3
"""Relative difference of a peak that is counted as large [-]."""


def changes(motion: Record) -> tuple[int, int, NDArray[np.float64]]:
    """Return the number of runs, the number of outcomes that change, and the relative differences of the peak."""
    p = np.sqrt(0.75 * STANDARD_GRAVITY / np.array([0.5, 1.0, 2.0, 4.0]))[:, None]
    slenderness = 1.0 / np.linspace(1.1, 5.0, 24)
    finer = motion.resampled(motion.time_step / FACTOR)
    same = slenderness * (motion.peak_acceleration / finer.peak_acceleration)  # the same block under the same scale
    linear = record_response(motion, frequency_parameter=p, slenderness=slenderness, restitution=0.9)
    smooth = record_response(finer, frequency_parameter=p, slenderness=same, restitution=0.9)
    survives = ~(linear.overturned | smooth.overturned)
    difference = np.abs(smooth.peak_rotation / linear.peak_rotation - 1.0)[survives]
    return survives.size, int((linear.overturned != smooth.overturned).sum()), difference


if __name__ == "__main__":
    print(f"{'record':20}{'runs':>6}{'other outcome':>15}{'median change':>15}{'large':>8}")
    rows = [(path.stem, *changes(read_record(path))) for path in arguments(__doc__, files=FILES).files]
    runs, changed = sum(row[1] for row in rows), sum(row[2] for row in rows)
    for name, *found in [*rows, ("all", runs, changed, np.concatenate([row[3] for row in rows]))]:
        count, outcomes, difference = found
        print(f"{name:20}{count:6d}{outcomes:15d}{np.median(difference):15.1%}{(difference > LARGE).mean():8.1%}")
