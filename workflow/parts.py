"""Parts of products: temporary files that one job writes and another joins, each with a digest at its end.

Their names end in a digest of the code and the settings that they were made from, so that a part of others is never
taken for a current one.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from rocking._datasets.checksum import find_damage
from rocking._datasets.provenance import settings_digest

FOLDER = Path("results/.parts")


def part_name(job: str, provenance: Mapping[str, Any]) -> str:
    """Name in the folder of the part that a job writes."""
    return f"{job}.{settings_digest(provenance)[:16]}.nc"


def forget_damaged_parts(folder: Path) -> Iterator[str]:
    """Delete damaged parts in the folder of a run, so that they are made again; yields the reasons."""
    for part in sorted((folder / FOLDER).rglob("*.nc")):
        if (damage := find_damage(part.read_bytes())) is not None:
            part.unlink()
            yield f"{part}: {damage}"


def delete_former_parts(part: Path) -> None:
    """Delete what interrupted runs with other code or settings left of a part, beside the current one."""
    for former in set(part.parent.glob(f"{part.name.rsplit('.', 2)[0]}.*.nc")) - {part}:
        former.unlink()
