"""
Does the block overturn?
========================

A cabinet of 0.4 m by 1.6 m stands on the ground. Does a sine pulse of 0.45 g and 0.5 s overturn it?
"""

import matplotlib.pyplot as plt

import rocking

block = rocking.Block(width=0.4, height=1.6)  # m
response = block.response("sine", peak_acceleration=0.45 * 9.80665, period=0.5)  # m/s2, s
print(response)

# %%
# The coefficient of restitution follows from the geometry (Housner, 1963) unless a number is given. The
# response knows at which peak accelerations the outcome changes, and where the model is in doubt.

print(f"starts to rock at {block.uplift_acceleration:.2f} m/s2")
for threshold in response.thresholds:
    print(f"{threshold} m/s2")
for warning in response.warnings:
    print("warning:", warning)

# %%
# The picture shows this response, and those to all other amplitudes of the same pulse.

ax = rocking.plot.response(response)

# %%
# The motion in time. Impacts are marked; the pulse acts in the shaded range.

history = block.history("sine", peak_acceleration=0.45 * 9.80665, period=0.5)
figure, axes = plt.subplots(2, 1, sharex=True, height_ratios=(2, 1), layout="constrained")
rocking.plot.history(history, axes[0]).set_xlabel("")
rocking.plot.ground_acceleration(history, axes[1])
plt.show()
