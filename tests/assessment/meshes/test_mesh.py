"""Meshes: unit and upward axis are stated; defects are repaired with a warning or refused by name."""

from __future__ import annotations

import json
import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._meshes.parts import MAX_PARTS, with_few_parts

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.table_reader import rows_of_sheet
from tests.sheets import xlsx_bytes

trimesh = pytest.importorskip("trimesh")

Mesh = trimesh.Trimesh


def box() -> Mesh:
    return trimesh.creation.box((0.4, 0.3, 1.2)).subdivide().subdivide()


def with_faces(mesh: Mesh, faces: object, vertices: object = ()) -> Mesh:
    points = np.vstack([mesh.vertices, np.reshape(vertices, (-1, 3))])
    return trimesh.Trimesh(points, faces, process=False)


def flipped(mesh: Mesh, which: slice) -> Mesh:
    faces = mesh.faces.copy()
    faces[which] = faces[which, ::-1]
    return with_faces(mesh, faces)


def without(mesh: Mesh, low: float, high: float = np.inf) -> Mesh:
    height = mesh.triangles_center[:, 2]
    return with_faces(mesh, mesh.faces[(height > low) & (height < high)])


FAR = [(3.0, 3.0, 3.0), (4.0, 3.0, 3.0), (4.0, 4.0, -3.0)]
REPAIRED = {
    "hole of four edges": (with_faces(box(), box().faces[1:]), "its holes were filled with 1 faces"),
    "one face flipped": (flipped(box(), slice(1)), "faces that pointed inwards"),
    "many faces flipped": (flipped(box(), slice(None, None, 3)), "faces that pointed inwards"),
    "inside out": (flipped(box(), slice(None)), "faces that pointed inwards"),
    "faces twice": (with_faces(box(), [*box().faces, *box().faces[:2]]), "2 of 194 were left out"),
}


@pytest.mark.parametrize("name", REPAIRED)
def test_repairs_are_warned_of(name: str, tmp_path: Path) -> None:
    mesh, remark = REPAIRED[name]
    mesh.export(tmp_path / "scan.ply")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        body = rocking_assessment.body_from_mesh(tmp_path / "scan.ply", unit="m")
    assert any(remark in str(warning.message) and "scan.ply" in str(warning.message) for warning in caught)
    for attribute in ("left", "right", "height", "gyration", "top_height"):
        assert float(body.parameters[attribute]) == pytest.approx(BOX[attribute], rel=1e-6)


BOX = {"left": 0.2, "right": 0.2, "height": 0.6, "gyration": float(np.sqrt(1.6 / 12.0)), "top_height": 1.2}


def test_bodies_side_by_side_and_cavities_have_their_volumes(tmp_path: Path) -> None:
    other = box()
    other.apply_translation((1.0, 0.0, 0.0))
    trimesh.util.concatenate([box(), other]).export(tmp_path / "pair.ply")
    with pytest.warns(UserWarning, match="2 separate surfaces, which are treated as one body"):
        pair = rocking_assessment.body_from_mesh(tmp_path / "pair.ply", unit="m")
    assert float(pair.width) == pytest.approx(1.4)
    assert float(pair.gyration) == pytest.approx(np.sqrt(1.6 / 12.0 + 0.25), rel=1e-6)
    cavity = trimesh.creation.box((0.2, 0.1, 0.6))
    cavity.invert()
    trimesh.util.concatenate([box(), cavity]).export(tmp_path / "hollow.ply")
    with pytest.warns(UserWarning, match="those whose faces point inwards are cavities"):
        hollow = rocking_assessment.body_from_mesh(tmp_path / "hollow.ply", unit="m")
    mass, hole = 0.4 * 0.3 * 1.2, 0.2 * 0.1 * 0.6
    inertia = (mass * 1.6 - hole * 0.4) / (mass - hole) / 12.0
    assert float(hollow.gyration) == pytest.approx(np.sqrt(inertia), rel=1e-6)


def test_map_coordinates_keep_the_digits(tmp_path: Path) -> None:
    mesh = box()
    corners = np.add(mesh.vertices, (500_000.0, 4_600_000.0, 120.0))
    lines = [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in corners]
    lines += [f"f {a} {b} {c}" for a, b, c in mesh.faces + 1]
    (tmp_path / "rock.obj").write_text("\n".join(lines))
    body = rocking_assessment.body_from_mesh(tmp_path / "rock.obj", unit="m")
    for attribute, value in BOX.items():
        assert float(body.parameters[attribute]) == pytest.approx(value, rel=1e-6)


PILLAR = (0.3, 0.25, 1.5)


def pillar(up: str) -> Mesh:
    """A pillar of 0.3 m x 0.25 m x 1.5 m, the axis of its height being `up`."""
    first, second, height = PILLAR
    return trimesh.creation.box({"x": (height, first, second), "y": (second, height, first), "z": PILLAR}[up])


