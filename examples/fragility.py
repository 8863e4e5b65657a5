"""
Fragility under a suite of records
==================================

How probable is it that a block overturns at an intensity? The answer is from five records scaled to the same peak
acceleration. Five records are too few for a decision, as the intervals show.
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
# Every level is evaluated, because a block can survive a record at a higher level than one that overturns it. The
# dotted curve counts each record from the first level at which it overturns the block, and is too low.

rocking.plot.fragility(found)
plt.show()
