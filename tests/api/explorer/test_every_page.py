"""What holds on every page: one navigation, large targets, nothing over anything else at any width and size of text,
no violation of axe-core in light and dark, and an early first picture that stays in place.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import pytest
from playwright.sync_api import Page, expect
from rocking_api.routers.pages import PAGES, menu

from tests.api.explorer import axe
from tests.api.explorer.hands import PHONE, choose_record, short_record
from tests.api.explorer.reading import BLOCK, COMPLETE, HEADSTONE, POINT, SLAB, pixels, settle
from tests.sampling import but_long, number

SIZES = [(390, 100), (390, 200), (1400, 200), (1400, 100)]
SIZES = [*((width, 100) for width in range(320, 1441, number(640, 40))), (768, 200), *SIZES]
"""Widths of the window [px], and sizes of the text [%]."""

# The charts follow the width of the window when the browser draws its next frame, before anything is seen.
NEXT_FRAME = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"

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
    if (document.documentElement.scrollWidth > innerWidth) found.push("the page is wider than the window");
    return found;
}"""

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


class State(NamedTuple):
    """A page, what is done there, its canvases with text, and what is done before it is checked by axe-core again."""

    path: str
    prepare: Callable[[Page], None]
    canvases: set[str] = frozenset()
    then: tuple[Callable[[Page], None], ...] = ()


def completed(page):
    page.wait_for_function(COMPLETE.get(page.evaluate("location.pathname"), "() => true"))


def explored(page):
    settle(page)
    page.locator("#spectrum-chart canvas").wait_for()
    page.locator("#rotation canvas").wait_for()
    if "width" in page.url:
        page.locator("#envelope canvas").wait_for()
    page.wait_for_function("() => document.querySelectorAll('.downloads a[href]').length >= 7")


def uploaded(page):
    expect(page.locator("#pulse-caution")).to_contain_text("does not replace it")  # of the example, the last one
    page.locator("#more summary").click()
    choose_record(page, "short.csv", short_record())
    expect(page.locator("#scales-caption")).to_contain_text("Hatched")


def listed(page):
    page.locator("#table").fill("name;width [cm];height [cm]\nvase;22;55\nslab;5;60\njug;wide;40")
    page.locator("#table").press("Tab")
    expect(page.locator("#preview-caption")).to_have_text("2 rows would be read, 1 not.")
    page.locator("#ask").click()
    expect(page.locator("#bad")).to_be_visible()
    expect(page.locator("#ranking")).to_be_visible()


def other_headers(page):
    content = "Breite (cm);H\u00f6he (cm)\n38,5;60\n".encode()
    page.locator("#file").set_input_files({"name": "de.csv", "mimeType": "text/csv", "buffer": content})
    expect(page.locator("#column-height-problem")).to_be_visible()


def unfolded(page):
    page.locator("details summary").click()


def reported(page):
    page.locator("#open-report").click()
    expect(page.locator("#report")).to_be_visible()


def wrong(page):
    page.locator("#report").get_by_role("button", name="Back").click()
    page.locator("#width").fill("-1")
    page.locator("#width").press("Enter")
    expect(page.locator("#width-problem")).to_be_visible()


def unstated(page):
    content = b"Messung\nZeit;L\xc3\xa4ngs\n0;1\n10;2\n20;1\n"
    page.locator("#file").set_input_files({"name": "de.csv", "mimeType": "text/csv", "buffer": content})
    expect(page.locator("#unit-problem")).to_be_visible()


CHARTS = {"map", "rotation", "spectrum-chart", "stage", "acceleration-chart", "pulse-preview"}
OF_RECORD = {"preview-chart", "rotation", "acceleration-chart", "scales-chart", "pulse-chart", "stage"}
OF_BLOCK = CHARTS | {"map-marks", "envelope"}

STATES = {
    "block": State(BLOCK, explored, OF_BLOCK, (reported, wrong)),
    "point": State(POINT, explored, CHARTS),
    "objects": State("/objects", listed, then=(other_headers,)),
    "slab": State(SLAB, unfolded),
    "headstone": State(HEADSTONE, unfolded),
    "wrong": State(SLAB.replace("width=40", "width=-1"), completed),
    "mesh": State("/object?shape=mesh", completed),
    "records": State("/records", uploaded, OF_RECORD, (unstated,)),
    "suites": State("/suites", completed, {"suite-report"}),
    **{path: State(path, completed) for path in ("/datasets", "/state", "/docs", "/nowhere")},
}


def test_every_page_is_here():
    own = {one.path for one in PAGES} - {"/guide/"}  # which is built apart
    assert own <= {one.path.partition("?")[0] for one in STATES.values()}


