"""The page of a record: upload, motion, thresholds over the scale, fitted pulse, report, files that cannot be read."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

import rocking
from rocking._excitation.records.readers.read_record import parse_record

NAPA = Path(__file__).parents[3] / "workflow/motions/napa_HNE.csv"
BLOCK = rocking.Block(0.5, 2.0)  # that of the form
HEADER = "time_s,acceleration_g\n"


def short_record():
    """The strong part of a record: fast to upload, to solve and to fit."""
    motion = rocking.read_record(NAPA)
    part = motion.acceleration[800:2400] / 9.80665
    rows = (f"{k * motion.time_step:.3f},{value!r}" for k, value in enumerate(part.tolist()))
    return (HEADER + "\n".join(rows)).encode()


def choose(page, name, content):
    page.locator("#file").set_input_files({"name": name, "mimeType": "text/csv", "buffer": content})
    page.wait_for_function(
        """name => document.getElementById("file-problem").textContent ||
        ["#answer", "#scales .picture", "#pulse .picture"].map((box) => document.querySelector(box)).every(
            (box) => box.dataset.shown.includes(name) && box.ariaBusy === "false")""",
        arg=name,
    )


@pytest.fixture(scope="module")
def content():
    return short_record()


@pytest.fixture(scope="module")
def motion(content):
    return parse_record(content, "short.csv")


def test_a_file_gives_outcome_motion_thresholds_and_pulse(open_page, content, motion):
    page = open_page("/records")
    choose(page, "short.csv", content)
    expected = BLOCK.response(motion)
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    assert page.locator("#answer .margin").inner_text() == f"I{expected.margin[1:]}."
    assert page.locator("#answer ul li").all_inner_texts()[: len(expected.warnings)] == expected.warnings
    assert expected.thresholds.value[0] > 1.0
    expect(page.locator(".verdict")).to_have_class("verdict survives")
    said = float(re.search(r"at most ([\d.]+)°", page.locator("#answer").inner_text())[1])
    assert said == pytest.approx(math.degrees(expected.rotation), rel=0.006)

    expect(page.locator("#rotation canvas")).to_be_visible()
    history = rocking.time_history(
        motion,
        frequency_parameter=BLOCK.frequency_parameter,
        slenderness=BLOCK.uplift_acceleration / motion.peak_acceleration,
        restitution=BLOCK.inelastic_restitution,
        alpha=BLOCK.alpha,
        samples=4000,
    )
    peak = int(np.abs(history.rotation.values).argmax())
    page.evaluate(
        "t => { const s = document.getElementById('time'); s.step = 'any'; s.value = t; "
        "s.dispatchEvent(new Event('input')) }",
        float(history.tau[peak]),
    )
    angle = float(page.locator("#stage").get_attribute("data-angle"))
    assert angle == pytest.approx(BLOCK.alpha * float(history.rotation[peak]), rel=1e-3)

    caption = page.locator("#scales-caption")
    expect(caption).to_contain_text("overturns from")
    first = float(re.search(r"overturns from ([\d.]+)", caption.inner_text())[1])
    exact = float(BLOCK.thresholds(motion).value[0])
    assert first == pytest.approx(exact, rel=1e-3)
    assert first < exact

    expect(page.locator("#pulse-caption")).to_contain_text("of the energy of the velocity")
    expect(page.locator("#pulse-caution")).to_contain_text("does not replace it")

    page.locator("#open-report").click()
    report = page.locator("#report")
    for heading in ("Block", "Ground motion", "Result", "Margins", "Warnings", "Equations", "Assumptions", "Program"):
        expect(report.get_by_role("heading", name=heading, exact=True)).to_be_visible()
    expect(report).to_contain_text(motion.digest)
    expect(report).to_contain_text(f"overturns from {first}")
    assert report.locator("canvas").count() == 3
    report.get_by_role("button", name="Back").click()
    expect(page.locator("#your-block")).to_be_visible()


def test_an_example_is_loaded_and_follows_the_slider_of_its_factor(open_page):
    page = open_page("/records")
    expect(page.locator("#dropped")).to_contain_text("South Napa 2014")
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    expect(page.locator("#scales-caption")).to_contain_text("overturns from")
    page.locator("#factor").fill("0.6")
    page.locator("#factor").dispatch_event("change")
    expect(page.locator("#scale")).to_have_value("3.98")
    expect(page.locator(".verdict")).to_have_text("It overturns.")
    expect(page.locator("#scales-caption")).to_contain_text("dashed: the factor 3.98")


def test_a_file_can_be_dropped(open_page, content):
    page = open_page("/records")
    expect(page.locator(".verdict")).to_be_visible()  # of the example
    page.evaluate(
        """text => {
            const transfer = new DataTransfer();
            transfer.items.add(new File([text], "short.csv"));
            document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true }));
        }""",
        content.decode(),
    )
    expect(page.locator("#dropped")).to_contain_text("short.csv")
    page.wait_for_function("() => document.getElementById('answer').dataset.shown.includes('short.csv')")
    assert page.locator("#file").evaluate("field => field.files[0].name") == "short.csv"


def test_a_bad_file_is_explained_and_what_it_lacks_can_be_stated(open_page, motion):
    page = open_page("/records")
    choose(page, "damaged.csv", (HEADER + "0,0.1\n0.01,0.2\n0.02,what\n0.03,0.1\n").encode())
    expect(page.locator("#file-problem")).to_have_text("damaged.csv, line 4: found what; expected a number")
    expect(page.locator("#answer")).to_be_hidden()
    choose(page, "plain.txt", "\n".join(map(repr, (motion.acceleration / 9.80665).tolist())).encode())
    expect(page.locator("#file-problem")).to_contain_text("the field “Unit of the samples”")
    page.locator("#unit").select_option("g")
    page.locator("#ask").click()
    expect(page.locator("#file-problem")).to_contain_text("the field “Time step [s]”")
    page.locator("#step").fill(repr(motion.time_step))
    page.locator("#ask").click()
    expect(page.locator("#answer")).to_have_attribute("data-shown", re.compile("plain.txt"))
    expect(page.locator(".verdict")).to_be_visible()
    expect(page.locator("#file-problem")).to_be_hidden()


def test_a_block_that_a_weaker_record_overturns_is_not_shown_as_surviving(open_page, content, motion):
    block = rocking.Block(0.2, 1.0)
    factors = np.arange(0.5, 3.0, 0.01)
    outcomes = rocking.peak_response(
        motion,
        frequency_parameter=block.frequency_parameter,
        slenderness=block.uplift_acceleration / motion.peak_acceleration / factors,
        restitution=block.inelastic_restitution,
        alpha=block.alpha,
    )
    survived = np.flatnonzero(~outcomes.overturned)
    factor = float(factors[survived[survived > outcomes.overturned.argmax()][0]])
    page = open_page("/records")
    for name, value in (("width", "0.2"), ("height", "1"), ("scale", f"{factor:.2f}")):
        page.locator(f"#{name}").fill(value)
    choose(page, "short.csv", content)
    expect(page.locator(".verdict")).to_have_class("verdict overturns")
    expect(page.locator(".verdict")).to_have_text("It rocks and comes to rest.")
    expect(page.locator("#answer .margin")).to_contain_text("It overturns from")


def test_values_at_which_the_outcome_changes_are_rounded_to_the_safe_side(open_page):
    page = open_page("/records")
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
