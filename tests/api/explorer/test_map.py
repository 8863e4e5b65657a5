"""The map, the spectrum and the motion of a chosen point: outcomes are those of the solver; a point can be chosen,
moved and magnified; downloads have their content.
"""

import io
from urllib.parse import parse_qs

import numpy as np
import pytest
import xarray as xr
from playwright.sync_api import expect

import rocking
from tests.api.explorer.reading import BLOCK, MAP, POINT, pixels, place_of, query, set_time, settle


def test_the_map_shows_the_outcomes_of_the_solver_and_a_click_the_history(open_page):
    page = open_page(MAP)
    settle(page)
    expect(page.locator("#rotation")).to_be_hidden()
    picture = pixels(page, "#map")
    points = [(8.0, 0.6), (3.0, 0.95), (11.0, 0.3), (3.0, 0.5), (1.0, 0.3), (6.0, 0.12)]
    shown = [picture[round(place["y"]), round(place["x"])] for place in (place_of(page, *point) for point in points)]
    found = [rocking.peak_response("sine", frequency_ratio=w, slenderness=s, restitution=0.85) for w, s in points]
    grey = [colour.max() - colour.min() < 20 for colour in shown]
    assert grey == [bool(one.overturned) for one in found]
    assert grey == [False, False, False, True, True, False]
    brought_back = bool(found[-1].exceeded_alpha)
    assert brought_back
    assert shown[-1].tolist() == [236, 112, 74]
    # on viridis, reversed, green decreases with the peak of a block that survives
    standing = sorted((float(one.peak_rotation), colour[1]) for one, colour in zip(found[:3], shown[:3], strict=True))
    assert [green for _, green in standing] == sorted((green for _, green in standing), reverse=True)

    page.locator("#eta").fill("0.9")
    page.wait_for_function(
        "() => JSON.parse(document.getElementById('map').dataset.curves ?? '{}').restitution === 0.9"
    )
    settle(page)
    assert query(page)["restitution"] == "0.9"
    changed = (pixels(page, "#map") != picture).any(axis=-1).mean()
    assert 0.005 < changed < 0.9
    page.go_back()
    expect(page.locator("#eta-value")).to_have_text("0.85")

    page.locator("#map-marks").click(position=place_of(page, 6.0, 0.4))
    expect(page.locator("#rotation canvas")).to_be_visible()
    chosen = {name: float(query(page)[name]) for name in ("frequency_ratio", "slenderness")}
    assert chosen["frequency_ratio"] == pytest.approx(6.0, rel=0.01)
    assert chosen["slenderness"] == pytest.approx(0.4, abs=0.005)
    expected = rocking.peak_response("sine", **chosen, restitution=0.85)
    expect(page.locator("#map-readout")).to_contain_text(f"{float(expected.peak_rotation):.4f} α")
    expect(page.locator("#motion-caption")).to_contain_text("It rocks and comes to rest")
    page.go_back()
    expect(page.locator("#rotation")).to_be_hidden()
    page.go_forward()
    expect(page.locator("#rotation canvas")).to_be_visible()

    page.keyboard.press("Tab")  # an outline is shown to those who use keys
    page.locator("#map-marks").focus()
    assert page.evaluate("getComputedStyle(document.getElementById('map-marks')).outlineStyle") == "solid"
    page.keyboard.press("ArrowRight")
    right = chosen["frequency_ratio"] * (12.0 / 0.5) ** 0.01
    assert float(query(page)["frequency_ratio"]) == pytest.approx(right, rel=1e-3)
    page.keyboard.press("Shift+ArrowUp")
    assert float(query(page)["slenderness"]) == pytest.approx(chosen["slenderness"] - 0.1 * 1.04, abs=1e-3)


def window(page):
    return {name: float(value) for name, value in query(page).items() if name.endswith(("_min", "_max"))}


def expect_half(page):
    """Wait until half the range of the slenderness is shown; returns the window."""
    page.wait_for_url(lambda url: "slenderness_max" in url)
    found = window(page)
    assert found["slenderness_max"] - found["slenderness_min"] == pytest.approx(0.52, abs=2e-3)
    return found


def expect_whole(page):
    page.wait_for_url(lambda url: "slenderness_max" not in url and "frequency_ratio_min" not in url)


