"""The block of docs/other-software.md by Siconos and by the package."""

import re
from pathlib import Path

import pytest

import rocking
from benchmarks.accuracy import siconos
from rocking._base.constants import STANDARD_GRAVITY

PAGE = (
    (Path(__file__).parents[2] / "docs" / "other-software.md")
    .read_text(encoding="utf-8")
    .partition("\n## Siconos\n")[2]
)
ROWS = re.findall(r"^\| (0\.\d) g \| (\S+) \| (\S+) .*\| (\S+) .*\| (\S+) .*\|$", PAGE, re.MULTILINE)
THRESHOLDS = re.search(r"^\| lowest threshold \| (\S+) g \| (\S+) g .*\| (\S+) g .*\|", PAGE, re.MULTILINE)


@pytest.fixture(scope="module")
def block():
    return rocking.Block(width=siconos.WIDTH, height=siconos.HEIGHT)


def test_the_page_states_what_the_package_gives_and_shorter_steps_are_nearer(block):
    assert [float(level) for level, *_ in ROWS] == list(siconos.LEVELS)
    for level, ours, *theirs in ROWS:
        found = block.response("sine", peak_acceleration=f"{level} g", period=siconos.PERIOD, thresholds=False)
        if found.overturned:
            assert {ours, *theirs} == {"overturns"}
        else:
            assert ours == f"{float(found.peak_rotation):.4f}"
            differences = [abs(float(one) - float(ours)) for one in theirs]
            assert differences == sorted(differences, reverse=True)
            assert differences[-1] < 2e-3 * float(ours)


def test_the_threshold_of_the_page_and_that_of_shorter_steps_is_nearer(block):
    assert THRESHOLDS is not None
    ours, coarse, fine = (float(one) for one in THRESHOLDS.groups())
    found = block.response("sine", peak_acceleration="0.3 g", period=siconos.PERIOD).thresholds.lowest
    assert ours == pytest.approx(found / STANDARD_GRAVITY, abs=5e-5)
    assert abs(fine - ours) < abs(coarse - ours)
