"""
A recorded ground motion
========================

Does a component of the South Napa earthquake of 2014 overturn a stele of 0.5 m by 2 m? ``read_record`` reads PEER
AT2, ESM, K-NET and other formats, and columns in a layout that is stated.
"""

import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rocking

motions = Path(os.environ.get("ROCKING_MOTIONS", "workflow/motions"))
motion = rocking.read_record(motions / "napa_HNE.csv")
block = rocking.Block(width=0.5, height=2.0)  # m
response = block.response(motion, scale=1.2)
print(response)
for warning in response.warnings:
    print("warning:", warning)

# %%
# The outcome is not monotone in the scale of the record: between two scales at which the block overturns there can be
# scales at which it survives.

scales = response.thresholds
print(f"{len(scales)} changes of the outcome up to {scales.searched[1]:.2f} times the record, the first of them:")
for change in scales.changes[:6]:
    print(f"{change} times the record")

# %%
# The motion under 1.2 times the record, until the block has overturned.

history = block.history(motion, scale=1.2, duration=30.0)
figure, axes = plt.subplots(2, 1, sharex=True, layout="constrained")
rocking.plot.history(history, axes[0]).set_xlabel("")
rocking.plot.ground_acceleration(history, axes[1], linewidth=0.6)
plt.show()

# %%
# Many blocks under one record: arguments broadcast as in numpy.

heights = np.linspace(1.0, 6.0, 200)  # m
blocks = [rocking.Block(width=0.3 * height, height=height) for height in heights]
many = rocking.peak_response(
    motion,
    frequency_parameter=[one.frequency_parameter for one in blocks],
    slenderness=[one.uplift_acceleration / response.peak_acceleration for one in blocks],
    restitution=0.9,
    alpha=[one.alpha for one in blocks],
)
print(many)
