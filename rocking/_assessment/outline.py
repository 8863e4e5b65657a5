"""Outline of a mesh from the side, for drawings, by trimesh (extra `mesh`)."""

from __future__ import annotations

import math

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from rocking._base.units import UNITS


def mesh_outline(path: str, angle: float, unit: str) -> NDArray[np.float64]:
    """Convex outline in the vertical plane at an angle from the x axis [degrees].

    Returns
    -------
    float array (points, 2)
        Distances from the centre of mass along the plane, and heights above the lowest point [m].
    """
    mesh = trimesh.load_mesh(path, process=True)
    along = np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0.0])
    vertices = np.asarray(mesh.vertices)
    heights = vertices[:, 2] - vertices[:, 2].min()
    points = np.stack([(vertices - mesh.center_mass) @ along, heights], axis=1)
    return np.asarray(points[ConvexHull(points).vertices] * UNITS["m"][unit])
