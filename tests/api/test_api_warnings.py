"""The same question in Python, over HTTP and on the command line: the same warnings and margin, in the same order.

The pages render the list of the HTTP response (`tests/api/explorer/test_records.py`).
"""

import json
import math

import pytest
from rocking_api.routers import records
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app
from tests.api.conftest import NAPA
from tests.sampling import but_long


def command_line(*arguments):
    """JSON, and the lines of the text."""
    runner = CliRunner()
    as_json, as_text = (runner.invoke(app, [*arguments, *form]) for form in (["--format=json"], []))
    assert as_json.exit_code == as_text.exit_code == 0, as_json.output
    return json.loads(as_json.stdout), as_text.stdout.splitlines()


def assert_same(python, http, result, lines):
    """The same warnings and margin; the text begins with the outcome, the margin of a record, and the warnings."""
    assert http["warnings"] == result["warnings"] == python.warnings
    assert http["margin"] == result["margin"] == python.margin
    assert http["meaning"] == lines[0] == python.sentence
    sentences = 1 if python.margin is None else 2
    printed = lines[sentences : sentences + len(python.warnings)]
    assert printed == [f"warning: {text}" for text in python.warnings]
    assert not any(line.startswith("warning: ") for line in lines[sentences + len(printed) :])


PULSES = [
    # width [m], height [m], peak acceleration [m/s2], period [s], texts of warnings in their order
    (0.4, 1.6, 4.0, 0.5, []),
    (0.4, 1.6, 4.65, 0.5, ["within 5 % of this peak acceleration", "within 5 % of this period"]),
    (2.0, 1.0, 2.1 * 9.80665, 0.5, ["the block may slide", "restitution (2.4)", "wider than high"]),
    (1.0, 1.0, 1.5 * 9.80665, 0.5, ["the block may slide", "no largest surviving acceleration"]),
]


def assert_order(python, texts):
    places = [next(k for k, warning in enumerate(python.warnings) if text in warning) for text in texts]
    assert places == sorted(places)


@pytest.mark.parametrize(("width", "height", "acceleration", "period", "texts"), PULSES)
def test_warnings_under_a_pulse(client, width, height, acceleration, period, texts):
    python = rocking.Block(width, height).response("sine", peak_acceleration=acceleration, period=period)
    motion = {"peak_acceleration": acceleration, "period": period, "pulse": "sine"}
    http = client.get("/v1/blocks/response", params=motion | {"width": width, "height": height}).json()
    found = command_line(
        *("response", "--pulse", "sine", "--width", f"{width}m", "--height", f"{height}m"),
        *("--peak-acceleration", f"{acceleration!r} m/s2", "--period", f"{period}s"),
    )
    assert_same(python, http, *found)
    assert_order(python, texts)


def test_an_acceleration_with_its_unit_is_not_asked_whether_g_was_meant(client):
    """Without a unit the answer has that warning."""
    given = {"pulse": "sine", "width": "40cm", "height": "1.6m", "period": "0.5s"}
    for peak, asked in (("1.96", True), ("0.2g", False), ("1.96 m/s2", False)):
        found = client.get("/v1/blocks/response", params=given | {"peak_acceleration": peak}).json()
        assert any("meant in g" in one for one in found["warnings"]) == asked


RECORDS = [
    # width [m], height [m], factor, texts of warnings in their order
    (0.5, 2.0, 0.5, ["not monotone"]),
    (
        *(0.2, 1.0, 0.87),
        ["accumulate to rest", "sampled", "the peak is not determined by this record", "within 5 %", "not monotone"],
    ),
    (2.4, 1.2, 6.0, ["restitution (2.4)", "wider than high"]),
]


@pytest.mark.parametrize("case", but_long(RECORDS, RECORDS[1]))
def test_warnings_under_a_record(client, case):
    width, height, scale, texts = case
    python = rocking.Block(width, height).response(rocking.read_record(NAPA), scale=scale)
    params = {"width": width, "height": height, "scale": scale, "name": NAPA.name}
    http = client.post("/v1/records/response", params=params, content=NAPA.read_bytes()).json()
    sizes = ("--width", f"{width}m", "--height", f"{height}m", "--scale", repr(scale))
    result, lines = command_line("record", str(NAPA), *sizes)
    assert_same(python, http, result, lines)
    assert lines[:2] == [python.sentence, python.margin]
    assert python.margin in repr(python)
    assert_order(python, texts)


def test_a_peak_that_the_record_does_not_determine_says_so_beside_it():
    block, motion = rocking.Block(0.2, 1.0), rocking.read_record(NAPA)
    found = block.response(motion, scale=0.87, thresholds=False)
    assert not found.peak_is_determined
    assert "deg (not determined: amplification 4.2e+08), top displacement" in repr(found)
    changed = rocking.Record(motion.acceleration * (1.0 + 1e-8), motion.time_step, "m/s2")
    other = block.response(changed, scale=0.87, thresholds=False)
    assert abs(other.rotation / found.rotation - 1.0) > 0.1 or other.overturned
    for scale in (0.6, 0.1, 5.0):  # a block that stays or overturns has no amplification
        found = block.response(motion, scale=scale, thresholds=False)
        assert found.peak_is_determined
        assert math.isnan(found.amplification) == (scale != 0.6)
        assert "not determined" not in repr(found)


def test_the_search_of_scales_is_bounded_and_can_be_left_out(client, monkeypatch):
    params = {"width": 0.5, "height": 2.0}
    full = client.post("/v1/records/response", params=params, content=NAPA.read_bytes()).json()
    assert full["overturning_scale"] == full["thresholds"][0]["scale"] == pytest.approx(1.1338, rel=1e-3)
    left = client.post("/v1/records/response", params=params | {"thresholds": False}, content=NAPA.read_bytes()).json()
    assert left["thresholds"] is left["overturning_scale"] is left["margin"] is None
    assert left["warnings"] == [text for text in full["warnings"] if "scale" not in text]
    monkeypatch.setattr(records, "SEARCH_SHARE", 0.0)
    late = client.post("/v1/records/response", params=params, content=NAPA.read_bytes()).json()
    assert late["margin"] == "from which factor of the record it overturns was not found in time"
    assert late["thresholds"] is None
    assert "factors of the record at which the outcome changes were not found in time" in late["warnings"][-1]
