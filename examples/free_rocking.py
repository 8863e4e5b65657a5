"""
The block from a measured free rocking
======================================

What are the coefficient of restitution, the slenderness angle and the frequency parameter of a real block? Tilt it by
hand, release it, and film it at 60 frames a second. The trace gives all three, with intervals of 95 %.
"""

import matplotlib.pyplot as plt
import numpy as np
import rocking_assessment

# %%
# The trace, here made with the slender block: between impacts theta = alpha - (alpha - theta_n) cosh(p t).

alpha, p, eta, peak = 0.2, 2.5, 0.92, 0.15
time, start, sign = np.arange(0.0, 7.0, 1.0 / 60.0), 0.5, 1.0
rotation = np.where(time < start, peak, 0.0)  # held
half = np.arccosh(alpha / (alpha - peak)) / p  # from the peak to the impact
begin, centre = start, start
while half > 0.02:
    inside = (time >= begin) & (time < centre + half)
    rotation[inside] = sign * (alpha - (alpha - peak) * np.cosh(p * (time[inside] - centre)))
    begin = centre + half
    peak = alpha - np.sqrt(alpha**2 - eta**2 * (alpha**2 - (alpha - peak) ** 2))
    half, sign = np.arccosh(alpha / (alpha - peak)) / p, -sign
    centre = begin + half
rotation += np.radians(0.05) * np.random.default_rng(1).normal(size=time.size)

# %%
# The fit is for the rigid block, whose restoring moment is a sine.

found = rocking_assessment.identify_free_rocking(time, rotation)
for name in ("restitution", "alpha", "frequency_parameter"):
    print(
        f"{name} {found[name].item():.4f}, {found[name + '_lower'].item():.4f} to {found[name + '_upper'].item():.4f}"
    )
rocking_assessment.plot_free_rocking(found)
plt.show()
