"""Bodies by their descriptions: one declared union for Python, options, tables and configurations."""

import math

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._dimensional.body_kinds import body

BOX = [(-0.2, 0.0), (0.2, 0.0), (0.2, 1.6), (-0.2, 1.6)]
FRAME = rocking.EquivalentBlock.rocking_frame(rocking.Block(1.0, 8.0), mass_ratio=2.0)
ARCH = rocking.EquivalentBlock.masonry_arch(radius=10.0, thickness=1.5, embrace=math.radians(157.5), voussoirs=7)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("rectangle(width=40 cm, height=1.6m)", rocking.Block(0.4, 1.6)),
        ("offset_mass(width=40cm, height=1.6m, offset=5cm)", rocking.RigidBody.from_size(0.4, 1.6, offset=0.05)),
        ("offset_mass(width=40cm, height=1.6m)", rocking.Block(0.4, 1.6)),
        ("two_edges(left=12cm,right=18cm,mass_height=40cm,gyration=30 cm)", rocking.RigidBody(0.12, 0.18, 0.4, 0.3)),
        ("outline(vertices=-0.2 0; 0.2 0; 0.2 1.6; -0.2 1.6)", rocking.RigidBody.from_polygon(BOX)),
        ("frame(width=1m, height=8m, mass_ratio=200 %)", FRAME),
        ("arch(radius=10m, thickness=1.5m, embrace=157.5deg, voussoirs=7)", ARCH),
    ],
)
def test_a_text_makes_the_body(text, expected):
    assert body(text) == expected


def test_a_mapping_names_the_kind_or_has_its_parameters():
    given = {"width": "40 cm", "height": 1.6}
    assert body(given) == body({"kind": "rectangle", **given}) == rocking.body("rectangle", **given)
    assert body(given | {"offset": "5 cm"}) == rocking.RigidBody.from_size(0.4, 1.6, offset=0.05)
    assert body({"diameter": "30 cm", "height": "1.2 m"}) == body("cylinder", diameter=0.3, height=1.2)
    widths = np.array([0.3, 0.4])
    assert body("hollow", width=widths, height=1.6, wall="2 cm").shape == (2,)


def test_gyration_of_parts_is_that_of_the_whole():
    inner, outer = 0.36 * 1.56, 0.4 * 1.6
    square = (outer * (0.4**2 + 1.6**2) - inner * (0.36**2 + 1.56**2)) / 12.0 / (outer - inner)
    hollow = body("hollow(width=40cm, height=1.6m, wall=2cm)")
    assert float(hollow.gyration) == pytest.approx(math.sqrt(square), rel=1e-14)
    pedestal = "pedestal_width=40cm, pedestal_height=40cm, pedestal_mass=0.3333333333"
    whole, same = body(f"on_pedestal(width=40cm, height=1.2m, {pedestal})"), rocking.RigidBody.from_size(0.4, 1.6)
    assert (float(whole.gyration), float(whole.height)) == pytest.approx((float(same.gyration), 0.8), rel=1e-9)


@pytest.mark.parametrize(
    ("text", "parameter"),
    [
        ("cone(width=1m)", "body"),
        ("-rectangle(width=1m, height=2m)", "body"),
        ("rectangle(width=1m, width=2m)", "body"),
        ("rectangle(width=1m)", "height"),
        ("rectangle(width=1m, height=2m, wall=1cm)", "wall"),
        ("rectangle(width=1, height=2m)", "width"),
        ("hollow(width=40cm, height=1.6m, wall=20cm)", "wall"),
        ("outline(vertices=a b)", "vertices"),
        ({"width": 1.0, "wall": 0.1}, "height"),
        ({"width": 1.0, "radius": 0.1}, "body"),
        (3.0, "body"),
    ],
)
def test_what_is_no_description_is_refused_by_its_parameter(text, parameter):
    with pytest.raises(InvalidArgumentError, match=f"`{parameter}`"):
        body(text)
