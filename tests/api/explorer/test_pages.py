"""The pages of the data sets, of the suites and of the state of the service."""

import hashlib
import io

import numpy as np
import xarray as xr
from playwright.sync_api import expect

from tests.api.conftest import NAMES
from tests.api.explorer.hands import Keyboard
from tests.api.explorer.reading import query


def test_data_sets_are_listed_filtered_and_opened_by_keyboard(open_page, address):
    page = open_page("/datasets?pulse=sine&eta=0.85")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    status, hand = page.locator("#status"), Keyboard(page)
    expect(status).to_contain_text("2 of")
    page.locator("#filter").fill("nothing of this name")
    expect(status).to_contain_text("0 of")
    assert "filter=nothing" in page.url
    page.get_by_role("button", name="Show all").click()
    expect(status).to_contain_text(f"{len(NAMES)} of {len(NAMES)} data sets")
    assert page.evaluate("location.search") == ""
    titles = page.locator("#groups h3").all_inner_texts()
    assert page.locator("#groups tbody tr:visible").count() == 4  # a line for each pulse and suite
    page.get_by_role("button", name="demonstration").click()
    assert page.locator("#groups tbody tr:visible").count() == 4 + 3
    assert titles == ["Rocking spectra", "Boundaries of overturning", "Suites of records"]
    page.locator("#filter").fill("suites")
    expect(status).to_contain_text(f"3 of {len(NAMES)} data sets")
    assert page.locator("#groups h3:visible").all_inner_texts() == titles[2:]
    page.locator("#filter").fill("")
    page.locator("#pulse").select_option(label="One full cosine")
    hand.choose("#eta", "0.9")
    expect(status).to_contain_text(f"1 of {len(NAMES)} data sets")
    expect(page.locator("#groups tr.folder:visible")).to_contain_text("1 file, η 0.9")
    row = page.locator("#groups tbody tr:not(.folder):visible")
    expect(row).to_contain_text("spectra/cosine/eta-0.90")
    expect(row).to_contain_text("ω 0.5 to 12")
    with page.expect_download() as waiting:
        page.get_by_role("button", name="SHA256SUMS").click()
    (line,) = waiting.value.path().read_text().splitlines()
    content = page.request.get("/v1/datasets/spectra/cosine/eta-0.90.nc").body()
    assert line == f"{hashlib.sha256(content).hexdigest()}  spectra/cosine/eta-0.90.nc"
    with page.expect_download() as waiting:
        row.get_by_role("link", name="part").click()
    table = np.loadtxt(io.StringIO(waiting.value.path().read_text()), delimiter=",", skiprows=1, usecols=(1, 2))
    assert table[:, 0].min() > 0.479
    assert table[:, 0].max() < 0.521
    name = "spectra/cosine/eta-0.90"
    hand.press("tr:not([hidden]) td button")
    expect(status).to_have_text(f"Copied the line for {name}.")
    line = page.evaluate("navigator.clipboard.readText()")
    location = f"{address}/v1/datasets/{name}.nc#mode=bytes"
    assert line == f'xarray.open_dataset("{location}", engine="netcdf4")'
    with xr.open_dataset(location, engine="netcdf4") as opened:
        assert opened.sizes["slenderness"] == 91


def test_a_suite_is_reported_for_each_limit_state(open_page):
    page = open_page("/suites")
    report = page.locator("#suite-report")
    expect(page.locator("#status")).to_have_text("4 records, 2 blocks, 12 levels.")
    expect(report).to_contain_text("Block of 50 cm by 2 m")
    expect(report).to_contain_text("Margin of each record")
    expect(report).to_contain_text("neither slides nor leaves the ground")
    assert report.locator("canvas").count() == 2
    found = page.request.get("/v1/suites/demonstration").json()
    at = found["blocks"][1]["sensitivity"][0]
    row = report.locator("tr", has_text=f"{at['friction_demand_largest']:.3g}")
    count = round(4 * at["fraction_low_restitution"])
    expect(row).to_contain_text(f"{count} of 4")
    expect(report).to_contain_text(f"with η = {at['restitution_low']:.3g}")
    curve = found["blocks"][0]["limit_states"][0]["curves"][0]
    expect(report).to_contain_text(f"{curve['median_intensity']:.3g} (")
    page.locator("#demand").select_option("0.5 alpha")
    expect(report).to_contain_text("the block rocks beyond 0.5 α")
    expect(report).not_to_contain_text("Margin of each record")
    assert query(page)["demand"] == "0.5 alpha"
    page.locator("#block").select_option(label="80 cm by 4 m")
    expect(report).not_to_contain_text("Block of 50 cm by 2 m")
    assert report.locator("canvas").count() == 1
    page.reload()
    expect(report).to_contain_text("Block of 80 cm by 4 m")
    expect(report).not_to_contain_text("Block of 50 cm by 2 m")
    page.emulate_media(media="print")
    expect(page.locator("nav")).to_be_hidden()
    expect(page.locator("#choice")).to_be_hidden()
    expect(report).to_be_visible()
    page.route("**/v1/suites?", lambda route: route.fulfill(json={"suites": [], "version": "0"}))
    page.goto("/suites")
    expect(page.locator("#status")).to_contain_text("make reproduce CONFIG=workflow/config/suite.yaml")
    expect(page.locator("#suite")).to_be_hidden()


def test_the_state_is_told_and_numbers_of_labels_are_round_and_on_the_safe_side(open_page):
    """Numbers of axes, and of values at which the outcome changes."""
    page = open_page("/state")
    expect(page.locator("#status")).to_have_text("The service answers.")
    expect(page.locator("#facts")).to_contain_text("Data sets")
    expect(page.locator("#problems")).to_be_hidden()
    ticks = "async () => (await import('/static/explorer/chart.js')).logAxis('PGV').splits(null, 0, 11.7, 145)"
    assert page.evaluate(ticks) == [20, 30, 40, 50, 60, 70, 80, 90, 100]
    values = [4.700067, 13.1270943, 1.1338454, 0.0099999, 999.99951, 1e-7, 5.0]
    found = page.evaluate(
        """values => import("/static/explorer/labels.js").then(({ threshold }) =>
            values.map(value => [threshold(value, true), threshold(value, false)]))""",
        values,
    )
    for value, texts in zip(values, found, strict=True):
        down, up = map(float, texts)
        assert value * 0.98 < down < value < up < value * 1.02
    assert found[0] == ["4.7", "4.71"]
    assert found[2] == ["1.13", "1.14"]
