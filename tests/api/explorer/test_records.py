"""The page of a record: upload, motion, thresholds over the scale, fitted pulse, report, files that cannot be read."""

import json
import re
import shlex
from urllib.parse import unquote

import numpy as np
import pytest
from playwright.sync_api import expect
from typer.testing import CliRunner

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._cli.app import app
from rocking._excitation.records.readers.read_record import parse_record
from tests.api.conftest import NAPA
from tests.api.explorer.hands import HEADER, STRONG, Keyboard, choose_record, short_record
from tests.api.explorer.reading import stated_rotation
from tests.excitation.record_files import at2
from tests.sampling import but_long

BLOCK = rocking.Block(0.5, 2.0)  # that of the form


@pytest.fixture(scope="module")
def content():
    return short_record()


@pytest.fixture(scope="module")
def motion(content):
    return parse_record(content, "short.csv")


def choose_file(page, hand, name, content, field="#file"):
    with page.expect_file_chooser() as waiting:
        hand.press(field)
    waiting.value.set_files({"name": name, "mimeType": "application/octet-stream", "buffer": content})


def test_an_example_and_a_file_give_outcome_motion_thresholds_and_pulse(open_page, content, motion):
    page = open_page("/records")
    hand, caption = Keyboard(page), page.locator("#scales-caption")
    expect(page.locator("#dropped")).to_contain_text("South Napa 2014")
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    expect(caption).to_contain_text("overturns from")

    choose_file(page, hand, "short.csv", content)
    expect(page.locator("#preview-title")).to_contain_text("short.csv: columns.")
    expect(page.locator("#preview-caption")).to_contain_text(f"{motion.samples} samples")
    expect(page.locator("#answer")).to_be_hidden()  # nothing is computed before it is confirmed
    hand.press("#ask")
    expect(page.locator("#answer")).to_have_attribute("data-shown", re.compile("short.csv"))
    expected = BLOCK.response(motion)
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    expect(page.locator("#answer .margin")).to_have_text(f"I{expected.margin[1:]}.")
    assert page.locator("#answer ul li").all_inner_texts()[: len(expected.warnings)] == expected.warnings
    assert expected.thresholds.value[0] > 1.0
    expect(page.locator(".verdict")).to_have_class("verdict survives")
    assert stated_rotation(page) == pytest.approx(np.degrees(expected.rotation), rel=0.006)

    expect(page.locator("#rotation canvas")).to_be_visible()
    page.wait_for_function("() => document.querySelector('#scales .picture').dataset.shown.includes('short.csv')")
    expect(caption).to_contain_text("overturns from")
    first = float(re.search(r"overturns from ([\d.]+)", caption.inner_text())[1])
    exact = float(BLOCK.thresholds(motion).value[0])
    assert first == pytest.approx(exact, rel=1e-3)
    assert first < exact
    expect(page.locator("#pulse-caption")).to_contain_text("of the energy of the velocity")
    expect(page.locator("#pulse-caution")).to_contain_text("does not replace it")

    page.evaluate("window.print = () => { window.printed = !document.getElementById('report').hidden }")
    hand.press("#open-report")
    report = page.locator("#report")
    for heading in ("Block", "Ground motion", "Result", "Margins", "Warnings", "Equations", "Assumptions", "Program"):
        expect(report.get_by_role("heading", name=heading, exact=True)).to_be_visible()
    expect(report).to_contain_text(motion.digest)
    expect(report).to_contain_text(f"overturns from {first}")
    assert report.locator("canvas").count() == 3
    hand.press("#report button.main")
    assert page.evaluate("window.printed")
    report.get_by_role("button", name="Back").click()
    expect(page.locator("#your-block")).to_be_visible()

    hand.slide("#factor", 0.8)
    expect(page.locator(".verdict")).to_have_text("It overturns.")
    factor = float(page.locator("#scale").input_value())
    assert factor == pytest.approx(10**0.6, rel=0.05)
    assert BLOCK.response(motion, scale=factor).overturned
    expect(caption).to_contain_text(f"dashed: the factor {page.locator('#scale').input_value()}")

    page.evaluate(
        """text => {
            const transfer = new DataTransfer();
            transfer.items.add(new File([text], "dropped.csv"));
            document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true }));
        }""",
        content.decode(),
    )
    expect(page.locator("#dropped")).to_contain_text("dropped.csv")
    expect(page.locator("#preview-title")).to_contain_text("dropped.csv")
    assert page.locator("#file").evaluate("field => field.files[0].name") == "dropped.csv"


