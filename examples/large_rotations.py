"""
Large rotations
===============

The slender limit replaces sines by angles. For a block that is not slender, or that rotates beyond alpha and comes
back, pass the angle ``alpha``: the block then follows the full equation of motion (2.2).
"""

import matplotlib.pyplot as plt
import numpy as np

import rocking

figure, ax = plt.subplots(layout="constrained")
groups = {"frequency_ratio": 6.0, "restitution": 0.85}
amplitude = np.linspace(1.0, 9.0, 1200)
for degrees, colour in ((None, "#000000"), (10, "#0072B2"), (20, "#D55E00"), (30, "#009E73")):
    alpha = None if degrees is None else np.radians(degrees)
    found = rocking.peak_response("sine", slenderness=1 / amplitude, alpha=alpha, **groups)
    ax.plot(amplitude, found.peak_rotation, color=colour, label="slender" if degrees is None else f"{degrees} deg")
ax.set_xlabel(r"amplitude $a=a_g/(g\,\tan\alpha)$ [-]")
ax.set_ylabel(r"peak rotation $\theta_{max}/\alpha$ [-]; interrupted: overturns")
ax.legend(title=r"$\alpha$")
plt.show()

# %%
# Under this pulse only the blocks of 20 and 30 degrees overturn after an impact. Passing alpha is not
# overturning: at 1.1 times the upper end of that range the block of 20 degrees passes alpha, and the second
# half of the pulse brings it back.

edges = rocking.thresholds("sine", alpha=np.radians(20), **groups)
print(edges.amplitude)
back = rocking.time_history("sine", slenderness=1 / (edges.amplitude[1] * 1.1), alpha=np.radians(20), **groups)
rocking.plot.history(back)
plt.show()
