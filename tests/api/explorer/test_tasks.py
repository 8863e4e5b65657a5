"""What visitors come for, by keyboard alone and by touch on a phone: answers are those of the package.

That a vase is safe, and how much wider its base must be, is in `test_site.py`; thirty objects by keyboard in
`test_objects.py`.
"""

import re

import numpy as np
import pytest
import xarray as xr
from playwright.sync_api import expect

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._excitation.records.readers.read_record import parse_record
from tests.api.explorer.hands import Keyboard, Touch
from tests.api.explorer.reading import BLOCK
from tests.api.explorer.test_records import BLOCK as RECORD_BLOCK
from tests.api.explorer.test_records import NAPA, short_record
from tests.sampling import but_long

pytestmark = pytest.mark.parametrize("by", but_long([Keyboard, Touch], Keyboard))


def components():
    """Two horizontal components and an upward one, which is a third of the second: names, values [g], step [s]."""
    east, north = (rocking.read_record(NAPA.with_name(f"napa_HN{end}.csv")) for end in "EN")
    first, second = (one.acceleration[800:2400] / STANDARD_GRAVITY for one in (east, north))
    return {"NAPA_090": first, "NAPA_000": second, "NAPA_UP": second / 3.0}, east.time_step


def at2(values, step):
    rows = "\n".join(f"{value:.9E}" for value in values)
    head = f"PEER\nSouth Napa\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  {len(values)}, DT= {step:.4f} SEC\n"
    return (head + rows).encode()


def choose_files(page, hand, files):
    with page.expect_file_chooser() as waiting:
        hand.press("#file")
    kind = "application/octet-stream"
    waiting.value.set_files([{"name": name, "mimeType": kind, "buffer": content} for name, content in files.items()])


def test_what_if_the_restitution_is_another(open_page, by):
    page = open_page(BLOCK, **by.options)
    expect(page.locator("#eta-value")).to_have_text(re.compile(r"0\.\d+"))
    hand = by(page)
    hand.choose("#how", "as a number")
    hand.slide("#eta", 0.8)
    expect(page.locator("#eta-value")).to_have_text("0.8")
    found = rocking.Block(0.4, 1.6).response(
        "sine", peak_acceleration=0.4 * STANDARD_GRAVITY, period=0.5, restitution=0.8
    )
    expect(page.locator("#answer")).to_have_attribute("data-shown", re.compile('"restitution":"0.8"'))
    said = float(re.search(r"at most ([\d.]+)°", page.locator("#answer").inner_text())[1])
    assert said == pytest.approx(np.degrees(float(found.rotation)), rel=0.006)


def test_does_my_record_overturn_it_and_at_which_factor(open_page, by):
    page = open_page("/records", reduced_motion="reduce", **by.options)
    content, hand = short_record(), by(page)
    choose_files(page, hand, {"mine.csv": content})
    motion = parse_record(content, "mine.csv")
    expected = RECORD_BLOCK.response(motion)
    expect(page.locator("#answer")).to_have_attribute("data-shown", re.compile("mine.csv"))
    expect(page.locator(".margin")).to_have_text(f"I{expected.margin[1:]}.")
    hand.slide("#factor", 0.8)
    expect(page.locator(".verdict")).to_have_text("It overturns.")
    factor = float(page.locator("#scale").input_value())
    assert factor == pytest.approx(10**0.6, rel=0.05)
    assert RECORD_BLOCK.response(motion, scale=factor).overturned


