"""Lowest amplitude of a sine that overturns a slender block, with a damper, a tendon and a prestress."""

import matplotlib.pyplot as plt
import numpy as np

from rocking import restraint
from rocking.plot.style import shades

ETA = 0.9  # restitution [-]
FAMILIES = {
    "damping": (r"$\zeta$", (0.0, 0.05, 0.1, 0.2, 0.4)),
    "stiffness": (r"$\kappa$", (0.0, 0.2, 0.4, 0.6, 0.8)),
    "prestress": (r"$\sigma$", (0.0, 0.25, 0.5, 0.75, 1.0)),
}

omega = np.geomspace(0.5, 9.0, 201)
figure, axes = plt.subplots(1, 3, figsize=(7.0, 3.0), sharey=True, layout="constrained")
for ax, (name, (symbol, values)) in zip(axes, FAMILIES.items(), strict=True):
    for value, colour in zip(values, shades(len(values)), strict=True):
        amplitudes = restraint.overturning_amplitudes(omega, ETA, **{name: value})
        ax.plot(omega, amplitudes.direct, color=colour, label=f"{symbol} = {value:g}")
        ax.plot(omega, amplitudes.overturns_from, color=colour, linestyle="--")
        ax.plot(omega, amplitudes.survives_again, color=colour, linestyle="--")
    ax.set(title=name, xlabel=r"$\omega_g/p$ [-]", yscale="log", ylim=(1.0, 30.0))
    ax.legend(fontsize=7)
    ax.grid(visible=True, linewidth=0.3, alpha=0.6)
axes[0].set_ylabel(r"$a_g/(g\alpha)$ [-]")
