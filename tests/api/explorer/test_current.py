"""Views belong to the current controls or are dimmed, with a late, busy, hanging and stopped server."""

import re

import pytest
from playwright.sync_api import expect

from tests.api.explorer.reading import BLOCK, POINT, is_dimmed, query, settle

VIEWS = (".map", ".motion", "#spectrum .picture")

WATCH = """() => {
    window.stale = [];
    const clear = (box) => Number(getComputedStyle(box).opacity) > 0.5;
    const look = () => {
        const drawn = document.getElementById("map").dataset.drawn;
        const pulse = document.getElementById("pulse").value;
        const eta = Number(document.getElementById("eta-value").textContent);
        if (drawn && clear(document.querySelector(".map"))) {
            const shown = JSON.parse(drawn);
            if (shown.pulse !== pulse || Math.abs(shown.restitution - eta) > 0.005) stale.push([pulse, eta, drawn]);
        }
        requestAnimationFrame(look);
    };
    look();
}"""
"""Record in each frame whether an undimmed map differs from the controls."""

CHANGE = """([field, value, event, views]) => {
    const control = document.getElementById(field);
    control.value = value;
    control.dispatchEvent(new Event(event));
    const boxes = views.map((view) => document.querySelector(view));
    return boxes.map((box) => box.ariaBusy === "true" && Number(getComputedStyle(box).opacity) < 0.5);
}"""
"""Change a control, and tell which views are dimmed at once."""


def set_pulse(page, name):
    return page.evaluate(CHANGE, ["pulse", name, "change", VIEWS])


def expect_drawn(page, pulse):
    page.wait_for_function(
        """pulse => JSON.parse(document.getElementById("map").dataset.drawn ?? "{}").pulse === pulse
        && document.querySelector(".map").ariaBusy === "false" """,
        arg=pulse,
    )


def expect_current(page, said=".", views=VIEWS):
    for view in views:
        expect(page.locator(view)).to_have_attribute("aria-busy", "false")
        expect(page.locator(view)).to_have_attribute("data-shown", re.compile(said))


@pytest.mark.long
def test_a_change_dims_the_views_at_once_and_every_frame_shows_the_map_of_the_controls(open_page, service):
    page = open_page(POINT, failing=True)
    settle(page)
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    page.evaluate(WATCH)
    finished = []
    page.on("requestfinished", lambda request: finished.append(request.url) if "/v1/map" in request.url else None)
    service.hold()
    assert page.evaluate(CHANGE, ["eta", "0.9", "input", VIEWS]) == [True, True, True]
    assert page.locator("[data-picture]:enabled").count() == 0  # it cannot be saved under the new label
    for pulse in ("cosine", "rectangular", "sine", "half_sine"):
        set_pulse(page, pulse)
        page.wait_for_timeout(70)
    service.release()
    expect_drawn(page, "half_sine")
    assert [url for url in finished if "pulse=half_sine" not in url] == []  # the page waits for no earlier request
    expect_current(page, "half_sine")
    expect_current(page, "0.9")
    settle(page)  # no request for the fine map of this pulse is counted below

    service.delay = 0.7  # the two requests for one map do not cancel each other
    requests = []
    page.on("request", lambda request: requests.append(request) if "/v1/map" in request.url else None)
    set_pulse(page, "cosine")
    expect_drawn(page, "cosine")
    service.delay = 0.0
    settle(page)
    assert [re.search(r"columns=(\d+)", request.url)[1] for request in requests] == ["120", "400"]
    assert [request.failure for request in requests] == [None, None]

    service.refusals = 2  # asked again after a while
    set_pulse(page, "sine")
    expect_drawn(page, "sine")
    expect(page.locator("#map-status")).to_be_hidden()
    assert page.evaluate("stale") == []


@pytest.mark.long
def test_the_last_answer_stays_dimmed_if_the_server_hangs_or_stops(open_page, service):
    page = open_page("about:blank", failing=True)
    page.clock.install()
    page.goto(POINT)
    settle(page)
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    service.hold()
    set_pulse(page, "ricker")  # the browser keeps the answers for pulses of the test above
    page.clock.run_for(1500)
    expect(page.locator("#map-status")).to_have_text(
        "Computing the map … Still waiting for the service; dimmed: the last answer …"
    )
    assert all(is_dimmed(page, view) for view in VIEWS)
    assert page.evaluate("document.getElementById('map').width") > 0
    page.clock.fast_forward(76_000)
    expect(page.locator("#map-status")).to_contain_text("has not answered within 75 s")
    service.release()
    page.locator("#map-status button").click()
    expect_drawn(page, "ricker")
    expect_current(page, "ricker")

    service.stop()
    set_pulse(page, "c1")
    for status in ("map-status", "curves-status", "motion-status", "spectrum-status", "readout-status"):
        expect(page.locator(f"#{status}")).to_contain_text("No answer: the service does not answer")
        expect(page.locator(f"#{status} button")).to_have_text("Try again")
    assert all(is_dimmed(page, view) for view in VIEWS)
    service.start()
    page.locator("#map-status button").click()  # repeats all failed requests
    expect_current(page, "c1")
    settle(page)
    expect_drawn(page, "c1")
    expect(page.locator(".status button")).to_have_count(0)


def test_the_views_and_the_verdict_follow_the_sentence_while_it_is_typed(open_page, service):
    page = open_page(BLOCK)
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    settle(page)
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    before, boxes = page.url, ("#answer", "#site .picture", *VIEWS)
    page.locator("#width").press("End")
    page.locator("#width").press("x")
    assert all(is_dimmed(page, box) for box in boxes)
    expect(page.locator("#block-status")).to_contain_text("cannot be read")
    assert page.url == before
    page.locator("#width").press("Backspace")
    expect_current(page, views=boxes)
    page.locator("#width").fill("0.1")
    expect(page.locator(".verdict")).to_have_text("It overturns.")
    assert query(page)["width"] == "0.1 m"
    page.locator("#width").press("Enter")
    page.go_back()
    expect(page.locator("#width")).to_have_value("0.4")
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    service.hold()
    page.locator("#acceleration").fill("0.6")
    assert all(is_dimmed(page, box) for box in ("#answer", *VIEWS))
    assert page.locator("[data-links] a[href]").count() == 0
    service.release()
    expect(page.locator(".verdict")).to_have_text("It overturns.")
    expect_current(page)