@pytest.mark.parametrize("name", but_long(STATES, "block", "objects"))
def test_rules_of_every_page(open_page, name):
    state, found, sizes = STATES[name], {}, {}
    page = open_page("about:blank", failing=name == "/nowhere", width=390, height=900)
    page.add_init_script(f"({RECORD_TEXT})()")
    page.goto(state.path)
    state.prepare(page)
    links = page.locator("nav[aria-label=Pages] a").evaluate_all("all => all.map((one) => one.getAttribute('href'))")
    assert links == [entry.path for entry in menu()]
    for width, percent in SIZES:
        texts = texts_at(page, width, percent)
        assert {name.split()[0] for name in texts} == state.canvases
        sizes[width, percent] = {name: max(one["size"] for one in drawn) for name, drawn in texts.items()}
        faults = [*page.evaluate(OVERLAPS)] if name != "/docs" else []
        faults += page.evaluate(SMALL) if percent == 100 else []
        faults += [fault for drawn in texts.values() for fault in faults_of(drawn)]
        if faults:
            found[width, percent] = faults
    assert found == {}
    if name == "block":
        assert "peak acceleration [g]" in {one["text"] for drawn in texts.values() for one in drawn}
    for width in (390, 1400):
        assert sizes[width, 200] == {name: 2 * size for name, size in sizes[width, 100].items()}
    if name != "/docs":  # by swagger-ui
        assert_accessible(page, state)


def assert_accessible(page, state):
    if not axe.fetch():
        pytest.skip(axe.HOW)
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert axe.violations(page) == []
        if "map" in state.canvases:
            brightness = pixels(page, "#map")[3, 3].mean()  # a corner outside the frame
            assert brightness > 200 if scheme == "light" else brightness < 60
    for change in state.then:
        change(page)
        assert axe.violations(page) == []


def texts_at(page, width, percent):
    """All texts of one drawing of each canvas, by canvas, with sizes and boxes [px]."""
    page.set_viewport_size({"width": width, "height": 900})
    page.evaluate("size => { document.documentElement.style.fontSize = `${size}%`; scrollTo(0, 0) }", percent)
    page.evaluate(NEXT_FRAME)
    page.evaluate("texts.length = 0")
    dark = page.evaluate("matchMedia('(prefers-color-scheme: dark)').matches")
    page.emulate_media(color_scheme="light" if dark else "dark")  # everything is drawn again, once
    page.evaluate(NEXT_FRAME)
    found = {}
    for one in page.evaluate(TEXTS):
        found.setdefault(one["canvas"], []).append(one)
    return found


def faults_of(texts):
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


NETWORK = {"offline": False, "latency": 150, "downloadThroughput": 1.6e6 / 8, "uploadThroughput": 750e3 / 8}
"""Round trip [ms] and bytes per second of a slow mobile connection, as audits of pages take them."""

MAX_SHIFT = 0.1  # [-], share of the window times share of its height by which parts moved
MAX_PAINT = 1500  # [ms]

OBSERVE = """() => {
    window.vitals = { shift: 0, paint: 0, moved: [], largest: "" };
    new PerformanceObserver((list) => {
        for (const one of list.getEntries()) {
            if (one.hadRecentInput) continue;
            vitals.shift += one.value;
            vitals.moved.push(...one.sources.map(({ node }) => node?.id || node?.parentElement?.id || node?.nodeName));
        }
    }).observe({ type: "layout-shift", buffered: true });
    new PerformanceObserver((list) => {
        for (const one of list.getEntries()) [vitals.paint, vitals.largest] = [one.startTime, one.element?.outerHTML];
    }).observe({ type: "largest-contentful-paint", buffered: true });
}"""

SHOWN = COMPLETE | {
    SLAB: "() => document.querySelector('.dial svg')",
    HEADSTONE: "() => document.querySelector('#drawing circle')",
}
del SHOWN["/docs"]  # by swagger-ui

WAITING = {"/": "Computing", "/datasets": "Reading the catalogue", "/suites": "Reading the catalogue"}
"""What pages say a second later that they wait for."""


@pytest.mark.long
@pytest.mark.parametrize("width", [390, 1400])
@pytest.mark.parametrize("path", SHOWN)
def test_a_page_is_seen_early_says_what_it_waits_for_and_stays_in_place(open_page, service, path, width):
    page = open_page("/state", **(PHONE if width == 390 else {"width": width}))  # the data sets are checked
    session = page.context.new_cdp_session(page)
    session.send("Network.enable")
    session.send("Network.setCacheDisabled", {"cacheDisabled": True})
    session.send("Network.emulateNetworkConditions", NETWORK)
    page.add_init_script(f"({OBSERVE})()")
    service.hold()
    page.goto(path)
    if path in WAITING:
        expect(page.locator("[role=status]", has_text=WAITING[path]).first).to_be_visible(timeout=1100)
    elif path in COMPLETE:
        page.wait_for_timeout(1100)  # what it waits for may appear and move others
    service.release()
    page.wait_for_function(SHOWN[path])
    page.wait_for_function("() => vitals.paint > 0")
    found = page.evaluate("vitals")
    assert found["shift"] <= MAX_SHIFT, found["moved"]
    assert found["paint"] <= MAX_PAINT, found["largest"]
