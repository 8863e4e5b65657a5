"""Views belong to the current controls or are dimmed, with a slow and a stopped server."""

import math
import re

import pytest
from playwright.sync_api import expect

from tests.api.explorer.reading import BLOCK, MAP, POINT, query, settle
from tests.sampling import but_long

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


def set_pulse(page, name):
    page.evaluate(
        "name => { const s = document.getElementById('pulse'); s.value = name; s.dispatchEvent(new Event('change')) }",
        name,
    )


def is_dimmed(page, box):
    return page.evaluate("box => Number(getComputedStyle(document.querySelector(box)).opacity) < 0.5", box)


def expect_drawn(page, pulse, timeout=30_000):
    page.wait_for_function(
        """pulse => JSON.parse(document.getElementById("map").dataset.drawn ?? "{}").pulse === pulse
        && document.querySelector(".map").ariaBusy === "false" """,
        arg=pulse,
        timeout=timeout,
    )


@pytest.mark.parametrize("change", but_long(["pulse", "eta"], "eta"))
def test_a_change_dims_the_views_at_once(open_page, service, change):
    page = open_page(POINT)
    settle(page)
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    service.seconds = 1000.0
    field, value, event = ("pulse", "cosine", "change") if change == "pulse" else ("eta", "0.9", "input")
    dimmed = page.evaluate(
        """([field, value, event, views]) => {
            const control = document.getElementById(field);
            control.value = value;
            control.dispatchEvent(new Event(event));
            const boxes = views.map((view) => document.querySelector(view));
            return boxes.map((box) => box.ariaBusy === "true" && Number(getComputedStyle(box).opacity) < 0.5);
        }""",
        [field, value, event, VIEWS],
    )
    assert dimmed == [True, True, True]
    assert page.locator("[data-picture]:enabled").count() == 0  # it cannot be saved under the new label
    service.seconds = 0.0
    for view in VIEWS:
        expect(page.locator(view)).to_have_attribute("aria-busy", "false")
        assert "0.9" in page.locator(view).get_attribute("data-shown") or change == "pulse"


def test_every_frame_shows_the_map_of_the_controls(open_page, service):
    page = open_page(MAP)
    settle(page)
    page.evaluate(WATCH)
    finished = []
    page.on("requestfinished", lambda request: finished.append(request.url) if "/v1/map" in request.url else None)
    service.seconds = 1000.0
    for pulse in ("cosine", "half_sine", "rectangular", "sine", "cosine", "rectangular", "sine", "half_sine"):
        set_pulse(page, pulse)
        page.wait_for_timeout(70)
    service.seconds = 0.0
    expect_drawn(page, "half_sine")
    assert [url for url in finished if "pulse=half_sine" not in url] == []  # the page waits for no earlier request
    service.seconds = 0.5
    page.locator("#eta").fill("0.9")
    page.wait_for_function("() => JSON.parse(document.getElementById('map').dataset.drawn ?? '{}').restitution === 0.9")
    service.seconds = 0.0
    settle(page)
    assert page.evaluate("stale") == []


def test_the_fine_map_follows_the_coarse_one_of_a_slow_server(open_page, service):
    """The two requests for one map do not cancel each other."""
    page = open_page(MAP)
    settle(page)
    service.seconds = 0.7
    requests = []
    page.on("request", lambda request: requests.append(request) if "/v1/map" in request.url else None)
    set_pulse(page, "cosine")
    expect_drawn(page, "cosine")
    service.seconds = 0.0
    settle(page)
    assert [re.search(r"columns=(\d+)", request.url)[1] for request in requests] == ["120", "400"]
    assert [request.failure for request in requests] == [None, None]


def test_the_last_answer_stays_dimmed_if_the_server_hangs(open_page, service):
    page = open_page("about:blank")
    page.clock.install()
    page.goto(POINT)
    settle(page)
    service.seconds = 1000.0
    set_pulse(page, "cosine")
    page.clock.run_for(1500)
    expect(page.locator("#map-status")).to_have_text(
        "Computing the map … Still waiting for the service; dimmed: the last answer …"
    )
    assert all(is_dimmed(page, view) for view in VIEWS)
    assert page.evaluate("document.getElementById('map').width") > 0
    page.clock.fast_forward(76_000)
    expect(page.locator("#map-status")).to_contain_text("has not answered within 75 s")
    service.seconds = 0.0
    page.locator("#map-status button").click()
    expect_drawn(page, "cosine")
    for view in VIEWS:
        expect(page.locator(view)).to_have_attribute("aria-busy", "false")
        assert "cosine" in page.locator(view).get_attribute("data-shown")


