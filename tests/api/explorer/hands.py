"""Two ways to use a page: the keyboard alone, and touch on a phone. Each action waits until its field is there.

And the record that both upload.
"""

import re

import pytest
from playwright.sync_api import expect

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from tests.api.conftest import NAPA

HEADER = "time [s],acceleration [g]\n"

STRONG = slice(800, 1800)
"""Samples of a record that decide what it does to a block: fast to upload, to solve and to fit."""

PHONE = {"has_touch": True, "width": 390, "height": 844}


class Keyboard:
    """Keys alone: a field is reached from where the focus is, by the key Tab."""

    def __init__(self, page):
        self.page = page

    def reach(self, selector):
        self.page.locator(selector).first.wait_for()
        for _ in range(200):
            if self.page.evaluate("selector => document.activeElement.matches(selector)", selector):
                return
            self.page.keyboard.press("Tab")
        pytest.fail(f"{selector} is not reached by the key Tab")

    def press(self, selector):
        self.reach(selector)
        self.page.keyboard.press("Enter")

    def write(self, selector, text):
        self.reach(selector)
        self.page.keyboard.press("ControlOrMeta+A")
        self.page.keyboard.type(text)
        self.page.keyboard.press("Tab")

    def choose(self, selector, label):
        self.reach(selector)
        self.page.keyboard.type(label)
        self.page.keyboard.press("Tab")

    def slide(self, selector, share):
        """To a share of the range, from its start by the keys that move by 10 % and by 1 %."""
        self.reach(selector)
        for key, times in (("Home", 1), ("PageUp", round(100 * share) // 10), ("ArrowRight", round(100 * share) % 10)):
            for _ in range(times):
                self.page.keyboard.press(key)


class Touch:
    """Taps on a phone; text comes from its keyboard, and choices and files from dialogs of its own."""

    def __init__(self, page):
        self.page = page

    def press(self, selector):
        self.page.locator(selector).tap()

    def write(self, selector, text):
        self.press(selector)
        self.page.locator(selector).fill(text)
        self.page.locator(selector).dispatch_event("change")


def short_record():
    """The strong part of a record."""
    motion = rocking.read_record(NAPA)
    part = motion.acceleration[STRONG] / STANDARD_GRAVITY
    rows = (f"{k * motion.time_step:.3f},{value!r}" for k, value in enumerate(part.tolist()))
    return (HEADER + "\n".join(rows)).encode()


def choose_record(page, name, content):
    """Choose a file on the page of records, look at it, confirm it, and wait for its answers."""
    page.locator("#file").set_input_files({"name": name, "mimeType": "text/csv", "buffer": content})
    expect(page.locator("#preview")).to_have_attribute("data-shown", re.compile(re.escape(name)))
    expect(page.locator("#preview-caption")).to_contain_text("Peak ground acceleration")
    page.locator("#ask").click()
    page.wait_for_function(
        """name => ["#answer", "#scales .picture", "#pulse .picture"].map((box) => document.querySelector(box)).every(
            (box) => box.dataset.shown.includes(name) && box.ariaBusy === "false")""",
        arg=name,
    )
