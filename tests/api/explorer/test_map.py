"""The map in a browser: outcomes equal the solver; a point can be chosen, moved and magnified."""

import pytest
from playwright.sync_api import expect

import rocking
from tests.api.explorer.reading import BLOCK, MAP, POINT, pixels, place_of, query, settle


def test_the_map_shows_the_outcomes_of_the_solver(open_page):
    page = open_page(MAP)
    settle(page)
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


def test_another_restitution_gives_other_curves(open_page):
    page = open_page(MAP)
    settle(page)
    before = pixels(page, "#map")
    page.locator("#eta").fill("0.9")
    page.wait_for_function(
        "() => JSON.parse(document.getElementById('map').dataset.curves ?? '{}').restitution === 0.9"
    )
    settle(page)
    assert query(page)["restitution"] == "0.9"
    changed = (pixels(page, "#map") != before).any(axis=-1).mean()
    assert 0.005 < changed < 0.9
    page.go_back()
    expect(page.locator("#eta-value")).to_have_text("0.85")


def test_a_click_opens_the_history_of_that_block(open_page):
    page = open_page(MAP)
    settle(page)
    expect(page.locator("#rotation")).to_be_hidden()
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


def test_arrow_keys_move_the_point(open_page):
    page = open_page(POINT)
    settle(page)
    page.locator("#map-marks").focus()
    outline = page.evaluate("getComputedStyle(document.getElementById('map-marks')).outlineStyle")
    page.keyboard.press("ArrowRight")
    assert float(query(page)["frequency_ratio"]) == pytest.approx(4.0 * (12.0 / 0.5) ** 0.01, rel=1e-3)
    page.keyboard.press("Shift+ArrowUp")
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


def test_a_bad_address_is_explained(open_page):
    page = open_page("/?restitution=2")
    expect(page.locator("#eta-problem")).to_contain_text("[0, 1]")
    expect(page.locator("#map-status")).to_contain_text("No answer")


@pytest.mark.parametrize("path", [MAP, BLOCK])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_a_phone_in_light_and_dark(open_page, path, scheme):
    page = open_page(path, viewport={"width": 360, "height": 740}, color_scheme=scheme)
    settle(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    brightness = pixels(page, "#map")[3, 3].mean()  # a corner outside the frame
    assert brightness > 200 if scheme == "light" else brightness < 60


def window(page):
    return {name: float(value) for name, value in query(page).items() if name.endswith(("_min", "_max"))}


def test_the_wheel_zooms_about_the_pointer_and_then_scrolls(open_page):
    page = open_page(MAP)
    settle(page)
    page.locator("#map-marks").hover(position=place_of(page, 4.0, 0.5))
    page.mouse.wheel(0, -300)
    page.wait_for_url(lambda url: "slenderness_max" in url)
    zoomed = window(page)
    assert zoomed["slenderness_max"] - zoomed["slenderness_min"] == pytest.approx(0.52, abs=1e-3)
    share = (0.5 - 0.01) / 1.04  # the point under the pointer stays there
    assert (0.5 - zoomed["slenderness_min"]) / 0.52 == pytest.approx(share, abs=0.01)
    for _ in range(3):
        page.mouse.wheel(0, 300)
        page.wait_for_timeout(50)
    page.wait_for_url(lambda url: "slenderness_max" not in url)
    page.mouse.wheel(0, 200)
    page.wait_for_function("scrollY > 0")


def test_a_drag_pans_and_chooses_no_point(open_page):
    page = open_page(MAP)
    settle(page)
    page.locator("#map-marks").scroll_into_view_if_needed()
    box = page.locator("#map-marks").bounding_box()
    place = place_of(page, 2.0, 0.5)
    x, y = box["x"] + place["x"], box["y"] + place["y"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 40, y, steps=4)
    page.mouse.up()
    page.wait_for_url(lambda url: "frequency_ratio_min" in url)
    ratio = (12.0 / 0.5) ** (-40 / (box["width"] - 116))
    assert window(page)["frequency_ratio_min"] == pytest.approx(0.5 * ratio, rel=1e-3)
    assert "frequency_ratio" not in query(page)
    page.go_back()
    page.wait_for_url(lambda url: "frequency_ratio_min" not in url)


def test_two_fingers_zoom(open_page):
    page = open_page(MAP, has_touch=True)
    settle(page)
    place = place_of(page, 2.0, 0.5)
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
    page.wait_for_url(lambda url: "slenderness_max" in url)
    found = window(page)
    assert found["slenderness_max"] - found["slenderness_min"] == pytest.approx(0.52, abs=2e-3)
