"""Mesh files of clients, read by the helper process, which loads trimesh and little else."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path, PurePath

from rocking_api.execution.helper import Helper, read_from_file
from rocking_api.http.errors import UnsupportedBodyError

from rocking.extension import UNITS, PolygonProperties, one_of
from rocking_assessment._objects.objects import STEP, Plane

MAX_MESH = 16 * 1024 * 1024
"""Largest file [bytes]: 330,000 triangles of a binary STL file, which take 5 s of processor time."""

ENDINGS = (".stl", ".ply", ".obj", ".glb")

CORNERS = 200  # most corners of a footprint that are kept, for its drawing [-]


@dataclass(frozen=True)
class MeshShape:
    """Properties of a mesh for an assessment."""

    planes: dict[float, Plane]
    footprint: list[tuple[float, float]]
    remarks: list[str]


async def read_mesh(helper: Helper, raw: bytes, name: str, unit: str) -> MeshShape:
    """The shape of a mesh from the bytes of its file."""
    one_of("unit", unit, UNITS["m"])
    ending = PurePath(name).suffix.lower()
    if ending not in ENDINGS:
        raise UnsupportedBodyError("mesh", ending or name, f"one of {', '.join(ENDINGS)}")
    planes, footprint, remarks = await helper.read("mesh", name, read_from_file, _shape_of, raw, name, unit)
    return MeshShape({angle: Plane.of(outline) for angle, outline in planes.items()}, footprint, remarks)


def _shape_of(path: Path, unit: str) -> tuple[dict[float, PolygonProperties], list[tuple[float, float]], list[str]]:
    """The properties of a mesh in the planes in which it is assessed, its footprint, and remarks on repairs."""
    from rocking_assessment._meshes.mesh import (  # noqa: PLC0415  # only the helper loads trimesh
        CONTACT_TOLERANCE,
        directions_around,
        read_mesh,
    )

    mesh = read_mesh(path, unit=unit)
    footprint = mesh.footprint()
    planes = {angle: mesh.properties(math.radians(angle)) for angle in directions_around(footprint, STEP)}
    height = next(iter(planes.values())).top
    contact = f"stands on its vertices up to {1000.0 * CONTACT_TOLERANCE * height:.2g} mm above the lowest one"
    corners = footprint[:: len(footprint) // CORNERS + 1].tolist()
    return planes, [(x, y) for x, y in corners], [contact, *mesh.remarks]
