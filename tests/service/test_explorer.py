"""The explorer in a real browser: what it draws, says and offers is what the package answers."""

import base64
import io
import os
import re
import socket
import threading
import time
from urllib.parse import parse_qs, urlparse

import numpy as np
import pytest
import uvicorn
import xarray as xr
from matplotlib.image import imread
from playwright.sync_api import Page, expect, sync_playwright

import rocking
from api.app import create_app
from api.settings import Settings
from rocking.block import STANDARD_GRAVITY
from tests.service.chromium import HOW, find

LIMIT = 30_000  # [ms] for any one thing to appear: the machine may be busy
BLOCK = "/?width=0.4+m&height=1.6+m&acceleration=0.4+g&period=0.5+s&restitution=housner"
POINT = "/?frequency_ratio=4&slenderness=0.7"

expect.set_options(timeout=LIMIT)

pytestmark = pytest.mark.skipif(bool(os.environ.get("ROCKING_NO_BROWSER")), reason="ROCKING_NO_BROWSER is set")


@pytest.fixture(scope="module")
def address(results):
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    server = uvicorn.Server(
        uvicorn.Config(create_app(Settings(results=results)), port=port, ws="none", log_level="error")
    )
    thread = threading.Thread(target=server.run)
    thread.start()
    deadline = time.monotonic() + 60
    while not server.started and time.monotonic() < deadline:
        time.sleep(0.02)
    yield f"http://127.0.0.1:{port}"
    server.should_exit = True
    thread.join(timeout=60)


@pytest.fixture(scope="module")
def browser():
    found = find()
    if found is None:
        pytest.fail(HOW)
    with sync_playwright() as playwright:
        environment = {**os.environ, **found.environment}
        browser = playwright.chromium.launch(executable_path=found.path, args=list(found.flags), env=environment)
        yield browser
        browser.close()


@pytest.fixture
def open_page(browser, address):
    """Opens a page of the service; afterwards, nothing may have failed in it or been asked of another host."""
    wrong, contexts = [], []

    def opened(path="/", **options):
        context = browser.new_context(base_url=address, locale="en-GB", **options)
        context.set_default_timeout(LIMIT)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda message: wrong.append(message.text) if _is_fault(message) else None)
        page.on(
            "request",
            lambda request: wrong.append(request.url) if not request.url.startswith(("blob:", address)) else None,
        )
        page.goto(path)
        return page

    yield opened
    for context in contexts:
        context.close()
    assert wrong == []


def _is_fault(message):
    refusal = "status of 422" in message.text  # the browser reports what the page explains
    return message.type in ("error", "warning") and not refusal


def settle(page: Page):
    """Wait until the map, sharp, and its boundaries are those of what the page shows."""
    page.wait_for_function("""() => {
        const { drawn, curves } = document.getElementById("map").dataset;
        if (!drawn || !curves) return false;
        const [map, lines] = [JSON.parse(drawn), JSON.parse(curves)];
        return map.columns === 400 && map.restitution === lines.restitution && map.pulse === lines.pulse;
    }""")


def query(page: Page):
    return {name: values[0] for name, values in parse_qs(urlparse(page.url).query).items()}


def pixels(page: Page, canvas):
    """Red, green, blue of a canvas, 0 to 255, shape (height, width, 3)."""
    url = page.evaluate("id => document.getElementById(id).toDataURL()", canvas)
    image = imread(io.BytesIO(base64.b64decode(url.partition(",")[2])))
    return np.rint(255 * image[..., :3])


def place_of(page: Page, frequency_ratio, slenderness):
    """Where a point stands on the whole map without a block [px], by the frame that the page draws."""
    box = page.locator("#map").bounding_box()
    left, right, top, bottom = 58, 58, 14, 44
    x = np.log(frequency_ratio / 0.5) / np.log(12.0 / 0.5)
    y = (1.05 - slenderness) / (1.05 - 0.01)
    return {"x": left + x * (box["width"] - left - right), "y": top + y * (box["height"] - top - bottom)}


