"""A sha256 digest at the end of a file, so that damage is found before a library fails or hangs on it.

netCDF readers ignore bytes beyond the end of file that the format itself states, so they do not see the digest.
"""

import hashlib
from pathlib import Path


def sha256_of(content: bytes) -> str:
    """Return the sha256 (hex) of bytes, the version of a data set whose file holds them."""
    return hashlib.sha256(content).hexdigest()


def sha256_of_file(path: Path) -> str:
    """Return the sha256 (hex) of a file, which may be larger than the memory."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


_MARK = b"\nsha256 "
_LENGTH = len(_MARK) + 64 + 1


def append_checksum(path: Path) -> None:
    """Append the sha256 digest of the content of a file."""
    with path.open("ab") as file:
        file.write(_MARK + sha256_of_file(path).encode() + b"\n")


def find_damage(content: bytes) -> str | None:
    """Describe the damage of a file with a digest at its end, a missing or wrong digest; None if it is intact."""
    body, end = content[:-_LENGTH], content[-_LENGTH:]
    if not end.startswith(_MARK):
        return "damaged, or not written by this package: no digest at its end"
    if end != _MARK + sha256_of(body).encode() + b"\n":
        return "damaged, its bytes do not match its own digest"
    return None
