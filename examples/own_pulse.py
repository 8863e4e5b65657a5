"""
A pulse of your own
====================

A pulse of your own is a sum of sinusoids on a window of phase, or a polynomial times a Gaussian. Every function takes
it in place of a name. Here: two and a half cycles of a sine in a sinusoidal envelope.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import rocking

cycles = 2.5
end = 2.0 * math.pi * cycles
# sin(phi) sin(phi/5) is half the difference of two cosines
terms = ((0.5, 1.0 - 1.0 / (2.0 * cycles), 0.0), (-0.5, 1.0 + 1.0 / (2.0 * cycles), 0.0))
burst = rocking.SinusoidalPulse.of_unit_peak("burst", 0.0, end, terms)

phi = np.linspace(0.0, end, 400)
figure, axes = plt.subplots(2, 1, layout="constrained")
axes[0].plot(phi, burst.acceleration(phi), color="black")
axes[0].set_xlabel(r"phase $\varphi$ [rad]")
axes[0].set_ylabel("f [-]")
history = rocking.time_history(burst, slenderness=0.4, frequency_ratio=3.0, restitution=0.85)
rocking.plot.history(history, axes[1])
plt.show()

# %%
# The amplitudes a_g/(g tan(alpha)) at which the outcome changes.

print(rocking.thresholds(burst, frequency_ratio=3.0, restitution=0.85).amplitude)
