"""
Self-similar spectra from the data sets, with xarray alone
==========================================================

Figure 8 of Dimitrakopoulos & DeJong (2012): the peak rotation of slender blocks against the frequency ratio,
for several coefficients of restitution. The example does not import ``rocking``: xarray reads the files.
"""

import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

folder = Path(os.environ.get("ROCKING_RESULTS", "results")) / "spectra" / "sine"
cubes = [xr.open_dataset(path) for path in sorted(folder.glob("eta-*.nc"))]
if not cubes:
    raise SystemExit(f"no data sets in {folder}: make reproduce, or name their folder in ROCKING_RESULTS")
spectra = xr.concat([cube.peak_rotation.sel(alpha=0.0) for cube in cubes], dim="restitution")

# %%
# The panels have different slendernesses g alpha/a_g. The ordinate of the paper is g theta_max/a_g, the peak
# rotation over alpha times that group.

figure, axes = plt.subplots(2, 1, sharex=True, figsize=(6, 6), layout="constrained")
for ax, slenderness in zip(axes, (0.6, 0.3), strict=True):
    row = spectra.sel(slenderness=slenderness, method="nearest").sel(frequency_ratio=slice(2.0, 12.0))
    ax.set_prop_cycle(color=plt.colormaps["viridis"](np.linspace(0.0, 0.85, row.sizes["restitution"])))
    lines = (row * row.slenderness).plot.line(ax=ax, x="frequency_ratio", add_legend=False)
    ax.set_title(rf"sine, $g\alpha/a_g$ = {float(row.slenderness):.2f}")
    ax.set(xlabel="", ylabel=r"$g\,\theta_{max}/a_g$ [-]")
axes[1].set_xlabel(r"frequency ratio $\omega_g/p$ [-]")
figure.legend(lines, [f"{eta:.2f}" for eta in spectra.restitution.values], loc="outside right upper", title=r"$\eta$")
plt.show()
