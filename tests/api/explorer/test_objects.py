"""The page of objects in a browser: sample, file, correction in place, sorting, filtering, many rows."""

import re

import pytest
from playwright.sync_api import expect

TABLE = "object;width [cm];depth [cm];height [cm]\nbust;38;30;68\nslab;30;5;60\njug;wide;10;40\n"


@pytest.fixture(scope="module")
def many():
    rows = (f"object {n};{20 + n % 17};{40 + n % 61}" for n in range(500))
    return "object;width [cm];height [cm]\n" + "\n".join(rows)


def column(page, number):
    return page.locator(f"#ranking tbody tr > :nth-child({number})").all_inner_texts()


def test_which_of_thirty_objects_first_by_keyboard_alone(open_page):
    page = open_page("/objects")
    for _ in range(40):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.textContent") == "take the sample of thirty objects":
            break
    page.keyboard.press("Enter")
    expect(page.locator("#ranking-title")).to_have_text("30 objects at 0.3 g and 30 cm/s")
    expect(page.locator("#count")).to_have_text("51 of 51 rows")
    assert column(page, 2)[0] == "Votive relief"
    assert column(page, 4)[0] == "overturns in most"
    factors = [float(text) for text in column(page, 5) if not text.startswith("above")]
    assert factors[:4] == sorted(factors[:4])
    page.locator("#ranking thead button", has_text="Object").focus()
    page.keyboard.press("Enter")
    names = column(page, 2)
    assert names == sorted(names, key=str.lower)
    page.keyboard.press("Enter")
    assert column(page, 2)[0] == names[-1]
    page.locator("#verdict").select_option("rocks")
    assert set(column(page, 4)) == {"rocks"}
    page.locator("#filter").fill("saint")
    assert set(column(page, 2)) == {"Wooden saint"}
    with page.expect_download() as download:
        page.get_by_role("button", name="Download CSV").click()
    assert download.value.path().read_text().count("\n") == 52


def test_a_file_is_read_and_its_mistake_mended_in_place_by_touch(open_page):
    page = open_page("/objects", has_touch=True, viewport={"width": 390, "height": 844})
    page.locator("#file").set_input_files({"name": "mine.csv", "mimeType": "text/csv", "buffer": TABLE.encode()})
    expect(page.locator("#bad-title")).to_have_text("1 of 3 rows were not read")
    expect(page.locator("#reason-4")).to_contain_text("wide")
    assert page.title().startswith("mine.csv: ")
    page.locator("#line-4").fill("jug;12;10;40")
    page.locator("#ask").tap()
    expect(page.locator("#bad-title")).to_be_hidden()
    expect(page.locator("#count")).to_have_text("6 of 6 rows")
    with page.context.expect_page() as waiting:
        page.get_by_role("button", name="Report to print").tap()
    expect(waiting.value.locator("h1")).to_be_visible()
    expect(page.locator("#status")).to_have_text("The report opens in another tab.")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    page.locator("#pga").fill("0")
    page.locator("#ask").tap()
    expect(page.locator("#pga-problem")).to_contain_text("allowed")


def test_of_many_rows_those_that_are_seen_are_laid_out(open_page, service, many):
    page = open_page("/objects")
    page.locator("#table").fill(many)
    service.seconds = 1000.0
    page.locator("#ask").click()
    expect(page.locator("#status")).to_have_text(re.compile(r"Computing … \d+ s"))
    service.seconds = 0.0
    page.locator("#count").filter(has_text="100 of 500 rows").wait_for(timeout=90_000)
    page.locator("#filter").fill("object 499")
    expect(page.locator("#count")).to_have_text("1 of 500 rows")
    page.locator("#filter").fill("")
    page.locator("#more").click()
    expect(page.locator("#count")).to_have_text("200 of 500 rows")
    assert page.locator("#ranking tbody tr").count() == 200  # what is not seen is not laid out
