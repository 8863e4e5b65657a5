"""Helpers that read the page: its address, its pixels, the position of a point on the map."""

import base64
import io
import re
from urllib.parse import parse_qs

import numpy as np
from matplotlib.image import imread
from playwright.sync_api import Page

BLOCK = "/?width=0.4+m&height=1.6+m&acceleration=0.4+g&period=0.5+s&restitution=momentum"
MAP = "/?pulse=sine"  # the map of the groups, without a block
POINT = "/?frequency_ratio=4&slenderness=0.7"
SITE = "&pga=0.3&pga_unit=g&pgv=30&pgv_unit=cm/s"
SLAB = "/object?shape=rectangle&width=40&depth=15&height=120&name=slab" + SITE
HEADSTONE = "/object?shape=outline&vertices=0,0%0A30,0%0A30,100%0A10,120%0A0,100" + SITE

COMPLETE = {
    "/": "() => document.querySelector('.headline') && document.querySelectorAll('.downloads a[href]').length >= 7",
    "/objects": "() => document.querySelector('#ranking')",
    "/records": "() => ['#scales canvas', '#pulse-caution:not(:empty)'].every((one) => document.querySelector(one))",
    "/datasets": "() => document.querySelector('#groups h3')",
    "/suites": "() => document.querySelector('#suite-report canvas')",
    "/state": "() => document.querySelector('#facts dl')",
    "/docs": "() => document.querySelector('.opblock')",
}
"""Functions of JavaScript that are true once a page shows its last answer."""


def settle(page: Page):
    """Wait until the map, sharp, and its boundaries are those of what the page shows."""
    page.wait_for_function("""() => {
        const { drawn, curves } = document.getElementById("map").dataset;
        if (!drawn || !curves) return false;
        const [map, lines] = [JSON.parse(drawn), JSON.parse(curves)];
        return map.columns === 400 && map.restitution === lines.restitution && map.pulse === lines.pulse;
    }""")


def set_time(page: Page, time):
    """Move the slider of the animation, also to where it has no step."""
    page.evaluate(
        "t => { const s = document.getElementById('time'); s.step = 'any'; s.value = t; "
        "s.dispatchEvent(new Event('input')) }",
        float(time),
    )


def stated_rotation(page: Page):
    """The largest rotation in the answer [deg]."""
    return float(re.search(r"at most ([\d.]+)°", page.locator("#answer").inner_text())[1])


def is_dimmed(page: Page, box):
    """Whether a part of the page is shown as an answer to another question."""
    return page.evaluate("box => Number(getComputedStyle(document.querySelector(box)).opacity) < 0.5", box)


def query(page: Page):
    """The query of the address as the page has it: `page.url` follows when the browser has reported the change."""
    return {name: values[0] for name, values in parse_qs(page.evaluate("location.search.slice(1)")).items()}


def pixels(page: Page, selector):
    """Red, green, blue of a canvas, 0 to 255, shape (height, width, 3)."""
    url = page.evaluate("selector => document.querySelector(selector).toDataURL()", selector)
    image = imread(io.BytesIO(base64.b64decode(url.partition(",")[2])))
    return np.rint(255 * image[..., :3])


def place_of(page: Page, frequency_ratio, slenderness):
    """Position of a point on the whole map without a block [px]."""
    box = page.locator("#map").bounding_box()
    left, right, top, bottom = 58, 58, 14, 44
    x = np.log(frequency_ratio / 0.5) / np.log(12.0 / 0.5)
    y = (slenderness - 0.01) / (1.05 - 0.01)
    return {"x": left + x * (box["width"] - left - right), "y": top + y * (box["height"] - top - bottom)}
