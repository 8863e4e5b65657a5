"""The pages of objects and of one object in a browser, by keyboard and by touch: tables, dimensions, outline, mesh."""

import json
import re
import shlex

import numpy as np
import pytest
import rocking_assessment
from playwright.sync_api import expect
from typer.testing import CliRunner

from rocking._cli.app import app
from rocking._dimensional.table_reader import rows_of_sheet
from tests.api.explorer.hands import PHONE, Keyboard, Touch
from tests.api.explorer.reading import query
from tests.sampling import but_long
from tests.sheets import xlsx_bytes

TABLE = "name;width [cm];depth [cm];height [cm]\nbust;38;30;68\nslab;30;5;60\njug;wide;10;40\n"


def column(page, number):
    return page.locator(f"#ranking tbody tr > :nth-child({number})").all_inner_texts()


def test_which_of_thirty_objects_first_by_keyboard_alone(open_page):
    page = open_page("/objects")
    expect(page.locator("#ranking-title")).to_have_text("30 objects at 0.3 g and 30 cm/s")
    expect(page.locator("#count")).to_have_text("30 of 30 objects")
    assert column(page, 2)[0].startswith("Votive relief\nM 1956")  # with what identifies it
    assert column(page, 3)[0] == "overturns in most"
    factors = [float(text) for text in column(page, 4) if not text.startswith("above")]
    assert factors[:4] == sorted(factors[:4])
    other = page.locator("#ranking tbody tr").first.locator("details")
    page.locator("#filter").focus()
    Keyboard(page).press("#ranking summary")
    expect(other).to_contain_text("Along its width: stays, overturns from 3.98")
    page.locator("#ranking thead button", has_text="Object").focus()
    page.keyboard.press("Enter")
    names = [text.partition("\n")[0] for text in column(page, 2)]
    assert names == sorted(names, key=str.lower)
    page.keyboard.press("Enter")
    assert column(page, 2)[0].startswith(names[-1])
    page.locator("#verdict").select_option("rocks")
    assert set(column(page, 3)) == {"rocks"}
    page.locator("#filter").fill("saint")
    assert page.locator("#ranking tbody th a").all_inner_texts() == ["Wooden saint"]


@pytest.mark.long
def test_files_are_read_and_their_mistakes_mended_in_place_on_a_phone(open_page):
    page = open_page("/objects", **PHONE)
    row = page.locator("#ranking tbody tr").first
    cells = [row.locator(f"> :nth-child({k})").bounding_box() for k in range(2, 11)]
    assert all(one["x"] >= 0 and one["x"] + one["width"] <= 390 for one in cells)
    tops = [one["y"] for one in cells]
    assert tops == sorted(tops)  # name, verdict and factor first
    page.locator("#file").set_input_files({"name": "mine.csv", "mimeType": "text/csv", "buffer": TABLE.encode()})
    expect(page.locator("#preview-caption")).to_have_text("2 rows would be read, 1 not.")
    page.locator("#ask").tap()
    expect(page.locator("#bad-title")).to_have_text("1 of 3 rows were not read")
    expect(page.locator("#reason-4")).to_contain_text("wide")
    assert page.title().startswith("mine.csv: ")
    page.locator("[name=cell-4-1]").fill("12")
    page.locator("#ask").tap()
    expect(page.locator("#bad-title")).to_be_hidden()
    expect(page.locator("#count")).to_have_text("3 of 3 objects")
    with page.context.expect_page() as waiting:
        page.get_by_role("button", name="Report to print").tap()
    expect(waiting.value.locator("h1")).to_be_visible()
    waiting.value.close()
    expect(page.locator("#status")).to_have_text("The report opens in another tab.")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390

    rows = [["no", "name", "width [cm]", "height [cm]"], ["007", "vase", 22, 55.125], ["008", "jug", "20.5", "high"]]
    page.locator("#file").set_input_files({"name": "a.xlsx", "mimeType": "", "buffer": xlsx_bytes(rows)})
    expect(page.locator("#preview-caption")).to_have_text("1 row would be read, 1 not.")
    page.locator("#ask").tap()
    expect(page.locator("#bad-title")).to_have_text("1 of 2 rows were not read")
    expect(page.locator("#reason-3")).to_contain_text("height: 'high'; allowed")
    cell = page.locator("[name=cell-3-3]")
    assert cell.input_value() == "high"
    assert page.locator("#bad td:has(input)").get_attribute("data-label") == "height [cm]"
    cell.fill("40")
    page.locator("#ask").tap()
    expect(page.locator("#bad")).to_be_hidden()
    expect(page.locator("#count")).to_have_text("2 of 2 objects")
    assert page.locator("#ranking tbody th .small").all_inner_texts() == ["007", "008"]
    with page.expect_download() as download:
        page.get_by_role("button", name="Download XLSX").tap()
    written = rows_of_sheet(download.value.path().read_bytes(), "table")
    assert [row[3] for row in written[1:]] == ["55.125", "40"]
    with page.expect_download() as download:
        page.get_by_role("button", name="Download CSV").tap()
    assert [line.split(",")[1] for line in download.value.path().read_text().splitlines()[1:]] == ["vase", "jug"]
    page.locator("#file").set_input_files({"name": "a.png", "mimeType": "", "buffer": b"\x89PNG\r\n\x1a\n\0\0"})
    expect(page.locator("#table-problem")).to_contain_text("binary content; allowed: text")
    expect(page.locator("#count")).to_have_count(0)  # no answer of the earlier file
    page.locator("#table").fill(TABLE)
    page.locator("#pga").fill("0")
    page.locator("#ask").tap()
    expect(page.locator("#pga-problem")).to_contain_text("allowed")