def test_does_it_overturn_with_the_other_components(open_page, by, tmp_path):
    page = open_page("/records", reduced_motion="reduce", **by.options)
    values, step = components()
    files = {f"{name}.AT2": at2(samples, step) for name, samples in values.items()}
    hand = by(page)
    if by is Keyboard:
        choose_files(page, hand, files)
    else:  # the columns of one file, which are named in the form
        table = np.column_stack([step * np.arange(len(values["NAPA_UP"])), *values.values()])
        rows = "\n".join(",".join(f"{value:.9E}" for value in row) for row in table)
        choose_files(page, hand, {"mine.csv": f"time_s,east (g),north (g),up (g)\n{rows}".encode()})
        expect(page.locator("#file-problem")).to_contain_text("the field “Component”")
        for field, name in {"component": "east", "second": "north", "vertical": "up"}.items():
            hand.write(f"#{field}", name)
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    first, second = (
        RECORD_BLOCK.response(rocking.read_record(tmp_path / f"NAPA_{end}.AT2", vertical=tmp_path / "NAPA_UP.AT2"))
        for end in ("090", "000")
    )
    alone = RECORD_BLOCK.response(rocking.read_record(tmp_path / "NAPA_090.AT2"))
    assert first.margin != alone.margin
    expect(page.locator("#second-answer")).to_contain_text("Under the second component")
    expect(page.locator("#second-answer")).to_contain_text(f"I{second.margin[1:]}.")
    expect(page.locator("#second-answer")).to_contain_text("of the two.")
    expect(page.locator(".margin")).to_have_text(f"I{first.margin[1:]}.")
    marked = "() => document.getElementById('factor-marks').style.background.includes('gradient')"
    page.wait_for_function(marked)


def test_a_triangular_pulse_of_four_tenths_of_a_second(open_page, by):
    page = open_page(BLOCK, **by.options)
    expect(page.locator(".verdict")).to_be_visible()
    hand = by(page)
    hand.choose("#pulse", "Own samples")
    expect(page.locator("#samples")).to_have_value("0 1 0")
    hand.write("#period", "0.4")
    expect(page.locator("#single-title")).to_have_text("Under one pulse: Own samples, 0.4 s, 0.4 g")
    triangle = rocking.SampledPulse([0.0, 1.0, 0.0])
    found = rocking.Block(0.4, 1.6).response(triangle, peak_acceleration=0.4 * STANDARD_GRAVITY, period=0.4)
    said = float(re.search(r"at most ([\d.]+)°", page.locator("#answer").inner_text())[1])
    assert said == pytest.approx(np.degrees(float(found.rotation)), rel=0.006)


def test_the_spectrum_of_a_restitution_goes_into_xarray(open_page, address, by):
    page = open_page("/datasets", **by.options)
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    expect(page.locator("#status")).to_contain_text("data sets")
    hand = by(page)
    hand.choose("#eta", "0.9")
    expect(page.locator("#status")).to_contain_text("1 of")
    hand.press("tr:not([hidden]) td button")
    expect(page.locator("#status")).to_have_text("Copied the line for spectra/cosine/eta-0.90.")
    line = page.evaluate("navigator.clipboard.readText()")
    assert line == f'xarray.open_zarr("{address}/v1/datasets/spectra/cosine/eta-0.90.zarr")'
    with xr.open_zarr(re.search(r'"(.*?)"', line)[1]) as cube:
        assert cube.peak_rotation.sizes["slenderness"] == 91
    hand.press("tbody:not([hidden]) .folder .downloads button")
    expect(page.locator("#status")).to_have_text("Copied the line for spectra/cosine.")
    line = page.evaluate("navigator.clipboard.readText()")
    assert line == f'xarray.open_zarr("{address}/v1/datasets/spectra/cosine.zarr")'
    with xr.open_zarr(re.search(r'"(.*?)"', line)[1]) as cubes:
        assert cubes.restitution.values.tolist() == [0.9]


def test_a_report_is_printed(open_page, by):
    page = open_page(BLOCK, **by.options)
    page.evaluate("window.print = () => { window.printed = !document.getElementById('report').hidden }")
    expect(page.locator("#open-report")).to_be_enabled()
    hand = by(page)
    hand.press("#open-report")
    expect(page.locator("#report h1")).to_be_visible()
    hand.press("#report button.main")
    assert page.evaluate("window.printed")