def test_what_is_asked_about_an_earlier_file_does_not_go_on_with_a_later_one(open_page):
    page, asked = open_page("/records"), []
    page.route("**/v1/records/history**", lambda _: None)  # it has no answer
    page.locator("#file").set_input_files({"name": "first.csv", "mimeType": "text/csv", "buffer": short_record()})
    expect(page.locator("#preview-title")).to_contain_text("first.csv")
    with page.expect_request(lambda request: "/history" in request.url and "first" in request.url):
        page.locator("#ask").click()
    page.on("request", lambda request: asked.append(unquote(request.url)))
    damaged = (HEADER + "0,0.1\n0.01,0.2\n0.02,what\n0.03,0.1\n").encode()
    page.locator("#file").set_input_files({"name": "damaged.csv", "mimeType": "text/csv", "buffer": damaged})
    expect(page.locator("#file-problem")).to_have_text("Line 4: found what; expected a number")
    page.wait_for_timeout(300)
    assert [url for url in asked if "first" in url] == []


def written(value, digits):
    return f"{value:.{digits}f}".replace(".", ",")


def german(motion):
    lines = ["Messung am Domberg", "Zeit (ms);L\u00e4ngs (cm/s2);Quer (cm/s2)"]
    rows = zip(1000.0 * motion.times, 100.0 * motion.acceleration, strict=True)
    lines += [f"{written(time, 1)};{written(value, 4)};{written(value / 2.0, 4)}" for time, value in rows]
    return "\n".join(lines).encode()


def portuguese(motion):
    rows = zip(motion.times, motion.acceleration / STANDARD_GRAVITY, strict=True)
    lines = ["tempo;acelera\u00e7\u00e3o", *(f"{written(time, 3)};{written(value, 6)}" for time, value in rows)]
    return "\r\n".join(lines).encode("cp1252")


def japanese(motion):
    lines = ["\u89b3\u6e2c\u70b9,\u672c\u5e81", "\u5357\u5317,\u6771\u897f,\u4e0a\u4e0b"]
    lines += [f"{value / 3.0:.4f},{value:.4f},{value / 2.0:.4f}" for value in 100.0 * motion.acceleration]
    return "\n".join(lines).encode()


TRIALS = {
    "german.csv": (german, {"skip": "1", "decimal": ",", "acceleration": "L\u00e4ngs (cm/s2)", "time": "Zeit (ms)"}),
    "portuguese.txt": (portuguese, {"decimal": ",", "acceleration": "2", "unit": "g", "time": "1", "time_unit": "s"}),
    "japanese.csv": (japanese, {"skip": "1", "acceleration": "\u6771\u897f", "unit": "gal", "time_step": "0.005"}),
}
"""Files of records whose headers do not state how they are read, and what a person states."""


def state(page, name, value):
    field = page.locator(f"[name={name}][form=record]")
    if field.evaluate("field => field.tagName") == "SELECT":
        field.select_option(value)
        return
    field.fill(value)
    field.press("Tab")


@pytest.mark.parametrize("name", but_long(TRIALS, "japanese.csv"))
def test_a_foreign_file_is_read_as_a_person_states_it(open_page, motion, tmp_path, name):
    make, choices = TRIALS[name]
    content = make(motion)
    (tmp_path / name).write_bytes(content)
    page = open_page("/records")
    page.locator("#file").set_input_files(tmp_path / name)
    expect(page.locator("#preview-title")).to_contain_text(f"{name}: columns.")
    expect(page.locator("#preview-caption")).to_be_empty()
    expect(page.locator("[form=record][aria-invalid=true]").first).to_be_visible()
    page.locator("#ask").click()  # in vain
    expect(page.locator("#answer")).to_be_hidden()
    for field, value in choices.items():
        state(page, field, value)
    expected = BLOCK.response(motion)
    expect(page.locator("#preview-caption")).to_contain_text(f"{motion.samples} samples, 0.005 s apart")
    expect(page.locator("#preview-caption")).to_contain_text(f"{motion.peak_acceleration / STANDARD_GRAVITY:.3g} g")
    expect(page.locator("#answer")).to_be_hidden()
    page.locator("#ask").click()
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    assert stated_rotation(page) == pytest.approx(np.degrees(expected.rotation), rel=0.02)

    command = shlex.split(page.locator("#command").inner_text())
    command = [str(tmp_path / word) if word == name else word for word in command[1:]]
    printed = CliRunner().invoke(app, [*command, "--format=json"])
    expect(page.locator("#answer .margin")).to_have_text(f"I{json.loads(printed.stdout)['margin'][1:]}.")

    page.goto(page.url)
    expect(page.locator("#preview-status")).to_contain_text("choose the file")
    page.locator("#file").set_input_files(tmp_path / name)
    expect(page.locator("#preview-caption")).to_contain_text(f"{motion.samples} samples")
    for field, value in choices.items():
        assert page.locator(f"[name={field}][form=record]").input_value() == value


