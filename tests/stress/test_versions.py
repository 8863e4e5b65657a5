"""The comparison of two versions finds what differs, and says what the rounding of the inputs explains."""

import json
import subprocess
import sys

import numpy as np
import pytest

import rocking
from rocking._base.source_tree import PROJECT
from stress.tree_worker import INPUTS, draw
from stress.versions import Tree, compare_chunk, summary, unexplained

CHUNK = {"pulse": "sine", "record": False, "rigid": False, "size": 400, "seed": [3, 0]}


class ChangedTree(Tree):
    """A version that finds another response of one cell, whenever the whole chunk is solved."""

    cell, changes = 0, {}

    def result(self):
        found, seconds = super().result()
        if found.size == CHUNK["size"]:
            found = found.copy()
            for name, value in self.changes.items():
                found[name][self.cell] = value
        return found, seconds


@pytest.fixture
def trees():
    made = [Tree(PROJECT), ChangedTree(PROJECT)]
    yield made
    for tree in made:
        tree.close()


def test_a_version_agrees_with_itself(trees):
    found = compare_chunk(CHUNK, trees)
    assert (found["cells"], found["equal_peaks"], found["outcomes"], found["impacts"]) == (400, 400, 0, 0)
    assert found["largest_change"] == found["largest_over_conditioning"] == 0.0
    assert found["differences"] == []


def test_another_outcome_is_not_explained_far_from_a_boundary(trees):
    trees[1].changes = {"outcome": 3, "peak_rotation": np.nan}
    (one,) = (found := compare_chunk(CHUNK, trees))["differences"]
    assert (found["outcomes"], found["impacts"], one["cell"], one["ulps"]) == (1, 0, 0, None)
    row = summary(CHUNK, [found | {"seed": CHUNK["seed"]}])
    assert unexplained(row) == [{"seed": [3, 0], **one}]


def test_a_difference_of_the_peak_is_measured_over_the_conditioning(trees):
    cells = dict(zip(INPUTS, draw(CHUNK), strict=True))
    peaks = rocking.peak_response("sine", **cells).peak_rotation
    trees[1].cell = int(np.nanargmax(peaks))  # the closest to overturning
    trees[1].changes = {"peak_rotation": np.nanmax(peaks) * (1.0 + 2.0**-43)}
    found = compare_chunk(CHUNK, trees)
    assert found["largest_change"] == pytest.approx(2.0**-43, rel=1e-2)
    assert found["equal_peaks"] == 399
    assert 0.0 < found["largest_over_conditioning"] < 512.0  # 2^10 roundings of a peak that is amplified


def test_a_comparison_is_continued(tmp_path):
    out, known = tmp_path / "versions.json", []
    for cells in ("1", "100001"):
        command = [sys.executable, "-m", "stress.versions", str(PROJECT), "--cells", cells, "--out", str(out)]
        done = subprocess.run(command, cwd=PROJECT, capture_output=True, text=True, check=True)
        chunks = json.loads(out.read_text())["chunks"]
        assert chunks[: len(known)] == known
        known = chunks
    assert len(known) == 2
    assert "| sine, rigid | 100000 | 100.0 % | 0.0e+00 | 0 | 0 | 0 | 0 |" in done.stdout
