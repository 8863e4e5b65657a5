"""Parts of mesh files and cells of sheets are counted before they are read."""

import json
import struct

import pytest

from rocking import InvalidArgumentError
from rocking._dimensional.mesh_parts import MAX_PARTS, with_few_parts
from rocking._dimensional.table_reader import rows_of_sheet
from tests.sheets import xlsx_bytes


def glb(**tree):
    text = json.dumps(tree).encode()
    return struct.pack("<IIIII", 0x46546C67, 2, 20 + len(text), len(text), 0x4E4F534A) + text


def ply(elements):
    return b"ply\nformat ascii 1.0\n" + b"element e 0\n" * elements + b"end_header\n"


def made(kind, count):
    return {
        "ply": lambda: ply(count),
        "stl": lambda: b" solid a\nendsolid a\n" * count,
        "nodes": lambda: glb(nodes=[{}] * count),
        "children": lambda: glb(nodes=[{"children": [0] * count}]),
        "primitives": lambda: glb(meshes=[{"primitives": [{}] * count}]),
    }[kind]()


@pytest.mark.parametrize("kind", ["ply", "stl", "nodes", "children", "primitives"])
def test_files_of_many_parts_are_refused(kind):
    ending = kind if kind in ("ply", "stl") else "glb"
    few = made(kind, MAX_PARTS)
    assert with_few_parts(few, ending) == few
    with pytest.raises(ValueError, match=f"{MAX_PARTS + 1} .*at most {MAX_PARTS}"):
        with_few_parts(made(kind, MAX_PARTS + 1), ending)


def test_materials_are_left_out_of_an_obj_file():
    given = b"mtllib a.mtl\nv 0 0 0\nusemtl m1\nf 1 2 3\r\n  usemtl m2\r\nf 1 2 4\ng usemtl\n"
    assert with_few_parts(given, "obj") == b"\nv 0 0 0\n\nf 1 2 3\r\n\r\nf 1 2 4\ng usemtl\n"


@pytest.mark.parametrize("last", ["ZZZZ9", "C999999"])
def test_a_sheet_with_a_cell_far_out_is_refused(last):
    with pytest.raises(InvalidArgumentError, match="1000000 cells"):
        rows_of_sheet(xlsx_bytes([["object"]], last=last), "table")
