"""Mass properties, outline and footprint of a surface mesh, by trimesh."""

from __future__ import annotations

import io
import math
import warnings
from dataclasses import dataclass
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

PATH = Quantity("path", "", "file of a closed surface (STL, PLY, OBJ, GLB, ...)", example="vase.stl")
UNIT = Quantity("unit", "", "unit of the lengths in the file: m, cm, mm, in or ft; of glTF m")
UP = Quantity("up", "", "axis of the file that points upwards: x, y or z; z by default, y of glTF")
DIRECTION = Quantity(
    "direction",
    "rad",
    "angle of the ground motion from the first horizontal axis of the mesh towards the second",
    lower=-2.0 * math.pi,
    upper=2.0 * math.pi,
    closed="both",
    example="30 deg",
)

GLTF = (".glb", ".gltf")
"""Formats whose standard states metres, and +Y upwards."""

AXES = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}
"""Axes of the file that are the first and second horizontal axis and the upward one, by the name of the last."""

USUAL_SIZE = 0.01, 50.0
"""Smallest and largest extent of a mesh that are not asked about [m]."""

CONTACT_TOLERANCE = 1e-4
"""Height above the lowest point up to which vertices are in contact with the ground, over the height of the mesh [-].

0.16 mm for a statue of 1.6 m. A vertex 1.2 mm above the others, within 1e-3 of the height, does not carry.
"""

EMPTY = 1e-9  # volume of a surface over that of the mesh up to which it encloses nothing [-]

LONG_SIDE = 0.1
"""A side of a footprint that is at least this share of the perimeter has a direction of its own [-].

A body turns about a long side at a smaller distance than in directions beside that. Those across shorter sides, as of a
round base, are rounded.
"""


@dataclass(frozen=True, eq=False)
class Mesh:
    """A closed surface in metres, z upwards, and remarks on its file."""

    path: str
    surface: trimesh.Trimesh
    remarks: tuple[str, ...]

    def properties(self, direction: float, contact_tolerance: float = CONTACT_TOLERANCE) -> PolygonProperties:
        """Edges, centre of mass and radius of gyration in the plane of a direction [rad]."""
        along = _horizontal(direction)
        across = np.cross([0.0, 0.0, 1.0], along)
        lowest, highest = self.surface.bounds[:, 2].tolist()
        footprint = self._contact_points(contact_tolerance) @ along[:2]
        left, right = -float(footprint.min()), float(footprint.max())
        if not (left > 0.0 and right > 0.0):
            raise InvalidArgumentError(
                "path",
                self.path,
                "a body whose centre of mass lies above its footprint, the points within contact_tolerance of the "
                "lowest",
            )
        # rotation is about the horizontal axis normal to the plane, through the centre of mass
        inertia = float(across @ np.asarray(self.surface.moment_inertia) @ across)
        if not inertia > 0.0:
            raise InvalidArgumentError(
                "path", self.path, "a mesh that does not cross itself: its moment of inertia is negative"
            )
        gyration = math.sqrt(inertia / float(self.surface.mass))
        return PolygonProperties(left, right, float(self.surface.center_mass[2]) - lowest, gyration, highest - lowest)

    def outline(self, direction: float) -> Array:
        """Convex outline in the plane of a direction [rad], for drawings; (points, 2) [m].

        Distances from the centre of mass along the plane, and heights above the lowest point.
        """
        vertices = np.asarray(self.surface.vertices)
        heights = vertices[:, 2] - vertices[:, 2].min()
        points = np.stack([(vertices - self.surface.center_mass) @ _horizontal(direction), heights], axis=1)
        return np.asarray(points[ConvexHull(points).vertices])

    def footprint(self, contact_tolerance: float = CONTACT_TOLERANCE) -> Array:
        """Convex outline of the footprint from the centre of mass [m], array (points, 2)."""
        points = self._contact_points(contact_tolerance)
        try:
            corners = ConvexHull(points).vertices
        except QhullError:  # fewer than three points, or all on one line
            raise InvalidArgumentError(
                "path", self.path, "a mesh that stands on three points or more within contact_tolerance"
            ) from None
        return np.asarray(points[corners])

    def _contact_points(self, contact_tolerance: float) -> Array:
        """Vertices on which the mesh stands, from its centre of mass; array (points, 2) [m]."""
        share = number("contact_tolerance", contact_tolerance, 0.0, 0.1)
        vertices = np.asarray(self.surface.vertices)
        heights = vertices[:, 2]
        limit = heights.min() + share * np.ptp(heights)
        return np.asarray((vertices - self.surface.center_mass)[heights <= limit, :2])


