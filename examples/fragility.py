"""
Fragility under a suite of records
==================================

The probability that a block overturns at an intensity, from five records scaled to the same peak
acceleration. Five records are too few for a decision: the intervals say so.
"""

import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rocking

motions = Path(os.environ.get("ROCKING_MOTIONS", "workflow/motions"))
records = [rocking.read_record(path) for path in sorted(motions.glob("*.csv"))]
block = rocking.Block(width=0.8, height=4.0)  # m
found = rocking.fragility(records, block, intensity=np.geomspace(1.0, 30.0, 36), measure="pga")  # m/s2

curve = found.sel(model="lognormal")
print(f"median {float(curve.median_intensity):.2f} m/s2, dispersion {float(curve.dispersion):.2f}")
print("survive above their first overturning:", found.records_surviving_above_first.item())

# %%
# Every level is evaluated, because a record can spare at a higher level the block that it overturns at a
# lower one. The dotted curve counts each record from its first overturning on, and is too low.

rocking.plot.fragility(found)
plt.show()
