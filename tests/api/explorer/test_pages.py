"""The pages of the data sets and of the state of the service."""

import io

import numpy as np
import pytest
from playwright.sync_api import expect


def test_data_sets_are_listed_and_filtered(open_page):
    page = open_page("/datasets")
    status = page.locator("#status")
    expect(status).to_have_text("3 of 3 data sets")
    page.locator("#filter").fill("cosine")
    expect(status).to_have_text("1 of 3 data sets")
    row = page.locator("#rows tr:visible")
    expect(row).to_contain_text("spectra/cosine/eta-0.90")
    expect(row).to_contain_text("ω 0.5 to 12")
    with page.expect_download() as waiting:
        row.get_by_role("link", name="part").click()
    table = np.loadtxt(io.StringIO(waiting.value.path().read_text()), delimiter=",", skiprows=1, usecols=(1, 2))
    assert table[:, 0].min() > 0.479
    assert table[:, 0].max() < 0.521


def test_the_state_is_told(open_page):
    page = open_page("/state")
    expect(page.locator("#status")).to_have_text("The service answers.")
    expect(page.locator("#facts")).to_contain_text("Data sets")
    expect(page.locator("#problems")).to_be_hidden()


@pytest.mark.parametrize("path", ["/datasets", "/state", "/records"])
def test_they_fit_a_phone(open_page, path):
    page = open_page(path, viewport={"width": 320, "height": 640})
    expect(page.locator("h1")).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= 320