@pytest.mark.long
def test_of_many_rows_those_that_are_seen_are_laid_out(open_page, service):
    page = open_page("/objects")
    rows = (f"object {n};{20 + n % 17};{40 + n % 61}" for n in range(250))
    page.locator("#table").fill("name;width [cm];height [cm]\n" + "\n".join(rows))
    page.locator("#table").press("Tab")
    expect(page.locator("#preview-caption")).to_have_text("250 rows would be read.")
    service.hold()
    page.locator("#ask").click()
    expect(page.locator("#status")).to_have_text(re.compile(r"Computing … \d+ s"))
    service.release()
    page.locator("#count").filter(has_text="100 of 250 objects").wait_for(timeout=90_000)
    page.locator("#filter").fill("object 249")
    expect(page.locator("#count")).to_have_text("1 of 250 objects")
    page.locator("#filter").fill("")
    page.locator("#more").click()
    expect(page.locator("#count")).to_have_text("200 of 250 objects")
    assert page.locator("#ranking tbody tr").count() == 200  # what is not seen is not laid out


def lowest_of(one):
    found = rocking_assessment.assess(
        one, rocking_assessment.Site(pga="0.3 g", pgv="30 cm/s"), sensitivity=False
    ).directions()
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
    given = rocking_assessment.Object("one", width=0.6, depth=0.22, height=1.6, offset_depth=0.03)
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
    expect_answer(page, "180° (left)", rocking_assessment.Object.from_outline(0.01 * np.array(corners)))
    expect(page.locator("#drawing circle")).to_have_count(5)


@pytest.mark.long
def test_a_mesh_is_read_and_a_damaged_one_explained_beside_its_field(open_page):
    trimesh = pytest.importorskip("trimesh")
    page = open_page("/object?shape=mesh", **PHONE)
    page.locator("#ask").tap()
    expect(page.locator("#file-problem")).to_have_text("Choose a file first.")
    page.locator("#unit").select_option("mm")
    content = trimesh.creation.box((400.0, 150.0, 1200.0)).export(file_type="stl")
    kind = "application/octet-stream"
    page.locator("#file").set_input_files({"name": "slab.stl", "mimeType": kind, "buffer": content})
    expect_answer(page, "90° (y axis) and 270°", rocking_assessment.Object("slab", width=0.4, depth=0.15, height=1.2))
    expect(page.locator("#dial-title")).to_contain_text("slab.stl")
    page.locator("#file").set_input_files({"name": "damaged.ply", "mimeType": kind, "buffer": b"no mesh"})
    expect(page.locator("#file-problem")).to_contain_text("allowed: a mesh that trimesh reads")
    assert page.locator("#file").get_attribute("aria-invalid") == "true"
    assert "stale" in page.locator("#result").get_attribute("class")


def german():
    """A workbook with a title above its header, and numbers as texts among numbers."""
    rows = [["Lapidarium"], ["Nr.", "Bezeichnung", "Breite (cm)", "Tiefe (cm)", "Höhe (cm)"]]
    return xlsx_bytes([*rows, ["12", "Büste", "38,5", 30, 68.25], ["13", "Stele", 52, "24,5", 148]])


def portuguese(encoding="cp1252"):
    return "Peça;Largura;Profundidade;Altura\r\nÂnfora;22,5;18;61\r\nSão João;30;25,5;110\r\n".encode(encoding)


def japanese(encoding="shift_jis"):
    return "作品名\t幅（mm）\t奥行（mm）\t高さ（mm）\n仏像\t380\t300\t1200\n石碑\t520\t240\t1480\n".encode(encoding)


