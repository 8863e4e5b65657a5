"""Published numbers and ours agree, and the page shows the table that the generator prints."""

from pathlib import Path

import pytest

from benchmarks.accuracy.published import COMPARISONS, table
from benchmarks.accuracy.rock_assets import CRITICAL, critical

PAGE = Path(__file__).parents[2] / "docs" / "published-results.md"


@pytest.mark.parametrize("one", COMPARISONS, ids=lambda one: f"{one.source}: {one.quantity}")
def test_ours_is_the_published_number(one):
    assert one.ours() == pytest.approx(one.published, abs=one.tolerance)


def test_the_page_has_the_table():
    assert table() in PAGE.read_text(encoding="utf-8")


def test_the_critical_cosine_that_rock_assets_prints():
    """Eight digits were sought there with a relative tolerance of 1e-8 of the integration."""
    assert critical() == pytest.approx(CRITICAL, rel=1e-7)
