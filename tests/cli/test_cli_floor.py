"""`rocking floor`: a record that the other commands read, and errors that name the option."""

import json

import numpy as np
import pytest

import rocking
from tests.cli.test_cli import refused, run
from tests.cli.test_cli_records import MOTION, SIZES


def test_the_motion_of_a_floor_is_read_again(tmp_path):
    path = tmp_path / "floor.csv"
    modes = ["--period", "0.5s", "--period", "100 ms", "--participation", "1.3", "--participation", "-0.3"]
    path.write_text(run("floor", MOTION, *modes, "--damping", "0.03"))
    expected = rocking.floor_motion(
        rocking.read_record(MOTION), periods=[0.5, 0.1], damping=0.03, participation=[1.3, -0.3]
    )
    found = rocking.read_record(path)
    np.testing.assert_array_equal(found.acceleration, expected.acceleration)
    assert found.time_step == pytest.approx(expected.time_step, rel=1e-9)


def test_a_block_on_an_isolation(tmp_path):
    path = tmp_path / "isolated.csv"
    path.write_text(run("floor", MOTION, "--period", "3s", "--damping", "0.2"))
    motion = rocking.isolated_motion(rocking.read_record(MOTION), period=3.0, damping=0.2)
    response = json.loads(run("record", str(path), *SIZES, "--no-thresholds", "--format=json"))
    assert response["peak_acceleration"] == pytest.approx(motion.peak_acceleration)
    assert response["peak_acceleration"] < 0.5 * rocking.read_record(MOTION).peak_acceleration


def test_a_vertical_component_is_another_column():
    header = run("floor", MOTION, "--period", "0.5s", "--vertical", MOTION).splitlines()[0]
    assert header == "time_s,acceleration_m/s2,vertical_m/s2"


@pytest.mark.parametrize(
    ("said", "options"),
    [
        ("--period", [MOTION]),
        ("--period", [MOTION, "--period", "0.5"]),
        ("--period", [MOTION, "--period", "1000s"]),
        ("--damping", [MOTION, "--period", "0.5s", "--damping", "1.5"]),
        ("none.csv", ["none.csv", "--period", "0.5s"]),
    ],
)
def test_errors_name_the_option(said, options):
    assert said in refused("floor", *options)
