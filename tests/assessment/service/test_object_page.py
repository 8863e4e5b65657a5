"""The page of one object as the service renders it: numbers of the package, meshes, damaged and hostile files."""

import re
import struct
from html import unescape
from urllib.parse import parse_qsl, urlsplit

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment.service import mesh_reader, object_page
from rocking_assessment.service.dial import worst_directions

from tests.api.conftest import assert_problem
from tests.api.test_uploads import TRIANGLE, scene
from tests.api.test_uploads import glb_file as glb
from tests.sampling import but_long, number

trimesh = pytest.importorskip("trimesh")

FLOOR = number({}, {"floor_periods": "0.5"})
"""With a floor the page takes ten seconds."""

SITE = {"pga": "0.3", "pga_unit": "g", "pgv": "30", "pgv_unit": "cm/s"}
BUST = {"shape": "rectangle", "name": "<b>bust</b>", "width": "38", "depth": "25", "height": "120", "offset_width": "5"}
OUTLINE = "0, 0\n30, 0\n30 100; 10 120\n0, 100"


def directions_of(obj):
    return rocking_assessment.assess(
        obj, rocking_assessment.Site(pga="0.3 g", pgv="30 cm/s"), sensitivity=False
    ).directions()


def table(text):
    """Cells of the table of factors by direction, as text."""
    body = re.search(r'<table id="factors">.*?<tbody>(.*?)</tbody>', text, re.DOTALL)[1]
    return [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in re.findall(r"<tr>(.*?)</tr>", body)]


def assert_table_of(text, factors):
    rows = table(text)
    assert [float(re.match(r"[\d.]+", row[0])[0]) for row in rows] == factors["direction"].values.tolist()
    for row, factor in zip(rows, factors["factor"].values, strict=True):
        assert row[1] == ("above 10" if np.isnan(factor) else f"{factor:.3g}")
    assert [float(re.match(r"[\d.]+", row[0])[0]) for row in rows if "worst" in row[0]] == worst_directions(factors)


def posted(client, content, name, **fields):
    return client.post("/object", params=SITE | {"file": name} | fields, content=content)


@pytest.fixture(scope="module")
def slab():
    """A slab that is turned, in millimetres."""
    mesh = trimesh.creation.box((400.0, 150.0, 1200.0))
    mesh.apply_transform(trimesh.transformations.rotation_matrix(np.radians(20.0), (0.0, 0.0, 1.0)))
    return mesh


def test_factors_are_those_of_the_package_and_the_worst_is_marked(client):
    text = client.get("/object", params=BUST | SITE).text
    factors = directions_of(rocking_assessment.Object("bust", width=0.38, depth=0.25, height=1.2, offset_width=0.05))
    assert_table_of(text, factors)
    (worst,) = worst_directions(factors)
    assert f"Worst direction: {worst:g}°" in re.search(r'id="worst">(.*?)<', text)[1]
    assert text.count('class="diamond"') == 1
    full = factors["at_full_strength"].sel(direction=worst).item()
    assert ("overturns it at full strength" in text) == full
    assert "&lt;b&gt;bust&lt;/b&gt; at 0.3 g" in text
    assert "<b>" not in text


def test_a_missing_depth_is_said(client):
    query = {"shape": "rectangle", "width": "85", "height": "170"}
    assert "Depth missing: measure the depth." in client.get("/object", params=query | SITE).text
    assert "Depth missing" not in client.get("/object", params=query | {"depth": "60"} | SITE).text
    table = "name,width [m],height [m]\nshelf,0.85,1.7\n"
    text = client.post("/objects", data={"table": table, **SITE}).text
    assert re.search(r'verdict-2">depth missing<', text)
    assert ">measure the depth<" in text
    headers = {"Content-Type": "text/csv"}
    query = {"pga": 3.0, "pgv": 0.3, "format": "json"}
    answer = client.post("/v1/assess", params=query, content=table, headers=headers).json()
    assert answer["rows"][0]["verdict"] == "depth missing"


