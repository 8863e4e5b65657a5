"""
A precariously balanced rock
============================

How probable is it that a rock has survived for its age? From a scan and a hazard file to the probability, with a
drawing of the rock, its two edges and its weakest direction. The scan and the hazard are made up, so that the example
runs alone.
"""

# %%
# The scan, a boulder whose top overhangs to one side, and the hazard of its site:
import os
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import rocking_assessment
import trimesh

import rocking

files = Path(tempfile.mkdtemp())
boulder = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
boulder.apply_scale((0.8, 0.7, 1.3))
boulder.vertices[:, 2] = np.maximum(boulder.vertices[:, 2], -0.6)  # what it stands on
boulder.vertices[:, 0] += 0.06 * (boulder.vertices[:, 2] > 0.0)
boulder.convex_hull.export(files / "boulder.stl")
table = "".join(f"{x:g},{2e-3 * (0.1 / x) ** 2.5:.6g}\n" for x in np.geomspace(0.05, 3.0, 20))
(files / "hazard.csv").write_text("pga [g],annual rate [1/year]\n" + table)

# %%
# The answer:
rock = rocking_assessment.Object.from_mesh(files / "boulder.stl", unit="m")
folder = Path(os.environ.get("ROCKING_MOTIONS", "workflow/motions"))
motions = [rocking.read_record(path) for path in sorted(folder.glob("*.csv"))]
fragility = rocking.fragility(motions, rock, intensity=np.geomspace(0.1, 3.0, 16) * 9.81)
luck = rocking_assessment.survival(fragility, files / "hazard.csv", years=10_000).survival.sel(model="lognormal")
weakest = luck.to_series().idxmin()
print(luck.to_series())

# %%
# Left: the rock from the side in its weakest direction, with its centre of mass, the two edges about which it rocks and
# their slenderness angles. Right: its footprint from above, and the survival in every direction of the ground motion.
plane, angle = rock.planes[weakest], float(weakest.removesuffix(" deg"))
figure, (side, above) = plt.subplots(1, 2, figsize=(7.0, 3.6), layout="constrained")
x, y = rock.outline(weakest).T
side.fill(x, y, color="0.85")
for edge, place in ((-0.5 * plane.base, "right"), (0.5 * plane.base, "left")):
    alpha = np.degrees(np.arctan2(abs(edge - plane.offset), plane.mass_height))
    side.plot([edge, plane.offset], [0.0, plane.mass_height], color="tab:blue", linewidth=1.0)
    side.annotate(f"{alpha:.0f} deg", (edge, 0.0), (0, -14), textcoords="offset points", ha=place)
    side.plot(edge, 0.0, "^", color="tab:blue")
side.plot(plane.offset, plane.mass_height, "o", color="tab:red")
side.set(title=f"in the plane of {weakest}", xlabel="m", ylabel="m", aspect="equal")
side.margins(0.15)
above.fill(*rock.footprint.T, color="0.85")
size = np.abs(rock.footprint).max()
for name, probability in luck.to_series().items():
    theta = np.radians(float(name.removesuffix(" deg")))
    ends = 1.6 * size * probability * np.array([-1.0, 1.0])
    above.plot(ends * np.cos(theta), ends * np.sin(theta), color="tab:red" if name == weakest else "tab:blue")
above.plot(0.0, 0.0, "o", color="tab:red")
above.set(title="from above: length is survival", xlabel="x [m]", ylabel="y [m]", aspect="equal")
plt.show()