def test_what_is_unusual_is_a_question(open_page, motion):
    page = open_page("/records?unit=m/s2&time_step=0.005")
    content = "\n".join(f"{value:.5f}" for value in 100.0 * motion.acceleration).encode()
    page.locator("#file").set_input_files({"name": "plain.txt", "mimeType": "text/plain", "buffer": content})
    state(page, "acceleration", "1")
    expect(page.locator("#allow_unusual-problem")).to_contain_text("expected at most 5 g")
    expect(page.locator("#preview-chart canvas")).to_be_visible()
    page.locator("#ask").click()
    expect(page.locator("#allow_unusual")).to_be_focused()
    expect(page.locator("#answer")).to_be_hidden()
    page.locator("#allow_unusual").check()
    expect(page.locator("#allow_unusual-problem")).to_be_empty()
    page.locator("#ask").click()
    expect(page.locator(".verdict")).to_have_text("It overturns.")
    page.locator("#clear").click()
    expect(page.locator("#unit-problem")).to_be_visible()
    assert page.evaluate("location.search") == ""


@pytest.mark.long
def test_a_block_that_a_weaker_record_overturns_is_not_shown_as_surviving(open_page, content, motion):
    page = open_page("/records")
    changes = rocking.Block(0.2, 1.0).thresholds(motion).value
    factor = (changes[1] * changes[2]) ** 0.5
    for name, value in (("width", "0.2"), ("height", "1"), ("scale", f"{factor:.5f}")):
        page.locator(f"#{name}").fill(value)
    choose_record(page, "short.csv", content)
    expect(page.locator(".verdict")).to_have_class("verdict overturns")
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    expect(page.locator("#answer .margin")).to_contain_text("It overturns from")


def components():
    """Two horizontal components and an upward one, which is a third of the second: names, values [g], step [s]."""
    east, north = (rocking.read_record(NAPA.with_name(f"napa_HN{end}.csv")) for end in "EN")
    first, second = (one.acceleration[STRONG] / STANDARD_GRAVITY for one in (east, north))
    return {"NAPA_090": first, "NAPA_000": second, "NAPA_UP": second / 3.0}, east.time_step


@pytest.mark.long
def test_does_it_overturn_with_the_other_components(open_page, tmp_path):
    page = open_page("/records")
    values, step = components()
    files = {
        f"{name}.AT2": at2(
            f"NPTS= {len(one)}, DT= {step:.4f} SEC", body="\n".join(f"{value:.9E}" for value in one)
        ).encode()
        for name, one in values.items()
    }
    hand = Keyboard(page)
    page.locator("#more summary").click()
    fields = {"NAPA_090.AT2": "#file", "NAPA_000.AT2": "#second_file", "NAPA_UP.AT2": "#vertical_file"}
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
        choose_file(page, hand, name, content, fields[name])
    expect(page.locator("#preview-caption")).to_contain_text("Vertical:")
    hand.press("#ask")
    first, second = (
        BLOCK.response(rocking.read_record(tmp_path / f"NAPA_{end}.AT2", vertical=tmp_path / "NAPA_UP.AT2"))
        for end in ("090", "000")
    )
    alone = BLOCK.response(rocking.read_record(tmp_path / "NAPA_090.AT2"))
    assert first.margin != alone.margin
    expect(page.locator("#second-answer")).to_contain_text("Under the second component")
    expect(page.locator("#second-answer")).to_contain_text(f"I{second.margin[1:]}.")
    expect(page.locator("#second-answer")).to_contain_text("of the two.")
    expect(page.locator(".margin")).to_have_text(f"I{first.margin[1:]}.")
    marked = "() => document.getElementById('factor-marks').style.background.includes('gradient')"
    page.wait_for_function(marked)
