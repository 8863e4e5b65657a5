"""A fragility in files: CSV and JSON."""

import csv
import json

import numpy as np
import pytest

import rocking
from rocking._base.errors import InvalidArgumentError
from tests.suites.motions import noise


def test_three_files_hold_the_fractions(tmp_path):
    blocks = [rocking.Block(0.2, 1.0), rocking.Block(0.3, 1.0)]
    levels = np.geomspace(1.0, 60.0, 15)
    fragility = rocking.fragility([noise(k) for k in range(8)], blocks, intensity=levels)
    fragility = fragility.isel(block=1)
    for ending in ("csv", "json"):
        rocking.suites.write_fragility(fragility, tmp_path / f"curves.{ending}")
    expected = fragility["fraction"].values
    with (tmp_path / "curves.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["fraction"]) for row in rows] == expected.tolist()
    assert {float(row["width"]) for row in rows} == {0.3}
    content = json.loads((tmp_path / "curves.json").read_text(), parse_constant=pytest.fail)
    assert content["levels"]["fraction"] == expected.tolist()
    assert (content["measure"], content["unit"]) == ("pga", "m s-2")
    assert content["curves"]["median_intensity"] == fragility["median_intensity"].values.tolist()
    mild = rocking.fragility(noise(1), blocks[1], intensity=[0.1, 0.2])
    rocking.suites.write_fragility(mild, tmp_path / "mild.json")  # a curve that does not exist is null
    assert json.loads((tmp_path / "mild.json").read_text())["curves"]["median_intensity"] == [None, None]
    with pytest.raises(InvalidArgumentError, match=r"\.csv"):
        rocking.suites.write_fragility(fragility, tmp_path / "curves.txt")
