"""Mesh files of clients, read by another process: `rocking_assessment.service.mesh_process`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath

from rocking_api.http.errors import UnsupportedBodyError
from rocking_api.limited_process import result_of

from rocking.extension import UNITS, PolygonProperties, StopFlag, one_of
from rocking_assessment._objects.objects import STEP, Plane

MAX_MESH = 16 * 1024 * 1024
"""Largest file [bytes]: 330,000 triangles of a binary STL file, which take 5 s of processor time."""

ENDINGS = (".stl", ".ply", ".obj", ".glb")


@dataclass(frozen=True)
class MeshShape:
    """What an assessment needs of a mesh."""

    planes: dict[float, Plane]
    footprint: list[tuple[float, float]]
    remarks: list[str]


def read_mesh(raw: bytes, name: str, unit: str, stop: StopFlag) -> MeshShape:
    """The shape of a mesh from the bytes of its file, by another process."""
    one_of("unit", unit, UNITS["m"])
    ending = PurePath(name).suffix.lower()
    if ending not in ENDINGS:
        raise UnsupportedBodyError("mesh", ending or name, f"one of {', '.join(ENDINGS)}")
    found = result_of("rocking_assessment.service.mesh_process", raw, "mesh", name, stop, (unit, str(STEP)))
    planes = {float(angle): Plane.of(PolygonProperties(*values)) for angle, values in found["planes"].items()}
    return MeshShape(planes, [(x, y) for x, y in found["footprint"]], found["remarks"])
