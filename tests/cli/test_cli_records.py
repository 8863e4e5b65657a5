"""`rocking record` and `rocking fragility`: formats, errors that name the option or the file."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

import rocking
from rocking._cli.app import app
from rocking.suites.configuration import suite_configuration
from tests.cli.test_cli import read_csv, refused, run
from tests.excitation.record_files import at2, rows

ROOT = Path(__file__).parents[2]
MOTION = str(ROOT / "workflow/motions/synthetic_31.csv")
"""The shortest of those of the workflow."""

UP = str(ROOT / "workflow/motions/synthetic_32.csv")
SIZES = ["--width", "0.5m", "--height", "200 cm"]
OFFSET = ["--body", "offset_mass(width=0.5m, height=2m, offset=3cm)"]


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """A configuration of two records and few levels."""
    suite = yaml.safe_load((ROOT / "workflow/config/suite.yaml").read_text())["suite"]
    suite |= {"intensity": [2.0, 4.0, 6.0, 9.0], "map": None, "blocks": suite["blocks"][:1]}
    suite["records"] |= {"folder": str(ROOT / "workflow/motions"), "pattern": "synthetic_3[12].csv"}
    path = tmp_path_factory.mktemp("suite") / "suite.json"
    path.write_text(json.dumps(suite))
    return path


def test_remarks_of_the_reader_are_warnings(tmp_path):
    path = tmp_path / "motion.at2"
    path.write_text(at2("NPTS= 101, DT= .01 SEC", body=rows(count=100)))
    remark = "the file holds 100 samples, its header states 101"
    assert rocking.Block(0.5, 2.0).response(rocking.read_record(path)).warnings[0] == remark
    assert f"\nwarning: {remark}\n" in run("record", str(path), *SIZES)
    assert json.loads(run("record", str(path), *SIZES, "--format=json"))["warnings"][0] == remark


def test_record_in_three_formats():
    block, motion = rocking.Block(0.5, 2.0), rocking.read_record(MOTION)
    expected = block.response(motion, scale=0.9)
    result = json.loads(run("record", MOTION, *SIZES, "--scale", "0.9", "--format=json"))
    assert {name: result[name] for name in expected.summary()} == expected.summary()
    assert (result["scale"], result["thresholds"]) == (0.9, expected.changes)
    assert result["peak_acceleration"] == motion.peak_acceleration
    (row,) = read_csv(run("record", MOTION, *SIZES, "--scale", "0.9", "--format=csv"))
    assert float(row["peak_rotation"]) == result["peak_rotation"]
    assert row["overturned"] == "false"
    assert run("record", MOTION, *SIZES, "--scale", "0.9").startswith("rocks and comes to rest\n")


def test_a_body_whose_mass_is_not_in_the_middle():
    expected = rocking.RigidBody.from_size(0.5, 2.0, offset=0.03).response(rocking.read_record(MOTION), scale=0.9)
    result = json.loads(run("record", MOTION, *OFFSET, "--scale=0.9", "--format=json"))
    assert {name: result[name] for name in expected.summary()} == expected.summary()
    assert result["body"] == expected.body.description
    assert [change["scale"] for change in result["thresholds"]] == expected.thresholds.value.tolist()
    faster = json.loads(run("record", MOTION, *OFFSET, "--no-thresholds", "--format=json"))
    assert (faster["margin"], faster["thresholds"]) == (None, None)


def test_thresholds_and_pulse():
    result = json.loads(run("record", MOTION, *SIZES, "--thresholds", "--fit", "--restitution", "0.8", "--format=json"))
    expected = rocking.Block(0.5, 2.0).thresholds(rocking.read_record(MOTION), restitution=0.8)
    assert [change["scale"] for change in result["thresholds"]] == expected.value.tolist()
    assert [change["overturns_above"] for change in result["thresholds"]] == [
        change.overturns_above for change in expected.changes
    ]
    assert result["pulse"] == "mavroeidis_papageorgiou"
    assert 0.0 < result["pulse_explained"] < 1.0


def test_unit_and_step_are_stated_where_the_file_does_not(tmp_path):
    motion = rocking.read_record(MOTION)
    path = tmp_path / "plain.txt"
    path.write_text("\n".join(map(repr, (motion.acceleration * 100.0).tolist())))
    unit, step, column = ["--unit", "cm/s2"], ["--time-step", "10 ms"], ["--acceleration", "1"]
    response = json.loads(run("record", str(path), *SIZES, *unit, *step, *column, "--no-thresholds", "--format=json"))
    expected = rocking.Block(0.5, 2.0).response(motion, thresholds=False)
    assert response["peak_rotation"] == pytest.approx(expected.peak_rotation, rel=1e-6)
    assert "such as --acceleration 1 --time-step 0.01 --unit ..." in refused(
        "record", str(path), *SIZES, *step, *column
    )
    message = refused("record", str(path), *SIZES, *unit)
    assert "--time-step" in message  # not the name in Python


def test_baseline_is_removed_on_request_only():
    option_lists = ([], ["--baseline-order", "1"])
    plain, corrected = (
        json.loads(run("record", MOTION, *SIZES, *options, "--format=json")) for options in option_lists
    )
    assert abs(corrected["final_velocity"]) < abs(plain["final_velocity"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere.csv", *SIZES], "'nowhere.csv': no such file"),
        ([MOTION, "--width", "0.5", "--height", "2m"], "--width"),
        ([MOTION, *SIZES, "--scale", "0"], "--scale"),
        ([MOTION, *SIZES, "--restitution", "plastic"], "--restitution"),
        ([MOTION, *SIZES, "--unit", "feet"], "--unit"),
        ([MOTION, *SIZES, "--baseline-order", "9"], "--baseline-order"),
    ],
)
def test_invalid_options_are_named(arguments, message):
    assert message in refused("record", *arguments)


def test_fragility_in_three_formats(small):
    result = json.loads(run("fragility", str(small), "--format=json"))
    assert result["records"] == ["synthetic_31", "synthetic_32"]
    suite = suite_configuration(json.loads(small.read_text()), small.parent)
    expected = rocking.fragility(suite.motions(), suite.blocks[0], intensity=suite.intensity)
    chosen = [k for k, demand in enumerate(result["levels"]["demand"]) if demand == "overturning"]
    assert [result["levels"]["exceedances"][k] for k in chosen] == expected.exceedances.values.tolist()
    assert result["curves"]["fit_status"][0] in {"FITTED", "SEPARATED"}
    assert result["curves"]["median_intensity"][0] == pytest.approx(float(expected.median_intensity[0]))
    rows = list(read_csv(run("fragility", str(small), "--format=csv")))
    assert len(rows) == 3 * 4
    assert {row["demand"] for row in rows} == {"overturning", "alpha", "0.5 alpha"}
    assert run("fragility", str(small)).splitlines()[2].split() == ["measure", "pga"]
    lines = run("fragility", str(small), "--table=curves").splitlines()
    median = float(expected.sel(model="lognormal").median_intensity)
    (line,) = (line for line in lines if line.startswith("overturning") and "lognormal" in line)
    assert f"{median:.9g}" in line


def test_friction_restitution_and_sampling_in_three_formats(small):
    suite = suite_configuration(json.loads(small.read_text()), small.parent)
    expected = rocking.suites.suite_sensitivity(suite.motions(), suite.blocks[0], intensity=suite.sensitivity.intensity)
    result = json.loads(run("fragility", str(small), "--format=json"))["sensitivity"]
    rows = list(read_csv(run("fragility", str(small), "--format=csv", "--table", "sensitivity")))
    for name in ("intensity", "fraction_low_restitution", "changed_resampled", "friction_demand_largest"):
        assert result[name] == [float(row[name]) for row in rows] == expected[name].values.tolist()


def test_table_is_what_the_configuration_asks_for(small, tmp_path):
    rows = read_csv(run("fragility", str(small), "--format=csv", "--table", "curves"))
    assert len(rows) == 3 * 2
    suite = json.loads(small.read_text())
    del suite["sensitivity"]
    path = tmp_path / "plain.yaml"
    path.write_text(yaml.safe_dump({"title": "a suite", "suite": suite}))
    assert run("fragility", str(path), "--format=csv") == run("fragility", str(small), "--format=csv")
    assert "no sensitivity" in refused("fragility", str(path), "--format=csv", "--table", "sensitivity")
    assert "sensitivity" not in json.loads(run("fragility", str(path), "--format=json"))


def test_a_file_in_place_of_printing(small, tmp_path):
    path = tmp_path / "curves.json"
    assert run("fragility", str(small), "--output", str(path)) == ""
    printed = json.loads(run("fragility", str(small), "--format=json"))
    assert json.loads(path.read_text())["levels"] == printed["levels"]
    run("fragility", str(small), "-o", str(path.with_suffix(".csv")))
    assert path.with_suffix(".csv").read_text().startswith("demand,width")
    assert "--output" in refused("fragility", str(small), "--output", "curves.txt")
    assert "--output" in refused("fragility", str(small), "--output", str(tmp_path / "none" / "curves.csv"))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"measure": "sa"}, "measure = 'sa' is not allowed"),
        ({"colour": 1}, "unknown colour"),
        ({"blocks": []}, "blocks"),
        ({"records": {"folder": ".", "pattern": "/*.csv", "unit": "m/s2"}}, "there is none"),
    ],
)
def test_invalid_configuration_names_the_key(small, tmp_path, change, message):
    path = tmp_path / "suite.json"
    path.write_text(json.dumps(json.loads(small.read_text()) | change))
    assert message in refused("fragility", str(path))


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.toml", "x =", "a.toml"),
        ("a.json", "{", "a.json"),
        ("a.yaml", "a: [1", "a.yaml"),
        ("b.json", "[1]", "b.json"),
        ("a.json", "[" * 10_000, "a readable configuration"),
    ],
)
def test_unreadable_configurations_are_refused(name, text, message, tmp_path):
    (tmp_path / name).write_text(text)
    assert message in refused("fragility", str(tmp_path / name))


def test_remarks_of_a_suite_are_warnings(small, tmp_path):
    folder = tmp_path / "motions"
    folder.mkdir()
    for name in ("first", "second"):
        (folder / f"{name}.at2").write_text(at2("NPTS= 101, DT= .01 SEC", body=rows(count=100)))
    suite = json.loads(small.read_text())
    suite["records"] |= {"folder": str(folder), "pattern": "*.at2", "format": None, "baseline_order": 1}
    path = tmp_path / "suite.json"
    path.write_text(json.dumps(suite))
    printed = CliRunner().invoke(app, ["fragility", str(path)])
    assert printed.exit_code == 0
    assert "warning: first: the file holds 100 samples, its header states 101\n" in printed.stderr


def test_a_vertical_component_of_a_file_or_a_column(tmp_path):
    motion = rocking.read_record(MOTION, vertical=UP)
    expected = rocking.Block(0.5, 2.0).response(motion, scale=0.9)
    options = [*SIZES, "--scale=0.9", "--format=json"]
    response = json.loads(run("record", MOTION, *options, "--vertical", UP))
    assert response["peak_rotation"] == float(expected.peak_rotation)
    assert response["peak_vertical_acceleration"] == motion.peak_vertical_acceleration
    path = tmp_path / "both.csv"
    rows = np.stack([motion.times, motion.acceleration, motion.vertical], axis=1).tolist()
    path.write_text("time [s],h [m/s2],up [m/s2]\n" + "".join(f"{t!r},{a!r},{w!r}\n" for t, a, w in rows))
    same = json.loads(run("record", str(path), *options, "--acceleration", "h", "--vertical", "up"))
    assert same["peak_rotation"] == response["peak_rotation"]
    assert "--vertical" in refused("record", MOTION, *SIZES, "--vertical", "none.at2")
    message = refused("record", MOTION, *SIZES, "--vertical", UP, "--scale", "4")
    assert "--scale" in message
    assert "-g at " in message


def test_the_worst_direction_of_two_components(tmp_path):
    """By turning the motion by hand."""
    motions = ROOT / "workflow/motions"
    for name in ("napa_HNE", "napa_HNN", "vertical/napa_HNZ"):
        rows = (motions / f"{name}.csv").read_text().splitlines()
        (tmp_path / f"{name[-3:]}.csv").write_text("\n".join([rows[0], *rows[1:2001:4]]))
    east, north, up = (str(tmp_path / f"{name}.csv") for name in ("HNE", "HNN", "HNZ"))
    first, second = (rocking.read_record(path, vertical=up) for path in (east, north))
    options = [*SIZES, "--second", north, "--vertical", up, "--format=json"]
    response = json.loads(run("record", east, *options))

    def along(degrees):
        angle = math.radians(degrees)
        values = math.cos(angle) * first.acceleration + math.sin(angle) * second.acceleration
        return rocking.Record(values, first.time_step, "m/s2", vertical=first.vertical)

    turned = rocking.Block(0.5, 2.0).response(along(response["direction_deg"]))
    assert response["overturning_scale"] == pytest.approx(turned.overturning_scale)
    body = rocking.RigidBody.from_size(0.5, 2.0, offset=0.05)
    wide = ["--body", "offset_mass(width=0.5m, height=2m, offset=5cm)"]
    quick = json.loads(run("record", east, *options[len(SIZES) :], *wide, "--no-thresholds", "--scale=0.7"))
    every = [body.response(along(15 * k), scale=0.7, thresholds=False) for k in range(24)]
    assert quick["overturned"] == any(single.overturned for single in every)
    if not quick["overturned"]:
        assert quick["peak_rotation_deg"] == pytest.approx(max(math.degrees(single.rotation) for single in every))
    assert "--second" in refused("record", east, *SIZES, "--second", str(motions / "napa_HNN.csv"))


def test_the_motion_under_a_record_as_numbers_with_forces_of_a_known_mass():
    block, motion = rocking.Block(0.5, 2.0), rocking.read_record(MOTION)
    options = ("--history", "--samples=50")
    expected = block.history(motion, scale=1.0, samples=50, contact=True)
    history = json.loads(run("record", MOTION, *SIZES, *options, "--mass=200kg", "--format=json"))
    np.testing.assert_array_equal(history["time"], expected["time"])
    np.testing.assert_array_equal(history["rotation"], expected["rotation"])
    np.testing.assert_allclose(history["normal_force"], 200.0 * block.gravity * expected["normal_reaction"])
    mirrored = json.loads(run("record", MOTION, *SIZES, *options, "--mirrored", "--format=json"))
    np.testing.assert_allclose(mirrored["rotation"], np.negative(history["rotation"]), atol=1e-12)
    assert "normal_force" not in mirrored
    (first, *_) = read_csv(run("record", MOTION, *OFFSET, *options, "--mass=200kg", "--format=csv"))
    assert {"edge", "normal_reaction", "horizontal_force", "vertical_acceleration"} <= first.keys()


@pytest.mark.parametrize(
    ("options", "option"), [(["--contact"], "--contact"), (["--mass=3kg"], "--mass"), (["--history", "--fit"], "--fit")]
)
def test_options_of_the_motion_belong_to_it(options, option):
    assert option in refused("record", MOTION, *SIZES, *options)


def test_the_mirrored_record_has_thresholds_of_its_own():
    body, motion = rocking.RigidBody.from_size(0.5, 2.0, offset=0.03), rocking.read_record(MOTION)
    response = json.loads(run("record", MOTION, *OFFSET, "--mirrored", "--format=json"))
    expected = body.thresholds(motion.mirrored()).value.tolist()
    assert [change["scale"] for change in response["thresholds"]] == expected
    assert response["record"].endswith(", mirrored")
