"""
A family of pulses of your own
===============================

A subclass of ``SmoothPulse`` makes a pulse of any smooth function of the phase, in any unit; its parameters are fields.
Responses are as accurate as for the pulses of the catalogue. Here: a decaying sine whose frequency grows.
"""

import math
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np

import rocking


@dataclass(frozen=True)
class DecayingChirp(rocking.SmoothPulse):
    decay: float  # [1/rad]
    growth: float  # of the frequency [1/rad]

    def curve(self, phi):
        return np.exp(-self.decay * phi) * np.sin(phi + self.growth * phi**2)


chirp = DecayingChirp("chirp", 0.0, 8.0 * math.pi, decay=0.1, growth=0.03)
phi = np.linspace(chirp.start, chirp.end, 400)
figure, axes = plt.subplots(2, 1, figsize=(6.4, 6.4), height_ratios=(1, 2), layout="constrained")
axes[0].plot(phi, chirp.acceleration(phi), color="black")
axes[0].set_xlabel(r"phase $\varphi$ [rad]")
axes[0].set_ylabel("f [-]")
print(rocking.thresholds(chirp, frequency_ratio=3.0, restitution=0.85).amplitude)
block = rocking.Block(width=0.4, height=1.6)
rocking.plot.boundary(block.boundary(chirp, period=(0.3, 1.5)), axes[1])
plt.show()
