"""One mesh file: the process of `rocking_assessment.service.mesh_reader`, with trimesh and little else."""

from __future__ import annotations

import math
import sys
from dataclasses import astuple
from typing import Any

from rocking_api.limited_process import print_result

CORNERS = 200  # most corners of a footprint that are kept, for its drawing [-]


def main(path: str, unit: str, step: str) -> None:
    """Print the planes across the sides of the base of a mesh, its footprint and what was repaired, or an error."""
    from rocking_assessment._meshes.mesh import directions_across, mesh_footprint, mesh_properties  # noqa: PLC0415

    def read() -> dict[str, Any]:
        footprint = mesh_footprint(path, unit)
        found = {
            angle: mesh_properties(path, math.radians(angle), unit)
            for angle in directions_across(footprint, float(step))
        }
        return {
            "planes": {angle: astuple(properties) for angle, (properties, _) in found.items()},
            "footprint": footprint[:: len(footprint) // CORNERS + 1].tolist(),
            "remarks": next(remarks for _, remarks in found.values()),
        }

    print_result(read)


if __name__ == "__main__":
    main(*sys.argv[1:])