def test_the_map_shows_the_fates_of_the_solver(open_page):
    page = open_page()
    settle(page)
    picture = pixels(page, "map")
    points = [(8.0, 0.6), (3.0, 0.95), (11.0, 0.3), (3.0, 0.5), (1.0, 0.3), (6.0, 0.12)]
    shown = [picture[round(place["y"]), round(place["x"])] for place in (place_of(page, *point) for point in points)]
    found = [rocking.peak_response("sine", frequency_ratio=w, slenderness=s, restitution=0.85) for w, s in points]
    grey = [colour.max() - colour.min() < 20 for colour in shown]
    assert grey == [bool(one.overturned) for one in found]
    assert grey == [False, False, False, True, True, False]
    brought_back = bool(found[-1].exceeded_alpha)
    assert brought_back
    assert shown[-1].tolist() == [236, 112, 74]
    # on viridis the green of a standing block grows with its peak
    standing = sorted((float(one.peak_rotation), colour[1]) for one, colour in zip(found[:3], shown[:3], strict=True))
    assert [green for _, green in standing] == sorted(green for _, green in standing)


def test_another_restitution_gives_other_curves(open_page):
    page = open_page()
    settle(page)
    before = pixels(page, "map")
    page.locator("#eta").fill("0.9")
    page.wait_for_function("() => JSON.parse(document.getElementById('map').dataset.curves).restitution === 0.9")
    settle(page)
    assert query(page)["restitution"] == "0.9"
    changed = (pixels(page, "map") != before).any(axis=-1).mean()
    assert 0.005 < changed < 0.9


def test_a_click_opens_the_history_of_that_block(open_page):
    page = open_page()
    settle(page)
    expect(page.locator("#rotation")).to_be_hidden()
    page.locator("#map-marks").click(position=place_of(page, 6.0, 0.4))
    expect(page.locator("#rotation canvas")).to_be_visible()
    chosen = {name: float(query(page)[name]) for name in ("frequency_ratio", "slenderness")}
    assert chosen["frequency_ratio"] == pytest.approx(6.0, rel=0.01)
    assert chosen["slenderness"] == pytest.approx(0.4, abs=0.005)
    truth = rocking.peak_response("sine", **chosen, restitution=0.85)
    expect(page.locator("#map-readout")).to_contain_text(f"{float(truth.peak_rotation):.4f} α")
    expect(page.locator("#motion-caption")).to_contain_text("It rocks and comes to rest")
    page.go_back()
    expect(page.locator("#rotation")).to_be_hidden()
    page.go_forward()
    expect(page.locator("#rotation canvas")).to_be_visible()


def test_the_block_moves_and_waits(open_page):
    page = open_page(POINT)
    expect(page.locator("#play")).to_have_text("Pause")
    seen = set()
    page.wait_for_function("() => Math.abs(document.getElementById('stage').dataset.angle) > 0.001")
    for _ in range(4):
        seen.add(page.locator("#stage").get_attribute("data-angle"))
        page.wait_for_timeout(150)
    assert len(seen) > 2
    page.locator("#play").click()
    still = page.locator("#stage").get_attribute("data-angle")
    page.wait_for_timeout(300)
    assert page.locator("#stage").get_attribute("data-angle") == still