def test_round_bases_and_outlines(client):
    drum = {"shape": "round", "diameter": "0,35", "diameter_unit": "m", "height": "120", "restitution": "0.9"}
    text = client.get("/object", params=drum | SITE).text
    assert_table_of(text, directions_of(rocking_assessment.Object("drum", diameter=0.35, height=1.2, restitution=0.9)))
    assert "all are alike" in text
    text = client.get("/object", params={"shape": "outline", "vertices": OUTLINE} | SITE).text
    corners = [(0.0, 0.0), (0.3, 0.0), (0.3, 1.0), (0.1, 1.2), (0.0, 1.0)]
    assert_table_of(text, directions_of(rocking_assessment.Object.from_outline(corners)))


def test_each_row_of_the_table_of_objects_leads_to_its_directions(client):
    form = {"table": "name;width [cm];depth [cm];height [cm];restitution\nvase & jug;22.5;18;55;0.9\n", **SITE}
    text = client.post("/objects", data=form | FLOOR).text
    (address,) = (unescape(link) for link in re.findall(r'href="(/object\?[^"]*)"', text))
    fields = dict(parse_qsl(urlsplit(address).query, keep_blank_values=True))
    assert (fields["name"], fields["width"], fields["restitution"]) == ("vase & jug", "22.5", "0.9")
    page = client.get(address).text
    factors = {row[0].split()[0]: row[1] for row in table(page)}
    (worse,) = re.findall(r"<summary>along its (\w+)</summary>", text)
    (lower,) = re.findall(r'data-label="Overturns from factor">([\d.]+)<', text)
    ((other, higher),) = re.findall(r"Along its (\w+): [\w ]+, overturns from ([\d.]+)<", text)
    for name, factor in ((worse, lower), (other, higher)):
        assert factors[{"width": "0°", "depth": "90°"}[name]] == factor
    assert ("on a floor of a building of 0.5 s" in page) is bool(FLOOR)


@pytest.mark.parametrize(
    ("fields", "name"),
    [({"height": "-3"}, "height"), ({"width": ""}, "width"),
     ({"offset_width": "30"}, "offset_width"), ({"pga": "much"}, "pga"), ({"pgv": "1e9"}, "pgv"),
     ({"restitution": "2"}, "restitution"),
     ({"floor_periods": "0," * 200}, "floor_periods"),
     ({"width": "9" * 5000}, "width"), ({"width_unit": "furlong"}, "width"),
     ({"shape": "outline", "vertices": "0, 0\nwide"}, "vertices"),
     ({"shape": "outline", "vertices": "0, 0\n1, 1\n1, 0\n0, 1"}, "vertices"),
     ({"shape": "outline", "vertices": "0 0\n" * 201}, "vertices"),
     ({"shape": "outline", "vertices": " " * 10_001}, "vertices")],
)  # fmt: skip
def test_what_is_wrong_is_said_beside_its_field(client, fields, name):
    response = client.get("/object", params=BUST | SITE | fields)
    assert response.status_code == 422
    (words,) = re.findall(rf'<p class="wrong" id="{name}-problem"[^>]*>([^<]+)<', response.text)
    assert "allowed" in words
    assert re.search(rf'id="{name}"[^>]*aria-invalid="true"', response.text)
    assert "see the field marked in red" in response.text


def test_other_faults_of_an_address(client):
    assert_problem(client.get("/object", params={"shape": "sphere"}), 422, "shape")
    assert client.get("/object?shape=mesh&pga=0.3").status_code == 200
    assert client.put("/object").status_code == 405
    for shape in object_page.SHAPES:
        assert 'aria-current="page"' in client.get("/object", params={"shape": shape}).text


@pytest.mark.parametrize("ending", but_long(["stl", "ply", "obj", "glb"], "obj", "glb"))
def test_a_mesh_is_the_object_that_it_shows(client, slab, ending):
    if ending == "glb":  # with y upwards
        slab = slab.copy()
        slab.vertices = slab.vertices[:, [1, 2, 0]]
    content = slab.export(file_type=ending)
    response = posted(client, content, f"slab.{ending}", unit="mm")
    assert response.status_code == 200
    plain = directions_of(rocking_assessment.Object("slab", width=0.4, depth=0.15, height=1.2))
    lowest = float(plain["factor"].min())
    assert f"From {lowest:.3g} times" in response.text
    assert "110° and 290°" in response.text
    assert "is not closed" not in response.text