def test_buttons_wheel_and_fingers_zoom_and_a_drag_pans(open_page):
    page = open_page(MAP, has_touch=True)
    settle(page)
    page.locator("#zoom-in").click()
    expect_half(page)
    page.locator("#whole").click()
    expect_whole(page)

    page.locator("#map-marks").scroll_into_view_if_needed()
    box, place = page.locator("#map-marks").bounding_box(), place_of(page, 2.0, 0.5)
    x, y = box["x"] + place["x"], box["y"] + place["y"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 40, y, steps=4)
    page.mouse.up()
    page.wait_for_url(lambda url: "frequency_ratio_min" in url)
    ratio = (12.0 / 0.5) ** (-40 / (box["width"] - 116))
    assert window(page)["frequency_ratio_min"] == pytest.approx(0.5 * ratio, rel=1e-3)
    assert "frequency_ratio" not in query(page)  # no point is chosen
    page.go_back()
    expect_whole(page)

    page.evaluate(
        """([x, y]) => {
            const over = document.getElementById("map-marks");
            over.setPointerCapture = () => {};
            const box = over.getBoundingClientRect();
            const send = (type, pointerId, dx) => over.dispatchEvent(new PointerEvent(type, {
                pointerId, clientX: box.left + x + dx, clientY: box.top + y, bubbles: true, pointerType: "touch" }));
            send("pointerdown", 1, -30);
            send("pointerdown", 2, 30);
            send("pointermove", 2, 90);
            send("pointerup", 1, -30);
            send("pointerup", 2, 90);
        }""",
        [place["x"], place["y"]],
    )
    expect_half(page)
    page.locator("#whole").click()
    expect_whole(page)

    page.locator("#map-marks").hover(position=place_of(page, 4.0, 0.5))
    page.mouse.wheel(0, -300)
    share = (0.5 - 0.01) / 1.04  # the point under the pointer stays there
    assert (0.5 - expect_half(page)["slenderness_min"]) / 0.52 == pytest.approx(share, abs=0.01)
    for _ in range(3):
        page.mouse.wheel(0, 300)
        page.wait_for_timeout(50)
    expect_whole(page)
    page.mouse.wheel(0, 200)  # what it cannot zoom it scrolls
    page.wait_for_function("scrollY > 0")


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
    for back, state in ((undo.click, 2), (lambda: page.locator("#map-marks").press("ControlOrMeta+z"), 1)):
        back()
        page.wait_for_function("before => location.search === before", arg=states[state])
    page.reload()  # the history of the browser is still there
    undo.click()
    expect(undo).to_be_disabled()
    assert query(page)["acceleration"] == "0.4 g"
    page.go_forward()
    expect(undo).to_be_enabled()


ACCENT = (11, 107, 120)
"""Colour of the curves on a light page: red, green, blue."""


def blank_share(image, left, right):
    """Share of pixels without colour above the curves, between two shares of the width."""
    height, width, _ = image.shape
    part = image[int(0.1 * height) : int(0.3 * height), int(left * width) : int(right * width)]
    return np.mean((part == 0.0).all(axis=-1))


def test_spectrum_and_motion_of_a_point_are_those_of_the_solver_and_can_be_saved(open_page):
    page = open_page(POINT + "&alpha_deg=15", width=1000, height=900)
    expect(page.locator("#play")).to_have_text("Play")
    page.locator("#motion-caption").filter(has_text="comes to rest").wait_for()
    settle(page)
    point = {"frequency_ratio": 4.0, "slenderness": 0.7, "restitution": 0.85, "alpha": np.radians(15)}
    page.locator("#spectrum-chart canvas").wait_for()
    found = rocking.peak_response("sine", **point | {"frequency_ratio": [0.7, 8.0]})
    assert found.overturned.tolist() == [True, False]
    image = pixels(page, "#spectrum-chart canvas")
    assert (image == ACCENT).all(axis=-1).any()
    assert blank_share(image, 0.12, 0.25) < 0.3  # hatched
    assert blank_share(image, 0.75, 0.9) > 0.9  # all but the lines of the grid

    page.wait_for_function("() => document.querySelectorAll('.downloads a[href]').length >= 7")

    def arrived(locator):
        with page.expect_download() as waiting:
            locator.click()
        return waiting.value.suggested_filename, waiting.value.path().read_bytes()

    link = page.locator("[data-links=motion] a[data-form=nc]")
    name, content = arrived(link)
    duration = float(parse_qs(link.get_attribute("href"))["duration"][0])
    motion = rocking.time_history("sine", **point, samples=800, duration=duration)
    rotation = xr.load_dataset(io.BytesIO(content), engine="scipy").rotation
    np.testing.assert_array_equal(rotation, motion.rotation)
    assert rotation[-1] == 0.0  # as on the page, until the block is at rest
    assert name == "history.nc"
    for part in ("map", "spectrum"):
        name, content = arrived(page.locator(f"[data-links={part}] a[data-form=csv]"))
        assert (name, content.decode().splitlines()[0].count("frequency_ratio")) == (f"{part}.csv", 1)
    for part in ("map", "motion", "spectrum"):
        name, content = arrived(page.locator(f"[data-picture={part}]"))
        assert (name, content[:8]) == (f"{part}.png", b"\x89PNG\r\n\x1a\n")
        assert len(content) > 8000

    end = float(page.locator("#time").get_attribute("max"))
    assert end == pytest.approx(duration)
    for share in (0.2, 0.35, 0.5, 1.0):
        set_time(page, share * end)
        tau = float(page.locator("#time").input_value())
        angle = float(page.locator("#stage").get_attribute("data-angle"))
        assert angle == pytest.approx(np.radians(15) * np.interp(tau, motion.tau, motion.rotation), abs=2e-5)
    # a full sine leaves the ground 2 pi a_g/omega_g^2 away: (4/3) tan(alpha) a 2 pi/omega^2 half diagonals
    way = 4 / 3 * np.tan(np.radians(15)) / 0.7 * 2 * np.pi / 4.0**2
    assert float(page.locator("#stage").get_attribute("data-ground")) == pytest.approx(way, rel=1e-3)
    page.goto("/?frequency_ratio=4&slenderness=0.3")
    expect(page.locator("#charts-caption")).to_contain_text("Dashed: α, past which its weight turns it over, and the")
