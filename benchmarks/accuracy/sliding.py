"""Rigid sliding against pySLAMMER: `python -m benchmarks.accuracy.sliding`, after `pip install pyslammer`.

The record is one of those that pySLAMMER brings, Imperial Valley 1979, BCR-230. `docs/other-software.md` has the
numbers. A block slides there in one direction only; at these yield accelerations it does so here too.
"""

import numpy as np
import pyslammer
from rocking_assessment._objects.sliding import largest_slip

from rocking._base.constants import STANDARD_GRAVITY

RECORD = "Imperial_Valley_1979_BCR-230"
YIELD = (0.60, 0.65, 0.70)  # accelerations at which the block slides [g]
FINER = 50  # times that the samples are finer in the last column


def main() -> None:
    """Print largest displacements [m]: of pySLAMMER, here, and of pySLAMMER with finer samples."""
    motion = pyslammer.sample_ground_motions()[RECORD]
    samples = np.asarray(motion.accel, dtype=np.float64)  # [g]
    times = np.arange(samples.size) * motion.dt
    fine_times = np.linspace(0.0, times[-1], (samples.size - 1) * FINER + 1)
    finer = pyslammer.GroundMotion(np.interp(fine_times, times, samples), motion.dt / FINER, "finer")
    print("ky [g]  pySLAMMER      here  pySLAMMER, finer")
    for acceleration in YIELD:
        theirs, theirs_finer = (
            pyslammer.RigidAnalysis(acceleration, record).max_sliding_disp for record in (motion, finer)
        )
        resistance = acceleration * STANDARD_GRAVITY
        ours = largest_slip(times, samples * STANDARD_GRAVITY, np.full(samples.size, resistance), resistance)
        print(f"{acceleration:6.2f}  {theirs:9.6f} {ours:9.6f} {theirs_finer:17.6f}")


if __name__ == "__main__":
    main()
