"""No page violates a rule of axe-core: WCAG 2.2 level AA, and its best practices."""

import pytest
from playwright.sync_api import expect

from tests.api.explorer import axe
from tests.api.explorer.reading import BLOCK, COMPLETE, POINT, settle
from tests.api.explorer.test_object import HEADSTONE, SLAB
from tests.api.explorer.test_records import choose, short_record
from tests.sampling import but_long


@pytest.fixture(scope="module", autouse=True)
def _fetched():
    if not axe.fetch():
        pytest.skip(axe.HOW)


@pytest.mark.parametrize(("path", "scheme"), [pytest.param(POINT, "light", marks=pytest.mark.long), (BLOCK, "dark")])
def test_the_explorer_is_accessible(open_page, path, scheme):
    page = open_page(path, color_scheme=scheme)
    settle(page)
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    expect(page.locator("#rotation canvas")).to_be_visible()
    assert axe.violations(page) == []
    if path == BLOCK:
        page.locator("#open-report").click()
        expect(page.locator("#report")).to_be_visible()
        assert axe.violations(page) == []


def test_errors_are_accessible(open_page):
    page = open_page()
    settle(page)
    page.locator("#width").fill("-1")
    page.locator("#width").press("Enter")
    expect(page.locator("#width-problem")).to_be_visible()
    assert axe.violations(page) == []


def test_the_page_of_a_record_is_accessible(open_page):
    page = open_page("/records")
    expect(page.locator("#pulse-caution")).to_contain_text("does not replace it")  # of the example, the last one
    assert axe.violations(page) == []
    page.locator("#more summary").click()
    choose(page, "short.csv", short_record())
    expect(page.locator("#scales-caption")).to_contain_text("Hatched")
    assert axe.violations(page) == []


def test_the_page_of_objects_is_accessible(open_page):
    page = open_page("/objects")
    page.locator("#table").fill("object;width [cm];height [cm]\nvase;22;55\nslab;5;60\njug;wide;40")
    page.locator("#ask").click()
    expect(page.locator("#bad")).to_be_visible()
    assert_accessible_in_light_and_dark(page)


@pytest.mark.parametrize(
    "path", but_long([SLAB, HEADSTONE, SLAB.replace("width=40", "width=-1"), "/object?shape=mesh"], SLAB)
)
def test_the_page_of_one_object_is_accessible(open_page, path):
    page = open_page(path)
    if page.locator("details").count():
        page.locator("details summary").click()
    assert_accessible_in_light_and_dark(page)


@pytest.mark.parametrize("path", but_long(["/datasets", "/state", "/suites", "/nowhere"], "/datasets"))
def test_other_pages_are_accessible(open_page, path):
    page = open_page(path, failing=True)
    page.wait_for_function(COMPLETE.get(path, "() => true"))
    assert_accessible_in_light_and_dark(page)


def assert_accessible_in_light_and_dark(page):
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert axe.violations(page) == []
