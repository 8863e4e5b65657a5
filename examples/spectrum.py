"""
Rocking spectrum of a block
===========================

How far does a block rotate under pulses of one amplitude and different periods? A longer pulse of the same amplitude
rotates the block further, until it overturns.
"""

import matplotlib.pyplot as plt
import numpy as np

import rocking

block = rocking.Block(width=0.7, height=2.8)  # m
periods = np.geomspace(0.1, 2.0, 400)  # s

figure, axes = plt.subplots(1, 2, sharey=True, figsize=(8, 3.4), layout="constrained")
for ax, pulse in zip(axes, ("sine", "ricker"), strict=True):
    spectrum = block.spectrum(pulse, peak_acceleration=4.0, period=periods)
    rocking.plot.spectrum(spectrum, ax, label="survives")
    ax.set_title(pulse)
    ax.legend()
axes[1].set_ylabel("")
plt.show()

# %%
# The spectrum also holds the outcome and the displacement of the top.

print(spectrum[["rotation", "displacement", "outcome"]].sel(period=0.8, method="nearest"))
