"""The page of one object in a browser: by keyboard and by touch, from dimensions, an outline and a mesh."""

import re

import numpy as np
import pytest
from playwright.sync_api import expect

import rocking
from tests.api.explorer.hands import PHONE, Keyboard, Touch
from tests.api.explorer.reading import query


def lowest_of(one):
    found = rocking.assess(one, rocking.Site(pga="0.3 g", pgv="30 cm/s"), sensitivity=False).directions()
    return float(found["factor"].min())


def expect_answer(page, direction, one):
    words = re.compile(re.escape(f"Worst direction: {direction}. From {lowest_of(one):.3g} times"))
    expect(page.locator("#worst")).to_have_text(words)
    expect(page.locator(".dial svg")).to_be_visible()


def test_in_which_direction_does_an_object_overturn_by_keyboard(open_page):
    page = open_page("/object")
    hand = Keyboard(page)
    for name, value in {"width": "60", "depth": "22", "offset_depth": "3"}.items():
        hand.write(f"#{name}", value)
    hand.press("#ask")
    given = rocking.Object("one", width=0.6, depth=0.22, height=1.6, offset_depth=0.03)
    expect_answer(page, "270°", given)
    assert query(page)["offset_depth"] == "3"
    page.reload()
    expect_answer(page, "270°", given)
    hand = Keyboard(page)
    hand.press("details summary")
    expect(page.locator("#factors tr", has_text="worst")).to_contain_text("270°")
    assert page.evaluate("document.documentElement.scrollWidth") <= page.evaluate("innerWidth")
    hand.write("#height", "0")
    hand.press("#ask")
    expect(page.locator("#height-problem")).to_contain_text("allowed")
    page.go_back()
    expect_answer(page, "270°", given)


def test_an_outline_is_drawn_on_a_phone(open_page):
    page = open_page("/object?shape=outline", **PHONE)
    hand, drawing = Touch(page), page.locator("#drawing")
    corners = [(0, 0), (30, 0), (30, 100), (10, 120), (0, 100)]
    for _ in corners:
        hand.press("#undo")
    expect(page.locator("#vertices")).to_have_value("")
    for x, y in [*corners, (150, 150)]:
        drawing.scroll_into_view_if_needed()
        place = page.evaluate(
            """([x, y]) => {
                const drawing = document.getElementById("drawing");
                const found = new DOMPoint(x, -y).matrixTransform(drawing.getScreenCTM());
                return [found.x, found.y];
            }""",
            [x, y],
        )
        page.touchscreen.tap(*place)
    expect(page.locator("#drawing circle")).to_have_count(6)
    hand.press("#undo")
    expect(page.locator("#drawing circle")).to_have_count(5)
    read = [tuple(map(float, line.split(","))) for line in page.locator("#vertices").input_value().splitlines()]
    assert read == corners
    hand.press("#ask")
    expect_answer(page, "180° (left)", rocking.Object.from_outline(0.01 * np.array(corners)))
    expect(page.locator("#drawing circle")).to_have_count(5)


def test_a_mesh_is_read_and_a_damaged_one_explained_beside_its_field(open_page):
    trimesh = pytest.importorskip("trimesh")
    page = open_page("/object?shape=mesh", **PHONE)
    page.locator("#ask").tap()
    expect(page.locator("#file-problem")).to_have_text("Choose a file first.")
    page.locator("#unit").select_option("mm")
    content = trimesh.creation.box((400.0, 150.0, 1200.0)).export(file_type="stl")
    kind = "application/octet-stream"
    page.locator("#file").set_input_files({"name": "slab.stl", "mimeType": kind, "buffer": content})
    expect_answer(page, "90° (y axis) and 270°", rocking.Object("slab", width=0.4, depth=0.15, height=1.2))
    expect(page.locator("#dial-title")).to_contain_text("slab.stl")
    page.locator("#file").set_input_files({"name": "damaged.ply", "mimeType": kind, "buffer": b"no mesh"})
    expect(page.locator("#file-problem")).to_contain_text("allowed: a mesh that trimesh reads")
    assert page.locator("#file").get_attribute("aria-invalid") == "true"
    assert "stale" in page.locator("#result").get_attribute("class")
