"""
A downloaded cube without this package
======================================

Can I use the data sets in another program? They are netCDF files with units, meanings and equation numbers, which
any program can read; here xarray and SciPy. Between the nodes the peak is interpolated where no corner of the cell
overturns; elsewhere there is no number.
"""

import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from scipy.interpolate import RegularGridInterpolator

results = Path(os.environ.get("ROCKING_RESULTS", "results"))
cube = xr.open_dataset(results / "spectra" / "sine" / "eta-0.85.nc")
print({name: cube[name].attrs["long_name"] for name in ("peak_rotation", "outcome", "interpolation_error")})

# %%
# Outcomes are codes, whose meanings are in the file.

meanings = cube.outcome.attrs["flag_meanings"].split()
node = cube.sel(alpha=0.0).sel(slenderness=0.4, frequency_ratio=5.0, method="nearest")
print(meanings[int(node.outcome)], float(node.peak_rotation))

# %%
# Linear interpolation of one layer. Where a block at a corner of the cell overturns, its peak is missing, and there is
# no number.

layer = cube.peak_rotation.sel(alpha=0.0)
peak = RegularGridInterpolator(
    (layer.slenderness.values, np.log(layer.frequency_ratio.values)), layer.values, bounds_error=True
)
print(peak([(0.4, np.log(5.0)), (0.2, np.log(2.0))]))  # the second one overturns

# %%
# The default picture of xarray has names and units from the file.

layer.plot(x="frequency_ratio", cmap="viridis_r", vmax=1.0)
plt.title(f"sine, slender limit, restitution {float(cube.restitution):.2f}")
plt.show()
