"""Mass properties and outline of a surface mesh in a vertical plane, by trimesh."""

from __future__ import annotations

import io
import math
import warnings
from functools import lru_cache
from pathlib import Path
from typing import Annotated

import numpy as np
import trimesh
from scipy.spatial import ConvexHull, QhullError

from rocking.extension import (
    GRAVITY,
    STANDARD_GRAVITY,
    UNITS,
    Array,
    InvalidArgumentError,
    PolygonProperties,
    Quantity,
    RigidBody,
    Scalar,
    UnreadableFileError,
    number,
    one_of,
    positive,
)
from rocking_assessment._meshes.parts import with_few_parts
from rocking_assessment._meshes.repair import RepairedMesh, repaired

PATH = Quantity("path", "", "file of a closed surface (STL, PLY, OBJ, ...), z upwards", example="vase.stl")
UNIT = Quantity("unit", "", "unit of the lengths in the file: m, cm, mm, in or ft", default="m")
DIRECTION = Quantity(
    "direction",
    "rad",
    "angle of the ground motion from the x axis of the mesh towards its y axis",
    lower=-2.0 * math.pi,
    upper=2.0 * math.pi,
    closed="both",
    example="30 deg",
)

CONTACT_TOLERANCE = 1e-4
"""Height above the lowest point up to which vertices are in contact with the ground, over the height of the mesh [-].

0.16 mm for a statue of 1.6 m. A vertex 1.2 mm above the others, within 1e-3 of the height, does not carry.
"""

LONG_SIDE = 0.1
"""A side of a footprint that is at least this share of the perimeter has a direction of its own [-].

A body turns about a long side at a smaller distance than in directions beside that. Those across shorter sides, as of a
round base, are rounded.
"""


FAR = 100.0
"""A mesh farther from the origin than this many times its size is moved there: map coordinates lose digits [-]."""


def body_from_mesh(
    path: str | Path,
    direction: Scalar = 0.0,
    *,
    unit: str = "m",
    gravity: Scalar = STANDARD_GRAVITY,
    contact_tolerance: float = CONTACT_TOLERANCE,
) -> RigidBody:
    """A body of uniform density from a surface mesh, which stands on its lowest points; z is upwards.

    It rocks in the vertical plane of the direction, on the outermost points of its footprint there: the planar
    model of a base of any shape, which leaves out that a round base also rolls.

    Parameters
    ----------
    path : str or Path
        A file that trimesh reads (STL, PLY, OBJ, GLB, ...).
    direction : float
        Angle of the ground motion from the x axis towards the y axis [rad], or a text such as "30 deg".
    unit : str
        Unit of the lengths in the file, "m", "cm", "mm", "in" or "ft".
    gravity
        As of `RigidBody`.
    contact_tolerance : float
        Height above the lowest point up to which vertices are in contact with the ground, over the height of the mesh
        [-], [0, 0.1]: 0.16 mm for a height of 1.6 m.

    Raises
    ------
    InvalidArgumentError
        If the file cannot be read, has a defect that cannot be repaired with certainty, encloses no volume, or does
        not stand.
    ImportError
        If trimesh is not installed.

    Warns
    -----
    UserWarning
        If the mesh was repaired: flat holes filled, normals turned outwards, sheets beside the surface left out.
        If it has separate solids, with gaps between them, which are treated as one body.
    """
    checked_gravity = positive("gravity", gravity, "m/s2")
    angle = number("direction", direction, -2.0 * math.pi, 2.0 * math.pi, unit="rad")
    contact = number("contact_tolerance", contact_tolerance, 0.0, 0.1)
    properties, remarks = mesh_properties(path, angle, unit, contact)
    for remark in remarks:
        warnings.warn(f"{Path(path).name} {remark}", UserWarning, 2)
    return RigidBody(
        properties.left,
        properties.right,
        properties.height,
        properties.gyration,
        gravity=checked_gravity,
        top_height=properties.top,
    )


def mesh(
    path: Annotated[str, PATH],
    direction: Annotated[float, DIRECTION] = 0.0,
    unit: Annotated[str, UNIT] = "m",
    gravity: Annotated[float, GRAVITY] = STANDARD_GRAVITY,
) -> RigidBody:
    """A body of uniform density from a surface mesh, standing on its lowest points."""
    return body_from_mesh(path, direction, unit=unit, gravity=gravity)


def mesh_properties(
    path: str | Path, direction: float, unit: str, contact_tolerance: float = CONTACT_TOLERANCE
) -> tuple[PolygonProperties, list[str]]:
    """Edges, centre of mass and radius of gyration in the plane of a direction [rad], in metres; what was repaired."""
    factor = UNITS["m"][one_of("unit", unit, UNITS["m"])]
    (mesh, remarks), along = _mesh(path), _horizontal(direction)
    across = np.cross([0.0, 0.0, 1.0], along)
    centre = np.asarray(mesh.center_mass)
    heights = np.asarray(mesh.vertices)[:, 2]
    lowest, highest = float(heights.min()), float(heights.max())
    footprint = _footprint(mesh, contact_tolerance) @ along[:2]
    left, right = -float(footprint.min()), float(footprint.max())
    if not (left > 0.0 and right > 0.0):
        raise InvalidArgumentError(
            "path",
            str(path),
            "a body whose centre of mass lies above its footprint, the points within contact_tolerance of the lowest",
        )
    # rotation is about the horizontal axis normal to the plane, through the centre of mass
    about = float(across @ np.asarray(mesh.moment_inertia) @ across)
    if not about > 0.0:
        raise InvalidArgumentError(
            "path", str(path), "a mesh that does not cross itself: its moment of inertia is negative"
        )
    found = PolygonProperties(
        left * factor,
        right * factor,
        (float(centre[2]) - lowest) * factor,
        math.sqrt(about / float(mesh.mass)) * factor,
        (highest - lowest) * factor,
    )
    return found, remarks


