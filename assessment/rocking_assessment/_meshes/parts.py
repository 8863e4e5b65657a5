"""The parts of a mesh file, counted before it is read: trimesh takes up to the square of their number in time."""

from __future__ import annotations

import json
import re
import struct
from collections.abc import Iterator

MAX_PARTS = 1000
"""Most nodes, meshes, elements or solids of a file [-]; of a thousand the slowest, nested nodes of glTF, take 2 s."""

_MATERIAL = re.compile(rb"^[ \t]*(?:usemtl|mtllib)\b[^\r\n]*", re.MULTILINE)
_PLY_ELEMENT = re.compile(rb"^[ \t]*(?:element|property)\b", re.MULTILINE)
_SOLID = re.compile(rb"^[ \t]*solid\b", re.MULTILINE | re.IGNORECASE)


def with_few_parts(content: bytes, kind: str) -> bytes:
    """The content of a mesh file of a kind such as "obj", without its materials, which divide a mesh at their seams."""
    if kind == "obj":
        return _MATERIAL.sub(b"", content)
    for part, count in _parts(content, kind):
        if count > MAX_PARTS:
            raise ValueError(f"{count} {part}, of at most {MAX_PARTS}")
    return content


def _parts(content: bytes, kind: str) -> Iterator[tuple[str, int]]:
    """Names of the parts of a file, with their numbers."""
    if kind == "ply":
        yield "elements and properties", len(_PLY_ELEMENT.findall(content.partition(b"end_header")[0]))
    elif kind == "stl" and content.lstrip()[:5].lower() == b"solid":
        yield "solids", len(_SOLID.findall(content))
    elif kind == "glb" and len(content) >= 20:  # a header of 12 bytes, then the length and type of the JSON
        tree = json.loads(content[20 : 20 + struct.unpack_from("<I", content, 12)[0]])
        for name, listed in tree.items():
            if isinstance(listed, list):
                yield name, len(listed)
        yield "primitives", sum(len(mesh.get("primitives", ())) for mesh in tree.get("meshes", ()))
        yield "children", sum(len(node.get("children", ())) for node in tree.get("nodes", ()))
