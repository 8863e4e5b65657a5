"""A block in metres: the page agrees with the package and explains invalid input."""

import re

import numpy as np
import pytest
from playwright.sync_api import expect

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from tests.api.explorer.reading import BLOCK, pixels, query, settle


@pytest.mark.parametrize(
    ("units", "typed", "metres"),
    [
        ("cm, g, cm/s", ("40", "160", "0.4"), (0.4, 1.6, 0.4 * STANDARD_GRAVITY)),
        ("m, m/s², m/s", ("0.4", "1,6", "4.9"), (0.4, 1.6, 4.9)),
        ("ft, g, in/s", ("1", "3", "0.33"), (0.3048, 0.9144, 0.33 * STANDARD_GRAVITY)),
    ],
)
def test_the_sentence_gives_the_verdict_of_the_package(open_page, units, typed, metres):
    page = open_page()
    page.locator("#pulse").select_option("sine")
    page.locator("#units").select_option(units)
    for name, value in zip(("width", "height", "acceleration"), typed, strict=True):
        page.locator(f"#{name}").fill(value)
    page.locator("#period").fill("0.5")
    page.locator("#period").press("Enter")
    unit = page.locator("#acceleration-unit").inner_text()
    expect(page.locator("#single-title")).to_contain_text(f"0.5 s, {typed[2]} {unit}")
    expect(page.locator("#answer")).to_have_attribute("aria-busy", "false")

    width, height, acceleration = metres
    block = rocking.Block(width, height)
    found = rocking.peak_response(
        "sine",
        slenderness=block.uplift_acceleration / acceleration,
        frequency_ratio=2 * np.pi / 0.5 / block.frequency_parameter,
        restitution=block.momentum_restitution,
        alpha=block.alpha,
    )
    verdict = {0: "It never uplifts.", 1: "It rocks and comes to rest."}.get(int(found.outcome), "It overturns.")
    expect(page.locator(".verdict")).to_have_text(verdict)
    text = page.locator("#answer").inner_text()
    if acceleration > block.uplift_acceleration and not found.overturned:
        said = float(re.search(r"at most ([\d.]+)°", text)[1])
        assert said == pytest.approx(np.degrees(float(found.peak_rotation) * block.alpha), rel=0.006)
    uplift = block.uplift_acceleration / (1.0 if unit == "m/s²" else STANDARD_GRAVITY)
    assert f"{uplift:.3g} {unit}" in text
    expect(page.locator("#stage")).to_be_visible()


def test_samples_are_drawn_on_the_picture_of_the_pulse(open_page):
    page = open_page(BLOCK)
    page.locator("#pulse").select_option("Own samples")
    expect(page.locator("#samples")).to_have_value("0 1 0")
    box = page.locator("#pulse-preview").bounding_box()
    page.mouse.move(box["x"] + 1, box["y"] + 1)  # before the first sample, above the peak
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 1)
    page.mouse.move(box["x"] + box["width"] - 1, box["y"] + box["height"] - 1)
    page.mouse.up()
    page.wait_for_url(lambda url: "pulse=1+1+1" in url)
    drawn = [float(sample) for sample in page.locator("#samples").input_value().split()]
    assert drawn[:9] == [1.0] * 9
    np.testing.assert_allclose(drawn[8:], np.linspace(1.0, -1.0, 9), atol=1e-3)  # of one movement, linear
    expect(page.locator(".verdict")).to_be_visible()
    settle(page)
    found = rocking.Block(0.4, 1.6).response(
        rocking.SampledPulse(drawn), peak_acceleration=0.4 * STANDARD_GRAVITY, period=0.5
    )
    verdict = "It overturns." if found.overturned else "It rocks and comes to rest."
    expect(page.locator(".verdict")).to_have_text(verdict)


def test_the_address_restores_the_block(open_page):
    page = open_page(BLOCK)
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    assert page.locator("#width").input_value() == "0.4"
    settle(page)
    page.locator("#map-marks").press("ArrowDown")  # the same block under a weaker motion
    page.wait_for_url(lambda url: "acceleration=0.4+g" not in url)
    assert query(page)["width"] == "0.4 m"
    assert float(query(page)["acceleration"].split()[0]) < 0.4
    assert float(query(page)["period"].split()[0]) == pytest.approx(0.5, rel=1e-3)
    expect(page.locator("#acceleration")).to_have_value(query(page)["acceleration"].split()[0])


def test_all_errors_are_shown_at_once_in_the_words_of_the_form(open_page):
    page = open_page()
    settle(page)
    for name, value in (("width", ""), ("height", "tall"), ("acceleration", "-1")):
        page.locator(f"#{name}").fill(value)
    page.locator("#acceleration").press("Enter")
    expect(page.locator("#width-problem")).to_have_text("Width of the base is missing.")
    expect(page.locator("#height-problem")).to_have_text("Height is “tall”; allowed: a number.")
    expect(page.locator("#acceleration-problem")).to_have_text("Peak acceleration is -1; allowed: a number above 0.")
    expect(page.locator("#width")).to_have_attribute("aria-invalid", "true")
    for name in ("width", "height", "acceleration"):
        page.locator(f"#{name}").fill("0.5")
    page.locator("#acceleration").press("Enter")
    expect(page.locator(".verdict")).to_be_visible()
    expect(page.locator("#width-problem")).to_be_hidden()


def test_a_size_out_of_range_is_told_as_it_was_typed(open_page):
    page = open_page(BLOCK)
    page.locator("#width").fill("30000")
    page.locator("#width").press("Enter")
    expect(page.locator("#width-problem")).to_have_text("width is 30000; allowed: [0.0001, 10000] [m]")
    expect(page.locator("#answer")).to_be_hidden()


def test_the_motion_is_previewed_with_its_period(open_page):
    page = open_page()
    note = page.locator("#pulse-note")
    expect(note).to_contain_text("It lasts 1 T.")
    for name, duration in (("half_sine", "0.5"), ("ricker", "4")):
        page.locator("#pulse").select_option(name)
        expect(note).to_contain_text(f"It lasts {duration} T.")
    drawn = pixels(page, "#pulse-preview")
    assert (drawn != drawn[0, 0]).any(axis=-1).mean() > 0.01


def test_assumptions_are_stated_and_the_motion_goes_to_rest_in_view(open_page):
    page = open_page(BLOCK, viewport={"width": 1280, "height": 960})
    page.locator("#motion-caption").filter(has_text="comes to rest").wait_for()
    page.locator("#answer summary").click()
    expect(page.locator("#answer details")).to_contain_text("rigid, rectangular and of uniform density")
    end = page.locator("#time").get_attribute("max")
    page.evaluate(
        "t => { const s = document.getElementById('time'); s.value = t; s.dispatchEvent(new Event('input')) }", end
    )
    assert float(page.locator("#stage").get_attribute("data-angle")) == 0.0
    box = page.locator("#stage").bounding_box()
    assert box["y"] + box["height"] <= 960
