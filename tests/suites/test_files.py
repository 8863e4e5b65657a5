"""A fragility in files: CSV, JSON without nan, NRML."""

import csv
import json

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from tests.suites.motions import noise
from tests.suites.test_nrml import read

LEVELS = [1.0, 3.0, 6.0, 12.0]


@pytest.fixture(scope="module")
def found():
    return rocking.fragility([noise(k) for k in range(4)], rocking.Block(0.3, 1.0), intensity=LEVELS)


def test_three_files_hold_the_fractions(found, tmp_path):
    for ending in ("csv", "json", "xml"):
        rocking.suites.write_fragility(found, tmp_path / f"curves.{ending}")
    expected = found["fraction"].values
    with (tmp_path / "curves.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["fraction"]) for row in rows] == expected.tolist()
    assert {float(row["width"]) for row in rows} == {0.3}
    content = json.loads((tmp_path / "curves.json").read_text(), parse_constant=pytest.fail)
    assert content["levels"]["fraction"] == expected.tolist()
    assert (content["measure"], content["unit"]) == ("pga", "m s-2")
    assert content["curves"]["median_intensity"] == found["median_intensity"].values.tolist()
    (curves,) = read(tmp_path / "curves.xml").values()
    np.testing.assert_allclose(curves["overturns"](np.array(LEVELS) / 9.80665), expected, atol=1e-8)


def test_a_curve_that_does_not_exist_is_null(tmp_path):
    mild = rocking.fragility(noise(1), rocking.Block(0.3, 1.0), intensity=[0.1, 0.2])
    rocking.suites.write_fragility(mild, tmp_path / "mild.json")
    assert json.loads((tmp_path / "mild.json").read_text())["curves"]["median_intensity"] == [None, None]


def test_another_ending_is_refused(found, tmp_path):
    with pytest.raises(InvalidArgumentError, match=r"\.csv"):
        rocking.suites.write_fragility(found, tmp_path / "curves.txt")