def test_an_open_mesh_is_doubted_and_the_defect_of_another_named(client, slab):
    gap = slab.copy()
    gap.update_faces(np.arange(len(gap.faces)) > 0)
    assert "The mesh was not closed" in posted(client, gap.export(file_type="stl"), "gap.stl", unit="mm").text
    ball = trimesh.creation.icosphere(3, 500.0)
    rough = np.flatnonzero(ball.triangles_center[:, 0] + 500.0 * np.sin(0.01 * ball.triangles_center[:, 2]) > -200.0)
    ball.update_faces(rough)
    problem = assert_problem(posted(client, ball.export(file_type="stl"), "rock.stl", unit="mm"), 422, "mesh")
    assert "is not closed" in problem["allowed"]
    assert "MiB" not in problem["detail"]


AXES = b"".join(b"property float %s\n" % axis for axis in (b"x", b"y", b"z"))
HEADER = b"ply\nformat %s 1.0\nelement vertex 99999999999\n" + AXES + b"end_header\n"
HOSTILE = {
    "empty.stl": b"",
    "count.stl": bytes(80) + struct.pack("<I", 2**32 - 1) + bytes(50),
    "count.ply": HEADER % b"binary_little_endian" + bytes(100),
    "index.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999\n",
    "nan.obj": b"v nan 0 0\nv 1 0 0\nv 0 1 inf\nv 0 0 1\nf 1 2 3\nf 1 2 4\n",
    "point.obj": b"v 0 0 0\nv 1 0 1\nv 0 1 1\nv 1 1 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
    "zeros.glb": glb(scene(3, accessors=[{"componentType": 5126, "count": 10**10, "type": "VEC3"}])),
    "other.glb": glb(scene(75, buffers=[{"uri": "/etc/passwd", "byteLength": 900}])),
    "twice.glb": glb(scene(3, nodes=[*({"children": [k + 1, k + 1]} for k in range(40)), {"mesh": 0}]), TRIANGLE),
    "cycle.glb": glb(scene(3, nodes=[{"children": [0], "mesh": 0}]), TRIANGLE),
    "nested.glb": struct.pack("<IIIII", 0x46546C67, 2, 100_020, 100_000, 0x4E4F534A) + b"[" * 100_000,
}


@pytest.mark.parametrize("name", but_long(HOSTILE, "index.obj", "other.glb", "nested.glb"))
def test_damaged_and_hostile_meshes_are_refused(client, name):
    problem = assert_problem(posted(client, HOSTILE[name], name), 422, "mesh")
    assert problem["value"] == name
    assert "/tmp" not in problem["detail"]


def test_meshes_of_other_formats_units_and_sizes_are_refused(client, slab):
    content = slab.export(file_type="stl")
    assert_problem(posted(client, content, "slab.gltf"), 415, "mesh")
    assert_problem(posted(client, content, "slab"), 415, "mesh")
    assert_problem(posted(client, content, "slab.stl", unit="furlong"), 422, "unit")
    assert_problem(posted(client, content, "slab.stl", pga="much"), 422, "pga")
    assert_problem(posted(client, content, "slab.stl", restitution="2"), 422, "restitution")
    assert_problem(posted(client, bytes(mesh_reader.MAX_MESH + 1), "slab.stl"), 413, "body")


def test_a_pga_suffices_with_periods_and_an_empty_pgv_is_asked_for_with_a_usual_value(client):
    form = {"shape": "rectangle", "width": "40", "height": "160", "pga": "0.3", "pga_unit": "g", "pgv": ""}
    page = client.get("/object", params=form)
    assert page.status_code == 422
    assert "pgv is missing; needed: a number, usually about 100 cm/s for each g of PGA" in unescape(page.text)
    assert client.get("/object", params=form | {"period_min": "0.2"}).status_code == 422
    page = client.get("/object", params=form | {"period_min": "0.2", "period_max": "0,4"})
    assert page.status_code == 200
    assert "0.3 g and periods from 0.2 to 0,4 s" in page.text
