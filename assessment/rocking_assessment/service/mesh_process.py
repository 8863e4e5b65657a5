"""One mesh file: the process of `rocking_assessment.service.mesh_reader`, with trimesh and little else."""

from __future__ import annotations

import math
import sys
from dataclasses import astuple
from typing import Any

from rocking_api.limited_process import print_result

CORNERS = 200  # most corners of a footprint that are kept, for its drawing [-]


def main(path: str, unit: str, step: str) -> None:
    """Print the planes in which a mesh is assessed, its footprint and what was repaired, or an error."""
    from rocking_assessment._meshes.mesh import (  # noqa: PLC0415
        CONTACT_TOLERANCE,
        directions_around,
        mesh_footprint,
        mesh_properties,
    )

    def read() -> dict[str, Any]:
        footprint = mesh_footprint(path, unit)
        found = {
            angle: mesh_properties(path, math.radians(angle), unit) for angle in directions_around(footprint, int(step))
        }
        remarks = next(remarks for _, remarks in found.values())
        height = next(properties.top for properties, _ in found.values())
        contact = f"stands on its vertices up to {1000.0 * CONTACT_TOLERANCE * height:.2g} mm above the lowest one"
        return {
            "planes": {angle: astuple(properties) for angle, (properties, _) in found.items()},
            "footprint": footprint[:: len(footprint) // CORNERS + 1].tolist(),
            "remarks": [contact, *remarks],
        }

    print_result(read)


if __name__ == "__main__":
    main(*sys.argv[1:])
