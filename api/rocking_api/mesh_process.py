"""One mesh file, read within limits of time and memory: the process of `rocking_api.mesh_reader`.

It loads trimesh and little else, which takes a third of the time of loading the package.
"""

from __future__ import annotations

import json
import math
import sys
from dataclasses import astuple
from pathlib import Path

from rocking._base.errors import InvalidArgumentError

SECONDS = 20
"""Most processor time of a file [s]."""

MEMORY = 1024**3
"""Most memory beyond that of the modules [bytes]."""

CORNERS = 200
"""Most corners of a footprint that are kept, for its drawing [-]."""


def main(path: str, unit: str, step: str) -> None:
    """Print the planes across the sides of the base of a mesh, its footprint and whether it is closed, or an error."""
    from rocking._dimensional.mesh import directions_across, mesh_footprint, mesh_properties  # noqa: PLC0415

    _limit()
    try:
        footprint = mesh_footprint(path, unit)
        found = {
            angle: mesh_properties(path, math.radians(angle), unit)
            for angle in directions_across(footprint, float(step))
        }
    except InvalidArgumentError as error:
        sys.stdout.write(json.dumps({"allowed": error.allowed}))
        return
    planes = {angle: astuple(properties) for angle, (properties, _) in found.items()}
    corners = footprint[:: len(footprint) // CORNERS + 1].tolist()
    closed = all(is_closed for _, is_closed in found.values())
    sys.stdout.write(json.dumps({"planes": planes, "footprint": corners, "closed": closed}))


def _limit() -> None:
    """Bound what this process may use from here on; elsewhere than on Linux the time limit of requests remains."""
    if sys.platform == "linux":
        import resource  # noqa: PLC0415  (other systems do not have it)

        used = int(Path("/proc/self/statm").read_text("ascii").split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))
        spent = resource.getrusage(resource.RUSAGE_SELF)
        seconds = SECONDS + int(spent.ru_utime + spent.ru_stime)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))


if __name__ == "__main__":
    main(*sys.argv[1:])