def mesh_outline(path: str | Path, direction: float, unit: str) -> Array:
    """Convex outline in the plane of a direction [rad], for drawings; (points, 2) [m].

    Distances from the centre of mass along the plane, and heights above the lowest point.
    """
    mesh, _ = _mesh(path)
    vertices = np.asarray(mesh.vertices)
    heights = vertices[:, 2] - vertices[:, 2].min()
    points = np.stack([(vertices - mesh.center_mass) @ _horizontal(direction), heights], axis=1)
    return np.asarray(points[ConvexHull(points).vertices] * UNITS["m"][unit])


def mesh_footprint(path: str | Path, unit: str, contact_tolerance: float = CONTACT_TOLERANCE) -> Array:
    """Convex outline of the footprint from the centre of mass [m], array (points, 2); arguments and errors as above."""
    points = _footprint(_mesh(path)[0], contact_tolerance)
    try:
        corners = ConvexHull(points).vertices
    except QhullError:  # fewer than three points, or all on one line
        raise InvalidArgumentError(
            "path", str(path), "a mesh that stands on three points or more within contact_tolerance"
        ) from None
    return np.asarray(points[corners] * UNITS["m"][one_of("unit", unit, UNITS["m"])])


def directions_across(footprint: Array, step: float) -> list[float]:
    """Directions across the sides of a convex footprint, those of short sides in steps, 0 to below 180 [degrees]."""
    sides = np.roll(footprint, -1, axis=0) - footprint
    length = np.hypot(*sides.T)
    across = np.degrees(np.arctan2(-sides[:, 0], sides[:, 1]))
    rounded = np.where(length >= LONG_SIDE * length.sum(), np.round(across, 2), step * np.round(across / step))
    return [float(angle) for angle in np.unique(rounded % 180.0)]


def directions_around(footprint: Array, step: int) -> list[float]:
    """Directions in which a mesh is assessed, 0 to below 180 [degrees]: in steps, and across the sides of its base.

    All count. A body turns about a side, but the planar body of an oblique direction has another inertia and can
    overturn at a lower factor than those across the sides.
    """
    return sorted({*map(float, range(0, 180, step)), *directions_across(footprint, step)})


def _footprint(mesh: trimesh.Trimesh, contact_tolerance: float) -> Array:
    """Vertices on which a mesh stands, from its centre of mass; array (points, 2)."""
    vertices = np.asarray(mesh.vertices)
    heights = vertices[:, 2]
    limit = heights.min() + contact_tolerance * np.ptp(heights)
    return np.asarray((vertices - mesh.center_mass)[heights <= limit, :2])


def _mesh(path: str | Path) -> tuple[trimesh.Trimesh, list[str]]:
    """The mesh of a file, and what of it was repaired."""
    try:
        status = Path(path).stat()
        mesh, remarks, defect = _loaded(Path(path), status.st_mtime_ns, status.st_size)
    except FileNotFoundError as error:
        raise UnreadableFileError("path", str(path), error) from None
    except Exception as error:  # noqa: BLE001  (each format has its own errors)
        raise InvalidArgumentError("path", str(path), f"a mesh that trimesh reads ({error})") from None
    if defect:
        raise InvalidArgumentError("path", str(path), f"a mesh that encloses a volume; this one {defect}")
    return mesh, remarks


@lru_cache(maxsize=1)
def _loaded(path: Path, _changed: int, _size: int) -> RepairedMesh:
    """The mesh of a file, kept for the other directions: loading it and its inertia take most of the time."""
    # from its bytes: a file that holds all of its mesh is given no way to name others
    kind = path.suffix[1:].lower()
    source = path if kind == "gltf" else io.BytesIO(with_few_parts(path.read_bytes(), kind))
    mesh = trimesh.load_mesh(source, file_type=kind, process=True, skip_materials=True)
    if not len(mesh.faces):
        return RepairedMesh(mesh, [], "has no faces")
    middle = mesh.bounds.mean(axis=0)
    if np.abs(middle).max() > FAR * float(mesh.extents.max()):
        mesh.apply_translation(-middle)
    with np.errstate(invalid="ignore", divide="ignore"):  # of a mesh without a volume
        return repaired(mesh)


def _horizontal(direction: float) -> Array:
    """Unit vector at an angle from the x axis [rad]."""
    return np.array([math.cos(direction), math.sin(direction), 0.0])
