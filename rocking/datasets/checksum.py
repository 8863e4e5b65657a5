"""A file's own digest at its end: damage is noticed before a library trips, or hangs, over it.

netCDF readers look at no byte beyond the end that the file itself states, so they do not see the seal.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

PARTIAL = ".partial"
"""Suffix of a file that is being written; one that was killed leaves it behind."""

_MARK = b"\nsha256 "
_LENGTH = len(_MARK) + 64 + 1


def append_checksum(path: Path) -> None:
    """Append the digest of all that a file holds."""
    with path.open("ab") as file:
        file.write(_MARK + hashlib.sha256(path.read_bytes()).hexdigest().encode() + b"\n")


def find_damage(content: bytes) -> str | None:
    """What is wrong with the bytes of a sealed file: no seal, or not its own; None if they are whole."""
    body, end = content[:-_LENGTH], content[-_LENGTH:]
    if not end.startswith(_MARK):
        return "damaged, or not written by this package: no digest at its end"
    if end != _MARK + hashlib.sha256(body).hexdigest().encode() + b"\n":
        return "damaged, its bytes do not match its own digest"
    return None
