"""
Map of the control space with its boundaries
============================================

Which slender blocks does a full sine overturn? The map shows the outcome over amplitude and frequency; a million
blocks take less than a second. The solver traces the boundaries; they are not taken from the picture.
"""

import matplotlib.pyplot as plt
import numpy as np

import rocking

amplitude = np.geomspace(1.0, 10.0, 300)
blocks = rocking.peak_response(
    "sine", slenderness=1 / amplitude[:, None], frequency_ratio=np.linspace(0.3, 8.0, 400), restitution=0.85
)
print(blocks)

# %%
# Inside the closed curve a block overturns after an impact, above the other curve without impact. Between the two is
# the upper surviving region, in which the ground brings the block back after it has passed alpha. The thin curves at
# the bottom left are those of overturning after several impacts, which the closed forms of the paper do not cover.

boundaries = rocking.overturning_boundary("sine", restitution=0.85, frequency_ratio=(0.3, 8.0), slenderness=(0.1, 1.0))
ax = rocking.plot.control_map(blocks.to_xarray())
rocking.plot.boundary(boundaries, ax, color="white")
plt.show()