def test_the_film_shows_the_angles_and_the_ground_of_the_history(open_page):
    page = open_page(POINT + "&alpha_deg=15", reduced_motion="reduce")
    expect(page.locator("#play")).to_have_text("Play")
    motion = rocking.time_history(
        "sine", frequency_ratio=4.0, slenderness=0.7, restitution=0.85, alpha=np.radians(15), samples=800
    )
    page.locator("#motion-caption").filter(has_text="comes to rest").wait_for()
    end = float(page.locator("#time").get_attribute("max"))
    for share in (0.2, 0.35, 0.5, 1.0):
        page.evaluate(
            "t => { const s = document.getElementById('time'); s.value = t; s.dispatchEvent(new Event('input')) }",
            share * end,
        )
        tau = float(page.locator("#time").input_value())
        angle = float(page.locator("#stage").get_attribute("data-angle"))
        assert angle == pytest.approx(np.radians(15) * np.interp(tau, motion.tau, motion.rotation), abs=2e-5)
    # a full sine leaves the ground 2 pi a_g/omega_g^2 away: (4/3) tan(alpha) a 2 pi/omega^2 half diagonals
    way = 4 / 3 * np.tan(np.radians(15)) / 0.7 * 2 * np.pi / 4.0**2
    assert float(page.locator("#stage").get_attribute("data-ground")) == pytest.approx(way, rel=1e-3)


@pytest.mark.parametrize(
    ("typed", "metres"),
    [
        (
            {"width": ("0.4", "m"), "height": ("1.6", "m"), "acceleration": ("0.4", "g")},
            (0.2, 0.8, 0.4 * STANDARD_GRAVITY),
        ),
        ({"width": ("40", "cm"), "height": ("1,6", "m"), "acceleration": ("4.9", "m/s2")}, (0.2, 0.8, 4.9)),
        ({"width": ("1", "ft"), "height": ("3", "ft"), "acceleration": ("320", "cm/s2")}, (0.1524, 0.4572, 3.2)),
    ],
)
def test_the_form_gives_the_verdict_of_the_package(open_page, typed, metres):
    page = open_page()
    for name, (value, unit) in typed.items():
        page.locator(f"#{name}").fill(value)
        page.locator(f"select[name={name}_unit]").select_option(unit)
    page.locator("#period").fill("0.5")
    page.locator("#period").press("Enter")
    expect(page.locator(".verdict")).to_be_visible()

    half_width, half_height, acceleration = metres
    block = rocking.Block(half_width=half_width, half_height=half_height)
    found = rocking.peak_response(
        "sine",
        slenderness=block.uplift_acceleration / acceleration,
        frequency_ratio=2 * np.pi / 0.5 / block.frequency_parameter,
        restitution=block.housner_restitution,
        alpha=block.alpha,
    )
    expect(page.locator(".verdict")).to_have_text("It falls." if found.overturned else "It stands.")
    text = page.locator("#answer").inner_text()
    if acceleration <= block.uplift_acceleration:
        assert "too weak to lift it" in text
    elif not found.overturned:
        said = float(re.search(r"at most ([\d.]+)°", text)[1])
        assert said == pytest.approx(np.degrees(float(found.peak_rotation) * block.alpha), rel=0.006)
    assert f"{block.uplift_acceleration / STANDARD_GRAVITY:.3g} g" in text
    expect(page.locator("#stage")).to_be_visible()


def test_the_three_blocks_have_three_fates():
    block, other = rocking.Block(half_width=0.2, half_height=0.8), rocking.Block(half_width=0.1524, half_height=0.4572)
    amplitudes = (
        rocking.critical_amplitude(
            "sine",
            frequency_ratio=2 * np.pi / 0.5 / block.frequency_parameter,
            restitution=block.housner_restitution,
            alpha=block.alpha,
        ).amplitude
        * block.uplift_acceleration
    )
    assert 0.4 * STANDARD_GRAVITY < amplitudes[0] < 4.9 < amplitudes[1]
    assert other.uplift_acceleration > 3.2


def test_the_address_brings_back_the_block(open_page):
    page = open_page(BLOCK)
    expect(page.locator(".verdict")).to_have_text("It stands.")
    assert page.locator("#width").input_value() == "0.4"
    settle(page)
    page.locator("#map-marks").press("ArrowUp")  # the same block under a weaker motion
    page.wait_for_url(lambda url: "acceleration=0.4+g" not in url)
    assert query(page)["width"] == "0.4 m"
    assert float(query(page)["acceleration"].split()[0]) < 0.4
    assert float(query(page)["period"].split()[0]) == pytest.approx(0.5, rel=1e-3)
    expect(page.locator("#acceleration")).to_have_value(query(page)["acceleration"].split()[0])