@pytest.mark.parametrize("ending", ["stl", "ply", "obj"])
def test_the_unit_of_a_mesh_is_asked_for(ending: str, tmp_path: Path) -> None:
    mesh = pillar("z")
    mesh.apply_scale(1000.0)
    mesh.export(tmp_path / f"pillar.{ending}")
    for read in (rocking_assessment.body_from_mesh, rocking_assessment.Object.from_mesh):
        with pytest.raises(InvalidArgumentError, match="`unit` = None is not allowed; allowed: the unit of the len"):
            read(tmp_path / f"pillar.{ending}")
        with pytest.raises(InvalidArgumentError, match=r"a size of 1500 m; is its unit m\?"):
            read(tmp_path / f"pillar.{ending}", unit="m")
    body = rocking_assessment.body_from_mesh(tmp_path / f"pillar.{ending}", unit="mm")
    assert (float(body.width), float(body.top_height)) == pytest.approx((0.3, 1.5))
    mountain = rocking_assessment.body_from_mesh(tmp_path / f"pillar.{ending}", unit="m", allow_unusual=True)
    assert float(mountain.top_height) == pytest.approx(1500.0)


def test_gltf_is_in_metres_with_y_upwards_unless_stated(tmp_path: Path) -> None:
    pillar("y").export(tmp_path / "pillar.glb")
    body = rocking_assessment.body_from_mesh(tmp_path / "pillar.glb")
    assert (float(body.width), float(body.top_height)) == pytest.approx((0.3, 1.5))
    with pytest.warns(UserWarning, match="glTF, whose y axis points upwards; the stated axis z is used"):
        lying = rocking_assessment.body_from_mesh(tmp_path / "pillar.glb", up="z")
    assert float(lying.top_height) == pytest.approx(0.3)
    with pytest.warns(UserWarning, match="glTF, whose lengths are in m; the stated unit cm is used"):
        small = rocking_assessment.body_from_mesh(tmp_path / "pillar.glb", unit="cm")
    assert float(small.top_height) == pytest.approx(0.015)


@pytest.mark.parametrize("up", ["x", "y", "z"])
def test_the_upward_axis_is_stated(up: str, tmp_path: Path) -> None:
    """The directions of the body turn with the axes: a quarter turn exchanges the sides of the base."""
    pillar(up).export(tmp_path / "pillar.stl")
    for direction, width in ((0.0, 0.3), (np.pi / 2.0, 0.25)):
        body = rocking_assessment.body_from_mesh(tmp_path / "pillar.stl", direction, unit="m", up=up)
        assert (float(body.width), float(body.top_height)) == pytest.approx((width, 1.5))
    with pytest.raises(InvalidArgumentError, match="up"):
        rocking_assessment.body_from_mesh(tmp_path / "pillar.stl", unit="m", up="w")


def strip(turns: int) -> Mesh:
    """A closed strip with half turns."""
    angle = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    half = 0.5 * turns * angle
    across = 0.2 * np.stack([np.cos(half) * np.cos(angle), np.cos(half) * np.sin(angle), np.sin(half)], axis=1)
    centre = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    points = np.concatenate([centre - across, centre + across])
    k = np.arange(39)
    faces = [*np.column_stack([k, k + 1, k + 40]), *np.column_stack([k + 1, k + 41, k + 40])]
    faces += [(39, 40, 79), (40, 0, 79)] if turns % 2 else [(39, 0, 79), (0, 40, 79)]
    return trimesh.Trimesh(points, faces, process=False)


def stacked(walls: int) -> Mesh:
    """A box in two halves with one or two walls between them."""
    halves = [trimesh.creation.box((0.4, 0.3, 0.6)) for _ in range(2)]
    halves[1].apply_translation((0.0, 0.0, 0.6))
    mesh = trimesh.util.concatenate(halves)
    mesh.merge_vertices()
    between = np.flatnonzero(np.ptp(mesh.triangles[..., 2], axis=1) + np.abs(mesh.triangles_center[:, 2] - 0.3) < 1e-9)
    return with_faces(mesh, np.delete(mesh.faces, between[2 * walls :], axis=0))


def ragged() -> Mesh:
    ball = trimesh.creation.icosphere(3, 0.5)
    centre = ball.triangles_center
    return with_faces(ball, ball.faces[centre[:, 0] + 0.5 * np.sin(9.0 * centre[:, 2]) > -0.2])


