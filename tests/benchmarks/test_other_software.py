"""The blocks of docs/other-software.md by OpenSees, by Siconos and by the package."""

import re
from pathlib import Path

import pytest

import rocking
from benchmarks.accuracy import siconos
from rocking._base.constants import STANDARD_GRAVITY

PAGE = (Path(__file__).parents[2] / "docs" / "other-software.md").read_text(encoding="utf-8")
OPENSEES, _, SICONOS = PAGE.partition("\n## Siconos\n")
ROW = re.compile(r"^\| (0\.\d) g \| (\S+) \| (\S+) .*\| (\S+) .*\| (\S+) .*\|$", re.MULTILINE)
BLOCK = rocking.Block(width=siconos.WIDTH, height=siconos.HEIGHT)
CASES = {"OpenSees": (OPENSEES, rocking.Block(width=0.4, height=1.6), 0.5), "Siconos": (SICONOS, BLOCK, siconos.PERIOD)}


@pytest.mark.parametrize("name", CASES)
def test_the_page_states_what_the_package_gives_and_finer_models_are_nearer(name):
    text, block, period = CASES[name]
    rows = ROW.findall(text)
    assert len(rows) == 3 if name == "OpenSees" else [float(row[0]) for row in rows] == list(siconos.LEVELS)
    for level, ours, *theirs in rows:
        found = block.response("sine", peak_acceleration=f"{level} g", period=period, thresholds=False)
        if found.overturned:
            assert {ours, *theirs} == {"overturns"}
        else:
            assert float(ours) == pytest.approx(float(found.peak_rotation), abs=0.5 * 10.0 ** -len(ours.split(".")[1]))
            differences = [abs(float(one) - float(ours)) for one in theirs]
            assert differences == sorted(differences, reverse=True)
            assert name == "OpenSees" or differences[-1] < 2e-3 * float(ours)


def test_the_threshold_of_the_page_and_that_of_shorter_steps_is_nearer():
    stated = re.search(r"^\| lowest threshold \| (\S+) g \| (\S+) g .*\| (\S+) g .*\|", SICONOS, re.MULTILINE)
    assert stated is not None
    ours, coarse, fine = (float(one) for one in stated.groups())
    found = BLOCK.response("sine", peak_acceleration="0.3 g", period=siconos.PERIOD).thresholds.lowest
    assert ours == pytest.approx(found / STANDARD_GRAVITY, abs=5e-5)
    assert abs(fine - ours) < abs(coarse - ours)
