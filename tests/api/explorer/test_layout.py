"""No control, text or picture overlaps another one or lies outside the page, at any width, and with text of 200 %."""

import pytest
from playwright.sync_api import expect

from tests.api.explorer.reading import BLOCK, POINT, settle
from tests.api.explorer.test_object import HEADSTONE, SLAB
from tests.api.explorer.test_records import choose, short_record
from tests.sampling import but_long, number

OVERLAPS = """() => {
    const parts = "input, select, button, a, label, output, #map-marks, #legend span, h1, h2, h3, p, dt, dd, canvas";
    const boxes = [...document.querySelectorAll(parts)]
        .filter((one) => one.checkVisibility() && !one.closest(".map, .table"))
        .flatMap((one) => [...one.getClientRects()].map((box) => ({ one, box })))  // a link may take two lines
        .filter(({ box }) => box.width && box.height);
    const name = (one) => one.id || one.name || one.textContent;
    const found = [];
    boxes.forEach(({ one, box }, n) => {
        if (box.left < 0 || box.right > innerWidth) found.push(`${name(one)} is outside`);
        for (const { one: other, box: rest } of boxes.slice(n + 1)) {
            const across = Math.min(box.right, rest.right) - Math.max(box.left, rest.left);
            const up = Math.min(box.bottom, rest.bottom) - Math.max(box.top, rest.top);
            if (across > 0.5 && up > 0.5 && !one.contains(other)) found.push(`${name(one)} over ${name(other)}`);
        }
    });
    return found;
}"""

WIDTHS = range(320, 1441, number(160, 40))
"""Widths of the window [px]."""

# The charts follow the width of the window when the browser draws its next frame, before anything is seen.
NEXT_FRAME = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


@pytest.mark.parametrize("path", [POINT, BLOCK])
def test_nothing_overlaps_on_the_explorer(open_page, path):
    page = open_page(path, viewport={"width": 320, "height": 900})
    settle(page)
    page.locator("#spectrum-chart canvas").wait_for()
    page.wait_for_function("() => document.querySelectorAll('.downloads a[href]').length >= 7")
    assert overlaps_by_width(page) == {}


PATHS = [SLAB, HEADSTONE, "/objects", "/records", "/suites", "/datasets", "/state"]


@pytest.mark.parametrize("path", but_long(PATHS, "/objects"))
def test_nothing_overlaps_on_the_other_pages(open_page, path):
    page = open_page(path, viewport={"width": 320, "height": 900})
    if path == "/records":
        page.locator("#more summary").click()
        choose(page, "short.csv", short_record())
        expect(page.locator("#scales-caption")).to_contain_text("Hatched")
    elif path == "/suites":
        expect(page.locator("#status")).to_contain_text("4 records")
    elif path == "/objects":
        page.locator("#table").fill("object;width [cm];height [cm]\nvase;22;55\njug;wide;40")
        page.locator("#ask").click()
        expect(page.locator("#ranking")).to_be_visible()
    elif path in (SLAB, HEADSTONE):
        page.locator("details summary").click()
    else:
        expect(page.locator("#status")).not_to_contain_text("…")
    assert overlaps_by_width(page) == {}


def overlaps_by_width(page):
    """Boxes over each other or outside, by width of the window and size of the text; nothing is wider than it."""
    found = {}
    sizes = [*((width, "100%") for width in WIDTHS), *((width, "200%") for width in (390, 768, 1400))]
    for width, text in sizes:
        page.set_viewport_size({"width": width, "height": 900})
        page.evaluate("size => { document.documentElement.style.fontSize = size; scrollTo(0, 0) }", text)
        page.evaluate(NEXT_FRAME)
        overlaps = page.evaluate(OVERLAPS)
        if overlaps:
            found[width, text] = overlaps
        assert page.evaluate("document.documentElement.scrollWidth") <= width, (width, text)
    return found