@pytest.mark.parametrize(
    ("mesh", "defect"),
    [
        (ragged(), "is not closed: [0-9]+ edges have one face"),
        (without(box(), -0.59), "is not closed: 16 edges have one face"),
        (strip(1), "is not closed"),
        (trimesh.Trimesh(np.eye(3), [(0, 1, 2)], process=False), "3 edges have one face"),
        (stacked(1), "4 have more than two"),
        (with_faces(box(), [*box().faces, [98, 99, 100]], FAR), "1 surface that encloses nothing"),
    ],
)
def test_other_defects_are_named(mesh: Mesh, defect: str, tmp_path: Path) -> None:
    mesh.export(tmp_path / "scan.ply")
    for read in (rocking_assessment.body_from_mesh, rocking_assessment.Object.from_mesh):
        with pytest.raises(InvalidArgumentError, match=defect):
            read(tmp_path / "scan.ply", unit="m")


@pytest.mark.parametrize("size", [0.8e-6, 0.8e-4, 1.2e3, 0.8e6])
def test_meshes_and_outlines_have_the_size_of_objects(size: float, tmp_path: Path) -> None:
    trimesh.creation.box((size, size, size)).export(tmp_path / "cube.ply")
    with pytest.raises(InvalidArgumentError, match=r"`base` = .* allowed: \[0.0001, 1000\] \[m\]"):
        rocking_assessment.Object.from_mesh(tmp_path / "cube.ply", unit="m", allow_unusual=True)
    with pytest.raises(InvalidArgumentError, match="`base`"):
        rocking_assessment.Object.from_outline([(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)])
    assert rocking_assessment.Object.from_outline([(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)]).planes


def glb(**tree):
    text = json.dumps(tree).encode()
    return struct.pack("<IIIII", 0x46546C67, 2, 20 + len(text), len(text), 0x4E4F534A) + text


def ply(elements):
    return b"ply\nformat ascii 1.0\n" + b"element e 0\n" * elements + b"end_header\n"


@pytest.mark.parametrize(
    ("ending", "content"),
    [
        ("ply", ply),
        ("stl", lambda count: b" solid a\nendsolid a\n" * count),
        ("glb", lambda count: glb(nodes=[{}] * count)),
        ("glb", lambda count: glb(nodes=[{"children": [0] * count}])),
        ("glb", lambda count: glb(meshes=[{"primitives": [{}] * count}])),
    ],
)
def test_files_of_many_parts_are_refused(ending, content):
    few = content(MAX_PARTS)
    assert with_few_parts(few, ending) == few
    with pytest.raises(ValueError, match=f"{MAX_PARTS + 1} .*at most {MAX_PARTS}"):
        with_few_parts(content(MAX_PARTS + 1), ending)


def test_materials_are_left_out_of_an_obj_file():
    content = b"mtllib a.mtl\nv 0 0 0\nusemtl m1\nf 1 2 3\r\n  usemtl m2\r\nf 1 2 4\ng usemtl\n"
    assert with_few_parts(content, "obj") == b"\nv 0 0 0\n\nf 1 2 3\r\n\r\nf 1 2 4\ng usemtl\n"


@pytest.mark.parametrize("last", ["ZZZZ9", "C999999"])
def test_a_sheet_with_a_cell_far_out_is_refused(last):
    with pytest.raises(InvalidArgumentError, match="1000000 cells"):
        rows_of_sheet(xlsx_bytes([["object"]], last=last), "table")


def test_vertices_just_above_the_ground_are_no_contact(tmp_path: Path) -> None:
    """A body 1.7 m high on a base 0.4 m wide; its corners 0.25 m from the middle are 1.2 mm above the ground."""
    corners = [
        (x, y, z) for half, z in ((0.2, 0.0), (0.25, 0.0012), (0.25, 1.7)) for x in (-half, half) for y in (-half, half)
    ]
    trimesh.convex.convex_hull(np.array(corners)).export(tmp_path / "statue.ply")
    body = rocking_assessment.body_from_mesh(tmp_path / "statue.ply", unit="m")
    assert float(body.parameters["right"]) == pytest.approx(0.2, rel=1e-3)
    wide = rocking_assessment.body_from_mesh(tmp_path / "statue.ply", unit="m", contact_tolerance=1e-3)
    assert float(wide.parameters["right"]) == pytest.approx(0.25, rel=1e-3)
    with pytest.raises(rocking.InvalidArgumentError, match="contact_tolerance"):
        rocking_assessment.body_from_mesh(tmp_path / "statue.ply", unit="m", contact_tolerance=0.2)
    statue = rocking_assessment.Object.from_mesh(tmp_path / "statue.ply", unit="m")
    table = rocking_assessment.assess(statue, rocking_assessment.Site(3.0, 0.3, shapes=["sine"]), sensitivity=False)
    assert table.columns["contact_tolerance"] == pytest.approx(1.7e-4, rel=1e-6)
    assert statue.planes_around.keys() >= {15.0 * k for k in range(12)}  # all rows of the table count
    assert np.nanmin(table.directions()["factor"]) == pytest.approx(np.nanmin(table.columns["factor"]), rel=1e-9)
