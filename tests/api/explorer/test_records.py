"""The page of a record: upload, motion, thresholds over the scale, fitted pulse, report, files that cannot be read."""

import re
from urllib.parse import unquote

import numpy as np
import pytest
from playwright.sync_api import expect

import rocking
from rocking._base.constants import STANDARD_GRAVITY
from rocking._excitation.records.readers.read_record import parse_record
from tests.api.conftest import NAPA
from tests.api.explorer.hands import HEADER, STRONG, Keyboard, choose_record, short_record
from tests.api.explorer.reading import stated_rotation
from tests.excitation.record_files import at2

BLOCK = rocking.Block(0.5, 2.0)  # that of the form


@pytest.fixture(scope="module")
def content():
    return short_record()


@pytest.fixture(scope="module")
def motion(content):
    return parse_record(content, "short.csv")


def choose_files(page, hand, files):
    with page.expect_file_chooser() as waiting:
        hand.press("#file")
    kind = "application/octet-stream"
    waiting.value.set_files([{"name": name, "mimeType": kind, "buffer": content} for name, content in files.items()])


def test_an_example_and_a_file_give_outcome_motion_thresholds_and_pulse(open_page, content, motion):
    page = open_page("/records")
    hand, caption = Keyboard(page), page.locator("#scales-caption")
    expect(page.locator("#dropped")).to_contain_text("South Napa 2014")
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    expect(caption).to_contain_text("overturns from")

    choose_files(page, hand, {"short.csv": content})
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
    page.wait_for_function("() => document.getElementById('answer').dataset.shown.includes('dropped.csv')")
    assert page.locator("#file").evaluate("field => field.files[0].name") == "dropped.csv"


def test_what_is_asked_about_an_earlier_file_does_not_go_on_with_a_later_one(open_page):
    page, asked = open_page("/records"), []
    page.route("**/v1/records/history**", lambda _: None)  # it has no answer
    with page.expect_request(lambda one: "/history" in one.url and "first" in one.url):
        page.locator("#file").set_input_files({"name": "first.csv", "mimeType": "text/csv", "buffer": short_record()})
    page.on("request", lambda one: asked.append(unquote(one.url)))
    damaged = (HEADER + "0,0.1\n0.01,0.2\n0.02,what\n0.03,0.1\n").encode()
    page.locator("#file").set_input_files({"name": "damaged.csv", "mimeType": "text/csv", "buffer": damaged})
    expect(page.locator("#file-problem")).to_contain_text("damaged.csv, line 4: found what; expected a number")
    page.wait_for_timeout(300)
    assert [one for one in asked if "first" in one] == []


@pytest.mark.long
def test_a_bad_file_is_explained_and_what_it_lacks_can_be_stated(open_page, content, motion):
    page = open_page("/records")
    choose_record(page, "plain.txt", "\n".join(map(repr, (motion.acceleration / STANDARD_GRAVITY).tolist())).encode())
    expect(page.locator("#file-problem")).to_contain_text("the field “Unit of the samples”")
    expect(page.locator("#file-problem")).to_contain_text("the field “Time step [s]”")
    expect(page.locator("#answer")).to_be_hidden()
    page.locator("#unit").select_option("g")
    page.locator("#acceleration").fill("1")
    page.locator("#ask").click()
    expect(page.locator("#file-problem")).to_contain_text("the field “Time step [s]”")
    page.locator("#time_step").fill(repr(motion.time_step))
    page.locator("#ask").click()
    expect(page.locator("#answer")).to_have_attribute("data-shown", re.compile("plain.txt"))
    expect(page.locator(".verdict")).to_be_visible()
    expect(page.locator("#file-problem")).to_be_hidden()

    # a block that a weaker record overturns is not shown as surviving
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
    choose_files(page, Keyboard(page), files)
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
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
