"""The comparison with `rock.assets`: the number that its page prints, and the reading of a figure."""

import pytest

from benchmarks.accuracy.rock_assets import CRITICAL, critical


def test_the_printed_critical_cosine():
    """Eight digits were sought there with a relative tolerance of 1e-8 of the integration."""
    assert critical() == pytest.approx(CRITICAL, rel=1e-7)
