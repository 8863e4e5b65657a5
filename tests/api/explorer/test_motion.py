"""The animation agrees with the time history of the package; downloads work."""

import io
from urllib.parse import parse_qs

import numpy as np
import pytest
import xarray as xr
from playwright.sync_api import expect

import rocking
from tests.api.explorer.reading import POINT, settle


def test_the_animation_plays_and_pauses(open_page):
    page = open_page(POINT, reduced_motion="no-preference")
    page.locator("#speed").select_option("0.1")  # it ends and pauses by itself
    expect(page.locator("#play")).to_have_text("Pause")
    page.wait_for_function("() => Math.abs(document.getElementById('stage').dataset.angle) > 0.001")
    for _ in range(3):
        before = page.locator("#stage").get_attribute("data-angle")
        page.wait_for_function("before => document.getElementById('stage').dataset.angle !== before", arg=before)
    page.locator("#play").click()
    still = page.locator("#stage").get_attribute("data-angle")
    page.wait_for_timeout(300)
    assert page.locator("#stage").get_attribute("data-angle") == still


def test_the_animation_shows_the_angles_and_the_ground_of_the_history(open_page):
    page = open_page(POINT + "&alpha_deg=15")
    expect(page.locator("#play")).to_have_text("Play")
    page.locator("#motion-caption").filter(has_text="comes to rest").wait_for()
    end = float(page.locator("#time").get_attribute("max"))
    block = {"frequency_ratio": 4.0, "slenderness": 0.7, "restitution": 0.85, "alpha": np.radians(15)}
    motion = rocking.time_history("sine", **block, duration=end, samples=800)
    assert motion.rotation[-1] == 0.0
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


def test_downloads_have_content(open_page):
    page = open_page(POINT)
    settle(page)
    expect(page.locator("#rotation canvas")).to_be_visible()
    expect(page.locator("#spectrum-chart canvas")).to_be_visible()
    page.wait_for_function("() => document.querySelectorAll('.downloads a[href]').length >= 7")

    def arrived(locator):
        with page.expect_download() as waiting:
            locator.click()
        return waiting.value.suggested_filename, waiting.value.path().read_bytes()

    link = page.locator("[data-links=motion] a[data-form=nc]")
    name, content = arrived(link)
    duration = float(parse_qs(link.get_attribute("href"))["duration"][0])
    truth = rocking.time_history(
        "sine", frequency_ratio=4.0, slenderness=0.7, restitution=0.85, samples=800, duration=duration
    )
    rotation = xr.load_dataset(io.BytesIO(content), engine="scipy").rotation
    np.testing.assert_array_equal(rotation, truth.rotation)
    assert rotation[-1] == 0.0  # as on the page, until the block is at rest
    assert name == "history.nc"
    for part in ("map", "spectrum"):
        name, content = arrived(page.locator(f"[data-links={part}] a[data-form=csv]"))
        assert (name, content.decode().splitlines()[0].count("frequency_ratio")) == (f"{part}.csv", 1)
    for part in ("map", "motion", "spectrum"):
        name, content = arrived(page.locator(f"[data-picture={part}]"))
        assert (name, content[:8]) == (f"{part}.png", b"\x89PNG\r\n\x1a\n")
        assert len(content) > 8000
