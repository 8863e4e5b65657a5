"""The chart of the spectrum and the captions of the charts say what is drawn."""

import numpy as np
from playwright.sync_api import expect

import rocking
from tests.api.explorer.reading import BLOCK, POINT, pixels, settle


def blank_share(image, left, right):
    """Share of pixels without colour above the curves, between two shares of the width."""
    height, width, _ = image.shape
    part = image[int(0.1 * height) : int(0.3 * height), int(left * width) : int(right * width)]
    return np.mean((part == 0.0).all(axis=-1))


def test_only_frequency_ratios_at_which_the_block_overturns_are_hatched(open_page):
    page = open_page(POINT, viewport={"width": 1000, "height": 900})
    settle(page)
    page.locator("#spectrum-chart canvas").wait_for()
    found = rocking.peak_response("sine", slenderness=0.7, frequency_ratio=[0.7, 8.0], restitution=0.85)
    assert found.overturned.tolist() == [True, False]
    image = pixels(page, "#spectrum-chart canvas")
    assert blank_share(image, 0.12, 0.25) < 0.3
    assert blank_share(image, 0.75, 0.9) > 0.9  # all but the lines of the grid


def test_captions_name_the_lines_that_are_drawn(open_page):
    page = open_page(BLOCK)
    caption = page.locator("#charts-caption")
    expect(caption).to_contain_text("Dashed: the acceleration that lifts it off.")  # it reaches half of alpha
    expect(page.locator("#motion-caption")).not_to_contain_text("ends before")
    expect(page.locator("#map-readout")).to_contain_text("1 impact during the pulse")
    page = open_page("/?frequency_ratio=4&slenderness=0.3")
    expect(page.locator("#charts-caption")).to_contain_text("Dashed: α, past which its weight turns it over, and the")