TRIALS = {
    "objekte.xlsx": (
        german(),
        german(),
        {"skip": "1", "decimal": ","},
        {"name": "Bezeichnung", "width": "Breite (cm)", "depth": "Tiefe (cm)", "height": "Höhe (cm)"},
        "",
        [("Büste", 0.385, 0.3, 0.6825), ("Stele", 0.52, 0.245, 1.48)],
    ),
    "objetos.csv": (
        portuguese(),
        portuguese(),
        {"encoding": "windows-1252", "decimal": ","},
        {"name": "Peça", "width": "Largura", "depth": "Profundidade", "height": "Altura"},
        "cm",
        [("Ânfora", 0.225, 0.18, 0.61), ("São João", 0.3, 0.255, 1.1)],
    ),
    "sakuhin.tsv": (
        japanese(),
        japanese("utf-8"),  # as the page says beside its command
        {"encoding": "shift_jis"},
        {"name": "作品名", "width": "幅（mm）", "depth": "奥行（mm）", "height": "高さ（mm）"},
        "mm",
        [("仏像", 0.38, 0.3, 1.2), ("石碑", 0.52, 0.24, 1.48)],
    ),
}
"""Tables with other headers: the file, the file for the command, the layout, the columns, their unit, the objects."""


def state(page, name, value):
    """State a field of the form as a person does, and wait until the page shows the table read so."""
    field = page.locator(f"#{name}")
    if field.evaluate("field => field.tagName") == "SELECT":
        field.select_option(value)
    else:
        field.fill(value)
        field.press("Tab")
    expect(page.locator("#preview")).to_have_attribute("aria-busy", "false")


@pytest.mark.parametrize("name", but_long(TRIALS, "objekte.xlsx"))
def test_a_foreign_table_is_read_as_a_person_states_it(open_page, tmp_path, name):
    content, for_command, layout, columns, unit, expected = TRIALS[name]
    page = open_page("/objects")
    page.locator("#ranking").wait_for()
    page.locator("#file").set_input_files({"name": name, "mimeType": "", "buffer": content})
    expect(page.locator("[form=objects][aria-invalid=true]").first).to_be_visible()
    page.locator("#ask").click()  # in vain
    for field, value in layout.items():
        state(page, field, value)
    expect(page.locator("#column-width-problem")).to_be_visible()
    expect(page.locator("#ranking")).to_have_count(0)
    for quantity, label in columns.items():
        state(page, f"column-{quantity}", label)
        if unit and quantity != "name":
            state(page, f"unit-{quantity}", unit)
    expect(page.locator("#preview-caption")).to_have_text(f"{len(expected)} rows would be read.")
    expect(page.locator("#lines thead")).to_contain_text(f"height [{unit or 'cm'}]")
    expect(page.locator("#ranking")).to_have_count(0)  # nothing is assessed before it is confirmed
    page.locator("#ask").click()
    expect(page.locator("#count")).to_have_text(f"{len(expected)} of {len(expected)} objects")
    shown = dict(zip(page.locator("#ranking tbody th a").all_inner_texts(), column(page, 4), strict=True))
    objects = [rocking_assessment.Object(text, width=w, depth=d, height=h) for text, w, d, h in expected]
    site = rocking_assessment.Site(pga="0.3 g", pgv="30 cm/s")
    rows = rocking_assessment.assess(objects, site, sensitivity=False).rows
    for text, *_ in expected:
        factors = [row["factor"] for row in rows if row["object"] == text and row["factor"] is not None]
        assert shown[text].startswith(f"{min(factors):.3g}" if factors else "above")

    words = shlex.split(page.locator("#command").inner_text())
    (tmp_path / name).write_bytes(for_command)
    words = [str(tmp_path / word) if word == name else word for word in words[1:]]
    printed = CliRunner().invoke(app, [*words, "--no-sensitivity", "--format=json"])
    found = json.loads(printed.stdout)
    assert found["object"] == [row["object"] for row in rows]
    assert found["factor"] == [row["factor"] for row in rows]

    page.goto(page.url)
    expect(page.locator("#preview-status")).to_contain_text("choose the file")
    page.locator("#file").set_input_files({"name": name, "mimeType": "", "buffer": content})
    expect(page.locator("#preview-caption")).to_have_text(f"{len(expected)} rows would be read.")
    assert page.locator("#column-height").input_value() == columns["height"]
    page.locator("#clear").click()
    expect(page.locator("[form=objects][aria-invalid=true]").first).to_be_visible()
    assert query(page) == {}
