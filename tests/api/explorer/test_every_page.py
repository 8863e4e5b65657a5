"""What holds on every page: one navigation, large targets, and words while it waits; `open_page` sees its messages."""

import pytest
from playwright.sync_api import expect
from rocking_api.routers.pages import PAGES

from tests.api.explorer.reading import BLOCK, COMPLETE, query, settle
from tests.sampling import but_long

OWN = [page.path for page in PAGES if page.template or page.path == "/objects"]  # the guide is built apart

SMALL = """() => {
    const alone = (one) => one.parentElement.textContent.trim() === one.textContent.trim();
    const inText = (one) => getComputedStyle(one).display === "inline" && !alone(one);
    return [...document.querySelectorAll("a, button, input:not([type=hidden]), select, textarea, summary")]
        .filter((one) => one.checkVisibility() && !one.closest("#swagger-ui") && !inText(one))
        .map((one) => [one.id || one.textContent, one.getBoundingClientRect()])
        .filter(([, box]) => box.width > 0 && (box.height < 24 || box.width < 24))
        .map(([name, box]) => `${name}: ${box.width} x ${box.height}`);
}"""
"""Controls below 24 px in height or width; links within a sentence are as high as its lines."""


@pytest.mark.parametrize("path", but_long([*OWN, "/nowhere"], "/", "/objects"))
def test_no_message_one_navigation_and_large_targets(open_page, path):
    page = open_page(path, failing=path == "/nowhere", viewport={"width": 390, "height": 900})
    page.wait_for_function(COMPLETE.get(path, "() => true"))
    links = page.locator("nav[aria-label=Pages] a")
    there = [one.path for one in PAGES if one.label != "Guide"]  # which is not built
    for width in (390, 1400):
        page.set_viewport_size({"width": width, "height": 900})
        assert links.evaluate_all("all => all.map((one) => one.getAttribute('href'))") == there
        assert page.evaluate(SMALL) == []


@pytest.mark.parametrize(
    ("path", "words"),
    [("/datasets", "Reading the catalogue"), ("/suites", "Reading the catalogue"), ("/", "Computing")],
)
def test_a_page_says_within_a_second_what_it_waits_for(open_page, service, path, words):
    service.seconds = 1000.0
    page = open_page(path)
    expect(page.locator("[role=status]", has_text=words).first).to_be_visible(timeout=1000)
    service.seconds = 0.0


def test_changes_on_the_map_are_undone(open_page):
    page = open_page(BLOCK)
    settle(page)
    undo = page.locator("#undo")
    expect(undo).to_be_disabled()
    states = [page.evaluate("location.search")]
    for step in (
        lambda: page.locator("#map-marks").press("ArrowUp"),
        lambda: page.locator("#zoom-in").click(),
        lambda: page.locator("#map-marks").click(position={"x": 150, "y": 150}),
    ):
        expect(page.locator(".map")).to_have_attribute("aria-busy", "false")
        step()
        page.wait_for_function("before => location.search !== before", arg=states[-1])
        states.append(page.evaluate("location.search"))
    undo.click()
    page.wait_for_function("before => location.search === before", arg=states[2])
    page.locator("#map-marks").press("ControlOrMeta+z")
    page.wait_for_function("before => location.search === before", arg=states[1])
    page.reload()  # the history of the browser is still there
    undo.click()
    expect(undo).to_be_disabled()
    assert query(page)["acceleration"] == "0.4 g"
    page.go_forward()
    expect(undo).to_be_enabled()


def test_filters_of_the_data_sets_are_in_the_address_and_can_be_removed(open_page):
    page = open_page("/datasets?pulse=sine&eta=0.85")
    expect(page.locator("#status")).to_contain_text("2 of")
    page.locator("#filter").fill("nothing of this name")
    expect(page.locator("#status")).to_contain_text("0 of")
    assert "filter=nothing" in page.url
    page.get_by_role("button", name="Show all").click()
    expect(page.locator("#groups tbody tr:visible").first).to_be_visible()
    assert page.evaluate("location.search") == ""
