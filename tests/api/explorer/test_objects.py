"""The page of objects in a browser: sample, files, correction in place, sorting, filtering, many rows."""

import re

from playwright.sync_api import expect

from rocking._dimensional.table_reader import rows_of_sheet
from tests.api.explorer.hands import PHONE, Keyboard
from tests.sheets import xlsx_bytes

TABLE = "object;width [cm];depth [cm];height [cm]\nbust;38;30;68\nslab;30;5;60\njug;wide;10;40\n"


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


def test_files_are_read_and_their_mistakes_mended_in_place_on_a_phone(open_page):
    page = open_page("/objects", **PHONE)
    row = page.locator("#ranking tbody tr").first
    cells = [row.locator(f"> :nth-child({k})").bounding_box() for k in range(2, 10)]
    assert all(one["x"] >= 0 and one["x"] + one["width"] <= 390 for one in cells)
    tops = [one["y"] for one in cells]
    assert tops == sorted(tops)  # name, verdict and factor first
    page.locator("#file").set_input_files({"name": "mine.csv", "mimeType": "text/csv", "buffer": TABLE.encode()})
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

    rows = [["no", "object", "width [cm]", "height [cm]"], ["007", "vase", 22, 55.125], ["008", "jug", "20,5", "high"]]
    page.locator("#file").set_input_files({"name": "a.xlsx", "mimeType": "", "buffer": xlsx_bytes(rows)})
    expect(page.locator("#bad-title")).to_have_text("1 of 2 rows were not read")
    expect(page.locator("#reason-3")).to_contain_text("height = 'high' is not allowed")
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
    page.locator("#pga").fill("0")
    page.locator("#ask").tap()
    expect(page.locator("#pga-problem")).to_contain_text("allowed")


def test_of_many_rows_those_that_are_seen_are_laid_out(open_page, service):
    page = open_page("/objects")
    rows = (f"object {n};{20 + n % 17};{40 + n % 61}" for n in range(500))
    page.locator("#table").fill("object;width [cm];height [cm]\n" + "\n".join(rows))
    service.hold()
    page.locator("#ask").click()
    expect(page.locator("#status")).to_have_text(re.compile(r"Computing … \d+ s"))
    service.release()
    page.locator("#count").filter(has_text="100 of 500 objects").wait_for(timeout=90_000)
    page.locator("#filter").fill("object 499")
    expect(page.locator("#count")).to_have_text("1 of 500 objects")
    page.locator("#filter").fill("")
    page.locator("#more").click()
    expect(page.locator("#count")).to_have_text("200 of 500 objects")
    assert page.locator("#ranking tbody tr").count() == 200  # what is not seen is not laid out
