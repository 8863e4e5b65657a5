"""`rocking identify`: text, JSON and CSV, degrees, and errors that name the file."""

import json

import numpy as np
import pytest
from rocking_assessment._evidence.free_rocking import identify_free_rocking

from tests.assessment.objects.objects.objects.objects.evidence.test_free_rocking import trace
from tests.cli.test_cli import read_csv, refused, run


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "trace.csv"
    np.savetxt(path, np.column_stack(trace()), delimiter=",", header="time,rotation", comments="")
    return path


def test_three_formats_hold_the_fit(file):
    expected = identify_free_rocking(*trace(), confidence=0.6)
    found = json.loads(run("identify", str(file), "--format=json", "--confidence", "0.6"))
    for name in ("alpha", "alpha_upper"):
        assert found[name] == pytest.approx([expected[name].item()], rel=1e-6)
    (row,) = read_csv(run("identify", str(file), "--format=csv"))
    assert float(row["alpha"]) == pytest.approx(expected["alpha"].item(), rel=1e-6)
    assert "alpha [rad]" in run("identify", str(file))
    assert "--confidence" in refused("identify", str(file), "--confidence", "1")


@pytest.mark.parametrize(
    ("header", "times", "options", "said"),
    [
        ("time,rotation", 1000.0, [], "a unit of times, such as time [ms]"),
        ("time,rotation", 100.0, ["--time-step", "0.01s"], ""),
        ("time [s],rotation", 100.0, ["--time-step", "0.01s"], "the stated time step of 0.01 s"),
        ("time [s],rotation", 100.0, [], "is this a counter, or ms?"),
        ("ms,angle in mrad", 1000.0, [], ""),
        ("time [ms],rotation [deg]", 1000.0, [], ""),
        ("time [ms],rotation [deg]", 1000.0, ["--degrees"], ""),
        ("time [s],rotation [rad]", 1.0, ["--degrees"], "rotations in deg"),
        ("time [s],angular velocity", 1.0, [], "expected a column of rotations"),
        ("time [s],rotation (filtered)", 1.0, ["--degrees"], ""),
    ],
)
def test_times_and_rotations_without_a_unit_that_is_understood(file, header, times, options, said):
    time, rotation = trace()
    factor = 1000.0 if "mrad" in header else 180.0 / np.pi if options == ["--degrees"] or "[deg" in header else 1.0
    np.savetxt(file, np.column_stack([times * time, factor * rotation]), delimiter=",", header=header, comments="")
    if said:
        assert said in refused("identify", str(file), *options)
    else:
        found = json.loads(run("identify", str(file), "--format=json", *options))
        assert found["frequency_parameter"] == pytest.approx([2.5], rel=1e-2)
        assert found["alpha"] == pytest.approx([0.25], rel=1e-3)


def test_a_drift_is_warned_of(file):
    time, rotation = trace()
    np.savetxt(file, np.column_stack([time, rotation + 1e-3 * time]), delimiter=",")
    assert "warning: " in run("identify", str(file))
    found = json.loads(run("identify", str(file), "--format=json"))
    assert found["drift"] == pytest.approx(1e-3, rel=0.05)
    assert any("the sensor drifts" in text for text in found["warnings"])


def test_errors_name_the_file(file):
    assert "no such file" in refused("identify", str(file.with_name("none.csv")))
    file.write_text("1\n2\n3\n")
    assert "one column" in refused("identify", str(file))
