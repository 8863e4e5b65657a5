"""`rocking identify`: text, JSON and CSV, degrees, and errors that name the file."""

import json

import numpy as np
import pytest
from rocking_assessment._evidence.free_rocking import identify_free_rocking

from tests.assessment.evidence.test_free_rocking import trace
from tests.cli.test_cli import read_csv, refused, run


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "trace.csv"
    np.savetxt(path, np.column_stack(trace()), delimiter=",", header="time [s],rotation [rad]")
    return path


def test_three_formats_hold_the_fit(file):
    expected = identify_free_rocking(*trace(), confidence=0.6)
    printed = json.loads(run("identify", str(file), "--format=json", "--confidence", "0.6"))
    for name in ("alpha", "alpha_upper"):
        assert printed[name] == pytest.approx([expected[name].item()], rel=1e-6)
    (row,) = read_csv(run("identify", str(file), "--format=csv"))
    assert float(row["alpha"]) == pytest.approx(expected["alpha"].item(), rel=1e-6)
    assert "alpha [rad]" in run("identify", str(file))
    assert "--confidence" in refused("identify", str(file), "--confidence", "1")


@pytest.mark.parametrize(
    ("header", "times", "options", "message"),
    [
        ("time,rotation [rad]", 1000.0, [], "--time-unit ..."),
        ("time,rotation [rad]", 1000.0, ["--time-unit", "ms"], ""),
        ("frame,rotation [rad]", 100.0, ["--time-step", "0.01s"], ""),
        ("time [s],rotation [rad]", 100.0, [], "is this a counter, or ms?"),
        ("time [ms],rotation [deg]", 1000.0, [], ""),
        ("time [s],rotation", 1.0, [], "--unit (rad, deg, mrad)"),
        ("time [s],rotation", 1.0, ["--unit", "deg"], ""),
        ("time [s],roll", 1.0, ["--unit", "deg"], "--rotation"),
        ("time [s],roll", 1.0, ["--unit", "deg", "--rotation", "roll"], ""),
    ],
)
def test_times_and_rotations_are_in_the_units_that_are_stated(file, header, times, options, message):
    time, rotation = trace()
    factor = 180.0 / np.pi if "deg" in options or "[deg" in header else 1.0
    np.savetxt(file, np.column_stack([times * time, factor * rotation]), delimiter=",", header=header, comments="")
    if message:
        assert message in refused("identify", str(file), *options)
    else:
        printed = json.loads(run("identify", str(file), "--format=json", *options))
        assert printed["frequency_parameter"] == pytest.approx([2.5], rel=1e-2)
        assert printed["alpha"] == pytest.approx([0.25], rel=1e-3)


def test_a_drift_is_warned_of(file):
    time, rotation = trace()
    columns = np.column_stack([time, rotation + 1e-3 * time])
    np.savetxt(file, columns, delimiter=",", header="time [s],rotation [rad]")
    assert "warning: " in run("identify", str(file))
    printed = json.loads(run("identify", str(file), "--format=json"))
    assert printed["drift"] == pytest.approx(1e-3, rel=0.05)
    assert any("the sensor drifts" in text for text in printed["warnings"])


def test_errors_name_the_file(file):
    assert "no such file" in refused("identify", str(file.with_name("none.csv")))
    file.write_text("1\n2\n3\n")
    assert "--rotation" in refused("identify", str(file))
