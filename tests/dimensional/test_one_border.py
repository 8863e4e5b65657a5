"""Checks happen once: the work of one response, counted by the calls of Python functions of the package."""

import json
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._cli.app import app
from rocking._dimensional.fields import FIELDS, SHOWN

ROOT = str(Path(rocking.__file__).parent)
BLOCK = rocking.Block(width=0.4, height=1.6)
MOTION = {"peak_acceleration": 4.0, "period": 0.5}
RECORD = rocking.Record(4.0 * np.sin(np.arange(0.0, 6.0, 0.05)), 0.02, "m/s2", "one")


def calls(work):
    """Calls of each function of the package in a warm call; what other threads do does not count."""
    found = Counter()

    def count(frame, event, _):
        if event == "call" and frame.f_code.co_filename.startswith(ROOT):
            found[frame.f_code] += 1

    for _ in range(2):
        work()
    sys.setprofile(count)
    try:
        work()
    finally:
        sys.setprofile(None)
    return found


def assessed():
    found = BLOCK.response("sine", **MOTION)
    return found.sentence, found.margin


def command():
    sizes = "--width 0.4m --height 1.6m --peak-acceleration 0.6g --period 0.5s"
    assert CliRunner().invoke(app, ["response", "--pulse", "sine", *sizes.split()]).exit_code == 0


@pytest.mark.parametrize(
    ("work", "most", "files"),
    [(lambda: BLOCK.response("sine", **MOTION), 70, 15), (assessed, 700, 28), (command, 1500, 45)],
    ids=["response", "sentence and margin", "command of the readme"],
)
def test_one_response_is_little_work(work, most, files):
    found = calls(work)
    assert sum(found.values()) <= most, found
    assert len({code.co_filename for code in found}) <= files, found


@pytest.mark.parametrize(("motion", "arguments"), [("sine", MOTION), (RECORD, {"scale": 0.8})], ids=["pulse", "record"])
def test_one_body_and_an_array_of_one_go_through_the_same_functions(motion, arguments):
    bodies = (rocking.Block([0.4], [1.6]), rocking.RigidBody(0.2, 0.2, 0.8), rocking.RigidBody([0.2], [0.2], [0.8]))
    one = BLOCK.response(motion, **arguments, error_bound=True)
    for body in bodies:
        many = body.response(motion, **arguments, error_bound=True)
        for field in one.fields:
            if field in many.fields:
                value = np.asarray(getattr(many, field.name), np.float64).ravel()[0]
                assert value == pytest.approx(float(getattr(one, field.name)), rel=1e-9, abs=1e-12, nan_ok=True), (
                    field.name
                )
    assert one.fields == bodies[0].response(motion, **arguments, error_bound=True).fields
    of_one, of_array = (
        {
            code
            for code in calls(lambda body=body: body.response(motion, **arguments))
            if "/_base/" not in code.co_filename
        }
        for body in (BLOCK, bodies[0])
    )
    assert of_one == of_array


@pytest.mark.parametrize("kind", ["block", "edges"])
@pytest.mark.parametrize("motion", ["pulse", "record"])
def test_one_body_has_numbers_and_many_have_arrays(kind, motion):
    body = BLOCK if kind == "block" else rocking.RigidBody(0.12, 0.18, 0.4)
    strong = {"peak_acceleration": 4.0, "period": 0.5}
    made = "sine"
    if motion == "record":
        made, strong = RECORD, {"scale": 0.8}
    one = body.response(made, **strong, error_bound=True)
    said, labelled, series = one.to_dict(), one.to_xarray(), one.to_pandas()
    assert {name: labelled[name].attrs["units"] for name in said} == {one.name: one.unit for one in one.fields}
    numbers = [name for name in said if name != "outcome"]
    np.testing.assert_equal([labelled[name].item() for name in numbers], [series[name] for name in numbers])
    assert [*said] == [field.name for field in FIELDS if {kind, motion} <= field.kinds]
    assert json.loads(json.dumps(said)).keys() == said.keys()
    assert one.fields == tuple(field for field in FIELDS if field.name in said)
    assert all(field.label in one.summary() for field in SHOWN if {kind, motion} <= field.kinds)
    name, value = next(iter(strong.items()))
    many = body.response(made, **strong | {name: [value, value]}, error_bound=True)
    assert many.fields == one.fields
    for field in many.fields:
        values = getattr(many, field.name)
        assert (values.shape, values.dtype) == ((2,), np.dtype(field.dtype)), field.name
        rtol = 1.0 if field.name == "error_bound" else 1e-12
        np.testing.assert_allclose(values, float(getattr(one, field.name)), rtol=rtol, err_msg=field.name)
    assert {field.name for field in many.fields} <= {*many.to_xarray().variables, *many.to_dict()}
    for wanted in ("margin", "margins", "contact", "sentence", "warnings", "notes", "amplification"):
        with pytest.raises(InvalidArgumentError, match=f"^`{wanted}`|^`contact`|^`margins`"):
            getattr(many, wanted)


def test_an_array_of_blocks_is_that_of_bodies_with_equal_edges():
    width, height = np.array([0.3, 0.4, 0.5]), np.array([[1.2], [1.6]])
    blocks, bodies = rocking.Block(width, height), rocking.RigidBody.from_size(width, height)
    assert (blocks.shape, blocks == rocking.Block(width, height), blocks == BLOCK) == ((2, 3), True, False)
    assert hash(blocks) == hash(rocking.Block(width, height))
    found, expected = (one.response("sine", **MOTION) for one in (blocks, bodies))
    for field in expected.fields:
        values = getattr(found, field.name), getattr(expected, field.name)
        np.testing.assert_allclose(*map(np.asarray, values), rtol=1e-12, err_msg=field.name)
    assert found.rotation[1, 1] == pytest.approx(BLOCK.response("sine", **MOTION).rotation, rel=1e-12)
    assert found.to_xarray()["rotation"].dims == ("height", "width")
    lowest = blocks.thresholds("sine", period=0.5).lowest[1, 1]
    assert lowest == pytest.approx(BLOCK.thresholds("sine", period=0.5).lowest, rel=1e-9)
    labelled = rocking.Block(xr.DataArray([0.3, 0.4], dims="object"), "160 cm").response("sine", **MOTION)
    np.testing.assert_allclose(labelled["rotation"], found.rotation[1, :2], rtol=1e-12)
    for said, call in (
        ("one body", lambda: blocks.history("sine", **MOTION)),
        ("one body", lambda: blocks.spectrum("sine", **MOTION)),
        ("`width`", lambda: rocking.Block([0.4, -0.4], 1.6)),
        ("shapes that broadcast", lambda: rocking.Block([0.4, 0.5], [1.0, 1.2, 1.4])),
        ("`column`", lambda: rocking.EquivalentBlock.rocking_frame(blocks, mass_ratio=1.0)),
    ):
        with pytest.raises(InvalidArgumentError, match=said):
            call()