def test_a_stopped_server_is_reported_and_requests_can_be_repeated(open_page, service):
    page = open_page(POINT, failing=True)
    settle(page)
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    service.stop()
    set_pulse(page, "cosine")
    for status in ("map-status", "curves-status", "motion-status", "spectrum-status", "readout-status"):
        expect(page.locator(f"#{status}")).to_contain_text("No answer: the service does not answer")
        expect(page.locator(f"#{status} button")).to_have_text("Try again")
    assert all(is_dimmed(page, view) for view in VIEWS)
    service.start()
    page.locator("#map-status button").click()  # repeats all failed requests
    for view in VIEWS:
        expect(page.locator(view)).to_have_attribute("aria-busy", "false")
    settle(page)
    expect_drawn(page, "cosine")
    expect(page.locator(".status button")).to_have_count(0)


def test_a_busy_server_is_retried(open_page, service):
    page = open_page(MAP, failing=True)
    settle(page)
    service.refusals = 2
    set_pulse(page, "cosine")
    expect_drawn(page, "cosine")
    expect(page.locator("#map-status")).to_be_hidden()


def test_the_views_follow_the_sentence_while_it_is_typed(open_page):
    page = open_page(BLOCK)
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    settle(page)
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    before = page.url
    page.locator("#width").press("End")
    page.locator("#width").press("x")
    assert all(is_dimmed(page, box) for box in ("#answer", "#site .picture", *VIEWS))
    expect(page.locator("#block-status")).to_contain_text("cannot be read")
    assert page.url == before
    page.locator("#width").press("Backspace")
    for box in ("#answer", "#site .picture", *VIEWS):
        expect(page.locator(box)).to_have_attribute("aria-busy", "false")
    page.locator("#width").fill("0.1")
    expect(page.locator(".verdict")).to_have_text("It overturns.")
    assert query(page)["width"] == "0.1 m"
    page.locator("#width").press("Enter")
    page.go_back()
    expect(page.locator("#width")).to_have_value("0.4")
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")


def test_a_verdict_appears_only_with_its_block(open_page, service):
    page = open_page(BLOCK)
    settle(page)
    service.seconds = 1000.0
    page.locator("#acceleration").fill("0.6")
    assert all(is_dimmed(page, box) for box in ("#answer", *VIEWS))
    assert page.locator("[data-links] a[href]").count() == 0
    service.seconds = 0.0
    expect(page.locator(".verdict")).to_have_text("It overturns.")
    for view in VIEWS:
        expect(page.locator(view)).to_have_attribute("aria-busy", "false")


def test_the_sliders_are_those_of_the_block(open_page):
    page = open_page(BLOCK)
    expect(page.locator("#alpha-value")).to_have_text("14°")
    page.locator("#alpha").fill("20")
    page.locator("#alpha").dispatch_event("change")
    assert float(query(page)["width"].split()[0]) == pytest.approx(1.6 * math.tan(math.radians(20)), rel=1e-3)
    expect(page.locator("#alpha-value")).to_have_text("20°")
    page.locator("#eta").fill("0.8")
    page.locator("#eta").dispatch_event("change")
    assert query(page)["restitution"] == "0.8"
    assert page.locator("#how").input_value() == "number"
    page.locator("#how").select_option("momentum")
    assert query(page)["restitution"] == "momentum"
    page.locator("#map-marks").press("ArrowUp")  # another motion of the same block
    expect(page.locator(".verdict")).to_be_visible()


def test_a_block_outside_the_rocking_model_says_so_first(open_page):
    page = open_page("/?width=1+m&height=1+m&acceleration=1.5+g&period=0.5+s&restitution=momentum")
    expect(page.locator(".verdict")).to_have_text("The rocking model does not apply.")
    said = page.locator("#answer").inner_text()
    assert "would slide" in said
    assert "5.67 g" not in said
    assert "Warnings" in said
    expect(page.locator("#motion-caption")).to_contain_text(
        "The rocking model does not apply; held in place: It rocks and comes to rest"
    )
    expect(page.locator("#map-readout")).to_contain_text("The rocking model does not apply; held in place")