def test_arrow_keys_move_the_point(open_page):
    page = open_page(POINT)
    settle(page)
    page.locator("#map-marks").focus()
    outline = page.evaluate("getComputedStyle(document.getElementById('map-marks')).outlineStyle")
    page.keyboard.press("ArrowRight")
    assert float(query(page)["frequency_ratio"]) == pytest.approx(4.0 * (12.0 / 0.5) ** 0.01, rel=1e-3)
    page.keyboard.press("Shift+ArrowDown")
    assert float(query(page)["slenderness"]) == pytest.approx(0.7 - 0.1 * 1.04, abs=1e-3)
    assert outline == "solid"


def test_zoom_shows_a_part(open_page):
    page = open_page(POINT)
    settle(page)
    page.locator("#zoom-in").click()
    page.wait_for_url(lambda url: "slenderness_max" in url)
    assert float(query(page)["slenderness_max"]) - float(query(page)["slenderness_min"]) == pytest.approx(
        0.52, abs=1e-3
    )
    page.locator("#whole").click()
    page.wait_for_url(lambda url: "slenderness_max" not in url)


def test_downloads_arrive(open_page):
    page = open_page(POINT)
    settle(page)
    expect(page.locator("#rotation canvas")).to_be_visible()
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    page.wait_for_function("() => document.querySelectorAll('.downloads a[href]').length >= 7")

    def arrived(locator):
        with page.expect_download() as waiting:
            locator.click()
        return waiting.value.suggested_filename, waiting.value.path().read_bytes()

    name, content = arrived(page.locator("[data-links=motion] a[data-form=nc]"))
    truth = rocking.time_history("sine", frequency_ratio=4.0, slenderness=0.7, restitution=0.85, samples=800)
    np.testing.assert_array_equal(xr.load_dataset(io.BytesIO(content), engine="scipy").rotation, truth.rotation)
    assert name == "history.nc"
    for part in ("map", "spectrum"):
        name, content = arrived(page.locator(f"[data-links={part}] a[data-form=csv]"))
        assert (name, content.decode().splitlines()[0].count("frequency_ratio")) == (f"{part}.csv", 1)
    for part in ("map", "motion", "spectrum"):
        name, content = arrived(page.locator(f"[data-picture={part}]"))
        assert (name, content[:8]) == (f"{part}.png", b"\x89PNG\r\n\x1a\n")
        assert len(content) > 8000


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("width", "-1", "allowed"),
        ("height", "high", "a number"),
        ("acceleration", "", "missing"),
        ("period", "1e9", "allowed"),
    ],
)
def test_bad_input_is_explained_beside_its_field(open_page, field, value, words):
    page = open_page()
    page.locator(f"#{field}").fill(value)
    page.locator("#ask").click()
    expect(page.locator(f"#{field}-problem")).to_contain_text(words)
    expect(page.locator(f"#{field}")).to_have_attribute("aria-invalid", "true")
    expect(page.locator("#answer")).to_be_hidden()
    settle(page)  # the map stays
    page.locator(f"#{field}").fill("0.5")
    page.locator("#ask").click()
    expect(page.locator(".verdict")).to_be_visible()
    expect(page.locator(f"#{field}-problem")).to_be_hidden()


def test_a_bad_address_is_explained(open_page):
    page = open_page("/?restitution=2")
    expect(page.locator("#eta-problem")).to_contain_text("[0, 1]")
    expect(page.locator("#map-status")).to_contain_text("No answer")


@pytest.mark.parametrize("path", ["/", BLOCK])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_a_phone_in_light_and_dark(open_page, path, scheme):
    page = open_page(path, viewport={"width": 360, "height": 740}, color_scheme=scheme)
    settle(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    brightness = pixels(page, "map")[3, 3].mean()  # a corner outside the frame
    assert brightness > 200 if scheme == "light" else brightness < 60
