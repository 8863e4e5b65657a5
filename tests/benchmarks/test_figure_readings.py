"""Numbers read off the figures agree with the multi-precision integrator."""

from pathlib import Path

from benchmarks.accuracy.figure_readings import STEP, readings
from tests.workflow_fixtures import PROJECT


def test_numbers_read_off_the_figures_agree_with_the_reference(smoke_results: Path) -> None:
    found = [*readings(smoke_results / "figures")]
    assert len(found) >= 35  # the smallest configuration has fewer panels
    for one in found:
        sampled = "sampled" in one.quantity
        assert one.difference <= (1e-3 if sampled else STEP), one
        if one.quantity == "peak":
            assert one.difference < 1e-12, one
    assert {one.figure for one in found} >= {str(n) for n in range(1, 14)} | {"S1", "scale-law"}


def test_the_documentation_has_forty_readings() -> None:
    table = (PROJECT / "docs/figures.md").read_text(encoding="utf-8").split("## Numbers read off the figures")[1]
    rows = [line.split(" | ") for line in table.splitlines() if line.startswith("| ")][1:]
    assert len(rows) >= 40
    assert all(float(row[-1].rstrip("| ")) <= (1e-3 if "sampled" in row[1] else STEP) for row in rows)
