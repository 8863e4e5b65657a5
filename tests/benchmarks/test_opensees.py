"""The block of docs/other-software.md by OpenSees and by the package."""

import re
from pathlib import Path

import rocking

PAGE = (
    (Path(__file__).parents[2] / "docs" / "other-software.md")
    .read_text(encoding="utf-8")
    .partition("\n## Siconos\n")[0]
)
ROWS = re.findall(r"^\| (0\.\d) g \| (\S+) \| (\S+) .*\| (\S+) .*\| (\S+) .*\|$", PAGE, re.MULTILINE)


def test_the_page_states_what_the_package_gives_and_stiffer_bodies_are_nearer():
    assert len(ROWS) == 3
    block = rocking.Block(width=0.4, height=1.6)
    for level, ours, *theirs in ROWS:
        found = block.response("sine", peak_acceleration=f"{level} g", period=0.5, thresholds=False)
        if found.overturned:
            assert {ours, *theirs} == {"overturns"}
        else:
            assert ours == f"{float(found.peak_rotation):.3f}"
            differences = [float(one) - float(ours) for one in theirs]
            assert differences == sorted(differences, reverse=True)
            assert differences[-1] > 0.0
