"""Text on canvases has the size that the reader sets, lies within the canvas and never over other text."""

import pytest

from tests.api.explorer.reading import BLOCK, settle
from tests.api.explorer.test_layout import NEXT_FRAME
from tests.api.explorer.test_records import choose, short_record
from tests.sampling import but_long

RECORD_TEXT = """() => {
    window.texts = [];
    const drawText = CanvasRenderingContext2D.prototype.fillText;
    CanvasRenderingContext2D.prototype.fillText = function (text, x, y, ...rest) {
        const around = this.measureText(text);
        const corners = [[-around.actualBoundingBoxLeft, -around.actualBoundingBoxAscent],
                         [around.actualBoundingBoxRight, around.actualBoundingBoxDescent]]
            .map(([dx, dy]) => this.getTransform().transformPoint({ x: x + dx, y: y + dy }));
        const [across, up] = [corners.map((one) => one.x), corners.map((one) => one.y)];
        const box = [Math.min(...across), Math.max(...across), Math.min(...up), Math.max(...up)];
        if (text) texts.push({ text, box, canvas: this.canvas, size: parseFloat(this.font) });
        return drawText.call(this, text, x, y, ...rest);
    };
}"""

TEXTS = """() => {
    const all = [...document.querySelectorAll("canvas")];
    return texts.filter(({ canvas }) => canvas.isConnected).map(({ text, box, canvas, size }) => ({
        text, box, size, canvas: canvas.id || `${canvas.closest("[id]").id} ${all.indexOf(canvas)}`,
        width: canvas.width, height: canvas.height }));
}"""


def texts_at(page, width, percent):
    """All texts of one drawing of each canvas, by canvas, with sizes and boxes [px]."""
    page.set_viewport_size({"width": width, "height": 900})
    page.evaluate("size => { document.documentElement.style.fontSize = `${size}%` }", percent)
    page.evaluate(NEXT_FRAME)
    page.evaluate("texts.length = 0")
    dark = page.evaluate("matchMedia('(prefers-color-scheme: dark)').matches")
    page.emulate_media(color_scheme="light" if dark else "dark")  # everything is drawn again, once
    page.evaluate(NEXT_FRAME)
    found = {}
    for one in page.evaluate(TEXTS):
        found.setdefault(one["canvas"], []).append(one)
    return found


def faults(texts):
    """Texts of a canvas that lie over each other or outside of it."""
    found = []
    for n, one in enumerate(texts):
        left, right, top, bottom = one["box"]
        if min(left, top) < -1 or right > one["width"] + 1 or bottom > one["height"] + 1:
            found.append(f"{one['text']} is outside")
        for other in texts[n + 1 :]:
            low, high, above, below = other["box"]
            if min(right, high) - max(left, low) > 1 and min(bottom, below) - max(top, above) > 1:
                found.append(f"{one['text']} over {other['text']}")
    return found


@pytest.mark.parametrize("path", but_long([BLOCK, "/records", "/suites"], BLOCK))
def test_drawings_follow_the_size_of_the_text(open_page, path):
    page = open_page("about:blank")
    page.add_init_script(f"({RECORD_TEXT})()")
    page.goto(path)
    if path == BLOCK:
        settle(page)
        for place in ("#spectrum-chart", "#envelope", "#rotation"):
            page.locator(f"{place} canvas").wait_for()
        canvases = {"map", "map-marks", "envelope", "rotation", "acceleration-chart", "spectrum-chart", "stage"}
        canvases.add("pulse-preview")
    elif path == "/suites":
        page.locator("#suite-report canvas").first.wait_for()
        canvases = {"suite-report"}
    else:
        choose(page, "short.csv", short_record())
        page.wait_for_function("() => document.getElementById('scales-caption').textContent.includes('Hatched')")
        canvases = {"rotation", "acceleration-chart", "scales-chart", "pulse-chart", "stage"}
    found, sizes = {}, {}
    for width in (390, 1400):
        for percent in (100, 200):
            texts = texts_at(page, width, percent)
            assert {name.split()[0] for name in texts} == canvases
            sizes[width, percent] = {name: max(one["size"] for one in drawn) for name, drawn in texts.items()}
            for name, drawn in texts.items():
                if faults(drawn):
                    found[width, percent, name] = faults(drawn)
        assert sizes[width, 200] == {name: 2 * size for name, size in sizes[width, 100].items()}
    assert found == {}
