"""A response with the events that the solver decides: where the ground destabilises the block, impacts, peaks."""

import matplotlib.pyplot as plt
import numpy as np

import rocking
from rocking.plot.style import BLUE, VERMILION

block = rocking.Block(width=0.4, height=1.6)
history = block.history("sine", peak_acceleration=3.6, period=0.5, duration=2.2)
time, ground, rate = history.time.values, history.ground_acceleration.values, history.angular_velocity.values
angle, impacts = np.degrees(history.rotation.values), history.impact_time.values

figure, axes = plt.subplots(2, 1, figsize=(7.0, 4.0), sharex=True, height_ratios=(1, 2), layout="constrained")
axes[0].plot(time, ground / 9.80665, color=BLUE)
for sign in (-1.0, 1.0):
    axes[0].axhline(sign * block.uplift_acceleration / 9.80665, color="black", linestyle="--", linewidth=0.8)
axes[0].set_ylabel("ground [g]")
axes[1].plot(time, angle, color=BLUE)
for ax in axes:
    ax.fill_between(time, 0, 1, where=np.abs(ground) > block.uplift_acceleration, transform=ax.get_xaxis_transform(),
                    color=VERMILION, alpha=0.2, linewidth=0.0)  # fmt: skip
axes[1].plot(impacts, 0.0 * impacts, "o", color="black", label="impact")
peak = np.flatnonzero((rate[:-1] * rate[1:] < 0.0) & (np.abs(angle[:-1]) > 0.1))
axes[1].plot(time[peak], angle[peak], "^", color=VERMILION, label="peak of a flight")
axes[1].set(xlabel="time [s]", ylabel="rotation [°]")
axes[1].legend()
