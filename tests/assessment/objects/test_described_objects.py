"""Objects of tables that a kind of body describes."""

import json
import math

import numpy as np
import pytest
import rocking_assessment
from rocking_assessment._objects.objects import Bodies
from rocking_assessment._objects.tables import objects_of_csv, objects_of_json

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.body_kinds import body

BOX = [(-0.2, 0.0), (0.2, 0.0), (0.2, 1.6), (-0.2, 1.6)]
FRAME = rocking.EquivalentBlock.rocking_frame(rocking.Block(1.0, 8.0), mass_ratio=2.0)
ARCH = rocking.EquivalentBlock.masonry_arch(radius=10.0, thickness=1.5, embrace=math.radians(157.5), voussoirs=7)


def test_an_object_of_a_table_is_of_any_rigid_kind():
    text = (
        "name;body;width [cm];diameter (cm);height [cm];wall [mm];left;mass height;right;gyration [cm];notes\n"
        "box;;40;;160;;;;;;oak\n"
        "case;;40;;160;20;;;;;\n"
        "same case;hollow(width=40cm, height=1.6m, wall=2cm);;;;;;;;;\n"
        "column;;;40;160;;;;;;\n"
        "statue;;;;;;12 cm;40 cm;18 cm;;\n"
        "known;offset_mass;40;;160;;;;;50;\n"
        "cone;cone;40;;160;;;;;;\n"
    )
    table = objects_of_csv(text)
    objects = {obj.name: obj for obj in table.objects}
    assert [(bad.row, bad.columns) for bad in table.bad_rows] == [(8, ["body"])]
    assert type(objects["box"]) is rocking_assessment.Object
    assert objects["case"].planes == objects["same case"].planes
    expected = {
        "case": "hollow(width=40cm, height=1.6m, wall=2cm)",
        "statue": "two_edges(left=12cm, right=18cm, mass_height=40cm)",
        "known": "offset_mass(width=40cm, height=160cm, gyration=50cm)",
    }
    for name, description in expected.items():
        rigid, reference = Bodies.of([objects[name]]).scaled().rigid, body(description)
        for edge, other in ((rigid.right, reference.right), (rigid.left, reference.left)):
            np.testing.assert_allclose(edge.alpha, other.alpha, rtol=1e-12)
            np.testing.assert_allclose(edge.frequency_parameter, other.frequency_parameter, rtol=1e-12)
    json = '[{"name": "a", "width": "40 cm", "height": 1.6, "wall": 0.02}]'
    assert objects_of_json(json).objects[0].planes == objects["case"].planes
    assert rocking_assessment.Object.from_body(expected["case"]).planes == objects["case"].planes
    with pytest.raises(InvalidArgumentError, match="one rigid body"):
        rocking_assessment.Object.from_body("frame(width=1m, height=4m, mass_ratio=1)")


@pytest.mark.parametrize("kind", ["mesh(path=/etc/hostname)", "mesh"])
def test_a_table_of_objects_names_no_file(kind):
    for table in (
        objects_of_json(json.dumps([{"name": "a", "body": kind}])),
        objects_of_csv(f"name;width;height;body\na;40 cm;1.6 m;{kind}\n"),
    ):
        assert [bad.columns for bad in table.bad_rows] == [["body"]]