def read_mesh(path: str | Path, *, unit: str | None = None, up: str | None = None, allow_unusual: bool = False) -> Mesh:
    """Read a closed surface from a file.

    Parameters
    ----------
    path : str or Path
        A file that trimesh reads (STL, PLY, OBJ, GLB, ...).
    unit : str
        Unit of the lengths in the file, "m", "cm", "mm", "in" or "ft"; required, but for glTF, which has metres.
    up : str
        Axis of the file that points upwards, "x", "y" or "z"; by default "z", of glTF "y".
    allow_unusual : bool
        Accept a largest extent below 1 cm or above 50 m, which usually is a wrong unit.

    Raises
    ------
    InvalidArgumentError
        If the unit is not stated, the file cannot be read, or its surface is not closed after the repairs of trimesh:
        holes of three and four edges are filled, faces are turned consistently, and outwards.
    """
    is_gltf = Path(path).suffix.lower() in GLTF
    remarks = []
    if unit is None and not is_gltf:
        raise InvalidArgumentError(
            "unit", None, f"the unit of the lengths in {Path(path).name}, one of m, cm, mm, in, ft"
        )
    if is_gltf and unit not in (None, "m"):
        remarks.append(f"is glTF, whose lengths are in m; the stated unit {unit} is used")
    if is_gltf and up not in (None, "y"):
        remarks.append(f"is glTF, whose y axis points upwards; the stated axis {up} is used")
    factor = UNITS["m"][one_of("unit", unit or "m", UNITS["m"])]
    axes = AXES[one_of("up", up or ("y" if is_gltf else "z"), AXES)]
    try:
        status = Path(path).stat()
        surface, repairs, defect = _read_surface(Path(path), status.st_mtime_ns, status.st_size, factor, axes)
    except FileNotFoundError as error:
        raise UnreadableFileError("path", str(path), error) from None
    except Exception as error:  # noqa: BLE001  (each format has its own errors)
        raise InvalidArgumentError("path", str(path), f"a mesh that trimesh reads ({error})") from None
    if defect:
        raise InvalidArgumentError("path", str(path), f"a mesh that encloses a volume; this one {defect}")
    smallest, largest = USUAL_SIZE
    size = float(surface.extents.max())
    if not (allow_unusual or smallest <= size <= largest):
        question = f"True for {Path(path).name}, which has a size of {size:.4g} m; is its unit {unit or 'm'}?"
        raise InvalidArgumentError("allow_unusual", allow_unusual, question)
    return Mesh(str(path), surface, (*remarks, *repairs))


def body_from_mesh(
    path: str | Path,
    direction: Scalar = 0.0,
    *,
    unit: str | None = None,
    up: str | None = None,
    gravity: Scalar = STANDARD_GRAVITY,
    contact_tolerance: float = CONTACT_TOLERANCE,
    allow_unusual: bool = False,
) -> RigidBody:
    """A body of uniform density from a surface mesh, which stands on its lowest points.

    It rocks in the vertical plane of the direction, on the outermost points of its footprint there: the planar
    model of a base of any shape, which leaves out that a round base also rolls.

    Parameters
    ----------
    path : str or Path
        A file that trimesh reads (STL, PLY, OBJ, GLB, ...).
    direction : float
        Angle of the ground motion from the x axis towards the y axis [rad], or a text such as "30 deg"; from z
        towards x where y points upwards, from y towards z where x does.
    unit : str
        Unit of the lengths in the file, "m", "cm", "mm", "in" or "ft"; required, but for glTF, which has metres.
    up : str
        Axis of the file that points upwards, "x", "y" or "z"; by default "z", of glTF "y".
    gravity
        As of `RigidBody`.
    contact_tolerance : float
        Height above the lowest point up to which vertices are in contact with the ground, over the height of the mesh
        [-], [0, 0.1]: 0.16 mm for a height of 1.6 m.
    allow_unusual : bool
        Accept a largest extent below 1 cm or above 50 m, which usually is a wrong unit.

    Raises
    ------
    InvalidArgumentError
        If the unit is not stated, if the file cannot be read, is not closed after the repairs of trimesh, encloses no
        volume, or does not stand.
    ImportError
        If trimesh is not installed.

    Warns
    -----
    UserWarning
        If the mesh was repaired: holes of three or four edges filled, faces turned. If it has separate surfaces. If an
        argument contradicts the standard of glTF.
    """
    checked_gravity = positive("gravity", gravity, "m/s2")
    angle = number("direction", direction, -2.0 * math.pi, 2.0 * math.pi, unit="rad")
    mesh = read_mesh(path, unit=unit, up=up, allow_unusual=allow_unusual)
    properties = mesh.properties(angle, contact_tolerance)
    for remark in mesh.remarks:
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
    unit: Annotated[str | None, UNIT] = None,
    up: Annotated[str | None, UP] = None,
    gravity: Annotated[float, GRAVITY] = STANDARD_GRAVITY,
) -> RigidBody:
    """A body of uniform density from a surface mesh, standing on its lowest points."""
    return body_from_mesh(path, direction, unit=unit, up=up, gravity=gravity)


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


