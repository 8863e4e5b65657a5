"""The comparison of checks by standards with exact outcomes, on one motion."""

import re
from pathlib import Path

import numpy as np
from rocking_assessment._objects.columns import CLAUSES

from benchmarks.accuracy.record_sampling import FILES
from benchmarks.accuracy.standards import counts, main, measured

PAGE = (Path(__file__).parents[2] / "docs/assessment/checks.md").read_text()


def test_each_case_is_counted_once_and_drawn(tmp_path, capsys):
    """Levels from no uplift to overturning; the static check is never unsafe without vertical motion."""
    table = measured(FILES[2:3], [0.02, 1.0])
    found = counts(table)
    fell = table["overturned"]
    assert not table["uplifts"][table["pga"] == 0.02].any()
    assert 0 < fell.sum() < len(table)
    for name in CLAUSES:
        right = ((table[name] < 1) != fell).sum()
        assert right + found.loc[name, "unsafe"] + found.loc[name, "conservative"] == len(table)
    assert found.loc["static", "unsafe"] == 0
    np.testing.assert_allclose(table["circolare_linear"], table["static"] / 2)
    main(["--files", str(FILES[2]), "--levels", "0.02", "--figure", str(tmp_path / "one.png")])
    assert "120 cases, 0 uplift, 0 overturn" in capsys.readouterr().out
    assert (tmp_path / "one.png").stat().st_size > 10_000


def test_the_page_has_a_row_for_each_clause():
    """With the names of the option `standards`."""
    assert re.findall(r"^\| `(\w+)`", PAGE, re.MULTILINE) == list(CLAUSES)
