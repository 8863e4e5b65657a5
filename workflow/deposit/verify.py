"""Compare every file of this archive with SHA256SUMS: `python3 verify.py`. It needs Python alone."""

import hashlib
import sys
from pathlib import Path

SUMS = "SHA256SUMS"


def problems(folder):
    """Return a description of each file that is missing, differs from its checksum or is not listed."""
    lines = (folder / SUMS).read_text(encoding="utf-8").splitlines()
    listed = {name: digest for digest, name in (line.split("  ", 1) for line in lines)}
    present = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()} - {SUMS}
    found = [f"{name}: missing" for name in listed if name not in present]
    found += [f"{name}: not listed" for name in present if name not in listed]
    for name in present & listed.keys():
        digest = hashlib.sha256()
        with (folder / name).open("rb") as file:
            while block := file.read(2**20):
                digest.update(block)
        if digest.hexdigest() != listed[name]:
            found.append(f"{name}: differs from its checksum")
    return sorted(found), len(listed)


if __name__ == "__main__":
    found, count = problems(Path(__file__).resolve().parent)
    if found:
        sys.exit("\n".join(found))
    print(f"all {count} files are as listed")