Surface = tuple[trimesh.Trimesh, list[str], str]
"""A mesh, what was repaired, and what cannot be, as ends of a sentence about it."""


@lru_cache(maxsize=1)
def _read_surface(path: Path, _changed: int, _size: int, factor: float, axes: tuple[int, int, int]) -> Surface:
    """The mesh of a file in metres, z upwards, around the origin: map coordinates would lose digits.

    It is kept for the other directions: loading it and its inertia take most of the time.
    """
    # from its bytes: a file that holds all of its mesh is given no way to name others
    kind = path.suffix[1:].lower()
    source = path if kind == "gltf" else io.BytesIO(with_few_parts(path.read_bytes(), kind))
    mesh = trimesh.load_mesh(source, file_type=kind, process=True, skip_materials=True)
    if not len(mesh.faces):
        return mesh, [], "has no faces; strips of triangles are not read"
    mesh.vertices = factor * (mesh.vertices - mesh.bounds.mean(axis=0))[:, axes]
    with np.errstate(invalid="ignore", divide="ignore"):  # of a mesh without a volume
        return _repaired(mesh)


def _repaired(mesh: trimesh.Trimesh) -> Surface:
    """Repair a mesh by trimesh, in place."""
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    remarks = []
    if not (mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0.0):
        before = len(mesh.faces)
        mesh.update_faces(mesh.unique_faces() & mesh.nondegenerate_faces())
        left_out = before - len(mesh.faces)
        if left_out:
            remarks.append(f"has faces that are there twice or have no area: {left_out} of {before} were left out")
        inverted = not mesh.is_winding_consistent or mesh.volume < 0.0
        trimesh.repair.fix_normals(mesh)
        if not mesh.is_watertight:
            closed = len(mesh.faces)
            trimesh.repair.fill_holes(mesh)
            trimesh.repair.fix_normals(mesh)
            remarks.append(f"was not closed: its holes were filled with {len(mesh.faces) - closed} faces")
        if inverted:
            remarks.append("had faces that pointed inwards, which were turned")
    if not mesh.is_watertight:
        _, counts = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
        single, several = int((counts == 1).sum()), int((counts > 2).sum())
        text = f"is not closed: {single} edges have one face, {several} have more than two; close it where it was made"
        return mesh, [], text
    if not mesh.is_winding_consistent:
        return mesh, [], "has a surface with one side only, whose faces cannot be turned consistently"
    if not mesh.volume > 0.0:
        return mesh, [], "encloses no volume"
    if mesh.body_count > 1:
        surface = trimesh.graph.connected_component_labels(mesh.face_adjacency, node_count=len(mesh.faces))
        corners = mesh.triangles.transpose(1, 0, 2)
        volumes = np.bincount(surface, np.einsum("ij,ij->i", corners[0], np.cross(corners[1], corners[2])) / 6.0)
        empty = int((np.abs(volumes) <= EMPTY * mesh.volume).sum())
        if empty:
            text = f"has {empty} surfaces that enclose nothing" if empty > 1 else "has 1 surface that encloses nothing"
            return mesh, [], text
        remarks.append(
            f"has {mesh.body_count} separate surfaces, which are treated as one body; those whose faces point inwards "
            "are cavities"
        )
    return mesh, remarks, ""


def _horizontal(direction: float) -> Array:
    """Unit vector at an angle from the x axis [rad]."""
    return np.array([math.cos(direction), math.sin(direction), 0.0])
