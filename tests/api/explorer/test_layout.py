"""No control overlaps another one or lies outside the page, at any width."""

import pytest

from tests.api.explorer.reading import BLOCK, POINT, settle

OVERLAPS = """() => {
    const controls = "input, select, button, a, label, output, #map-marks, #legend span";
    const boxes = [...document.querySelectorAll(controls)]
        .filter((one) => one.checkVisibility())
        .map((one) => ({ one, box: one.getBoundingClientRect() }))
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

# The charts follow the width of the window when the browser draws its next frame, before anything is seen.
NEXT_FRAME = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


@pytest.mark.parametrize("path", [POINT, BLOCK])
def test_no_control_overlaps_another(open_page, path):
    page = open_page(path, viewport={"width": 320, "height": 900})
    settle(page)
    page.locator("#spectrum-chart canvas").wait_for()
    page.wait_for_function("() => document.querySelectorAll('.downloads a[href]').length >= 7")
    found = {}
    for width in range(320, 1441, 40):
        page.set_viewport_size({"width": width, "height": 900})
        page.evaluate("() => scrollTo(0, 0)")
        page.evaluate(NEXT_FRAME)
        found[width] = page.evaluate(OVERLAPS)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert {width: overlaps for width, overlaps in found.items() if overlaps} == {}
