"""Files of sampled pulses: columns and JSON, errors with the file and the line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from rocking._excitation.sampled import MAX_SAMPLES

VALUES, TIMES = [0.0, 1.0, -0.25, 0.0], [0.0, 0.5, 0.75, 2.0]
TEXTS = {
    "one column": "0\n1\n-0.25\n0\n",
    "one column with a header": "acceleration [g]\n0\n1\n-0.25\n0\n\n",
    "commas": "0,0\n0.5,1\n0.75,-0.25\n2,0\n",
    "semicolons": "time;acceleration\n0;0\n0.5;1\n0.75;-0.25\n2;0\n",
    "blanks": "a pulse without names\n0 0\n 0.5  1\n\n0.75 -.25\n2 0\n",
    "any unit": "time [weeks],acceleration [furlong]\n0,0\n0.5,1\n0.75,-0.25\n2,0\n",
    "the times last": "acc,time\n0,0\n1,0.5\n-0.25,0.75\n0,2\n",
    "JSON": json.dumps({"acceleration": VALUES, "time": TIMES}),
    "JSON without times": json.dumps({"acceleration": VALUES, "time": None}),
    "JSON with a mark": "\ufeff" + json.dumps({"acceleration": VALUES}),
}


def written(folder: Path, text: str, encoding: str = "utf-8") -> Path:
    path = folder / "ramp.csv"
    path.write_text(text, encoding=encoding)
    return path


@pytest.mark.parametrize("form", TEXTS)
def test_every_form_holds_the_pulse(form: str, tmp_path: Path) -> None:
    text = TEXTS[form]
    timed = "0.75" in text
    expected = rocking.SampledPulse(VALUES, TIMES if timed else None, name="ramp")
    for encoding in ("utf-8", "utf-16"):
        assert rocking.SampledPulse.from_file(written(tmp_path, text, encoding)) == expected


def test_period_and_name_of_a_file(tmp_path: Path) -> None:
    path = written(tmp_path, json.dumps({"acceleration": VALUES, "time": TIMES, "period": 4.0, "name": "slow ramp"}))
    slow = rocking.SampledPulse(VALUES, TIMES, 4.0, "slow ramp")
    assert rocking.SampledPulse.from_file(path) == slow
    assert rocking.SampledPulse.from_file(path, period=0.5) == rocking.SampledPulse(VALUES, TIMES, 0.5, "slow ramp")
    assert rocking.SampledPulse.from_file(str(written(tmp_path, TEXTS["commas"])), 4.0).end == slow.end


def test_the_layout_of_a_file_can_be_stated(tmp_path: Path) -> None:
    path = written(tmp_path, "a pulse\nx;t\n0;0\n1;0,5\n-0,25;0,75\n0;2\n")
    pulse = rocking.SampledPulse.from_file(path, skip=1, acceleration="x", time="t", decimal=",")
    assert pulse == rocking.SampledPulse(VALUES, TIMES, name="ramp")


@pytest.mark.parametrize(
    ("text", "value", "allowed"),
    [
        ("", "ramp.csv: an empty file", "acceleration"),
        ("a\nb\n", "ramp.csv, line 2: a", "accelerations, or times and accelerations"),
        ("0,1,2\n1.5,2,3\n", "ramp.csv, line 1: 3 columns", "accelerations, or times and accelerations"),
        ("0.0,0\n1,x\n", "ramp.csv, line 2: x", "a number"),
        ("0.0,0\n1\n", "ramp.csv, line 2: an empty cell", "a number"),
        ("0,1\n1,2\n2,0\n", "ramp.csv, line 1: numbers with one comma", 'delimiter=","'),
        ("time,acc\n0,0\n1,1\n\n0.5,0\n", "ramp.csv, line 5: time 0.5", "ascending times, above 1"),
        ("1\n2\n1e999\n", "ramp.csv, line 3: 1e999", "a number"),
        ("0.0,0\n1,nan\n", "ramp.csv, line 2: nan", "a number"),
        ("0\n0\n", "ramp.csv: acceleration all samples 0", "not zero"),
        ("5\n", "ramp.csv: acceleration shape (1,)", f"2 to {MAX_SAMPLES} numbers"),
        ("velocity\n1\n2\n", "ramp.csv, line 2: velocity", "accelerations, or times"),
        ("the velocity of a pulse\n1\n2\n", "ramp.csv, line 2: the velocity", "accelerations, or times"),
        ("time\n1\n2\n", "ramp.csv, line 2: time", "accelerations, or times"),
        ("1 " * 5000, "ramp.csv, line 1: 1 1", "lines of at most 8192 bytes"),
        ("1\n" * (MAX_SAMPLES + 1), "rows", f"at most {MAX_SAMPLES}"),
        ("1" * 9_000_000, "ramp.csv: a larger file", "at most 8000000 bytes"),
        ('{"acceleration": [0, 1,]}', "ramp.csv, line 1: ", "JSON"),
        ('{"time": [0, 1]}', "ramp.csv: no key acceleration", "the keys acceleration, time, period, name"),
        ('{"acceleration": [0, 1], "dt": 1}', "ramp.csv: the key dt", "the keys"),
        ('{"acceleration": [0, NaN]}', "ramp.csv: acceleration[1] nan", "(-inf, inf)"),
        ('{"acceleration": [0, "1"]}', "ramp.csv: acceleration ", "a number"),
        ('{"acceleration": [0, 1], "period": "a"}', "ramp.csv: period a", "a number"),
        ('{"acceleration": [0, 1], "name": ""}', "ramp.csv: name ", "not empty"),
        ('{"acceleration": ' + "[" * 100_000, "ramp.csv: ", "JSON"),
        ('{"acceleration": [' + "1" * 5000 + "]}", "ramp.csv: ", "JSON"),
    ],
)
def test_errors_name_the_file_and_the_line(text: str, value: str, allowed: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidArgumentError) as caught:
        rocking.SampledPulse.from_file(written(tmp_path, text))
    assert caught.value.parameter == "pulse"
    assert value in str(caught.value.value)
    assert allowed in caught.value.allowed
    assert len(str(caught.value)) < 400


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidArgumentError, match=r"`path` = .*no such file"):
        rocking.SampledPulse.from_file(tmp_path / "none.csv")
