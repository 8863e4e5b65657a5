"""The amplification against that of the reference table, and at the limits of its kinds."""

import numpy as np
import pytest

from rocking.suites import record_amplification
from tests.solver.records.tables import Row, record, rows

KNOWN = [row for row in rows() if 0.1 < row.amplification < 1e2]


@pytest.mark.parametrize("row", KNOWN[::6], ids=[str(k) for k in range(0, len(KNOWN), 6)])
def test_the_amplification_is_that_of_the_table(row: Row) -> None:
    assert float(record_amplification(row.motion, **row.groups)) == pytest.approx(row.amplification, rel=0.02)


def test_overturning_and_resting_blocks_have_none() -> None:
    motion = record("napa_HNE", 0.005)
    found = record_amplification(motion, frequency_parameter=2.2, slenderness=[0.2, 0.45, 1.5], restitution=0.9)
    np.testing.assert_array_equal(np.isnan(found), [True, False, True])


def test_a_change_of_the_outcome_within_the_difference_is_infinite() -> None:
    motion = record("napa_HNE", 0.005)
    found = record_amplification(motion, frequency_parameter=2.2, slenderness=1.0, restitution=0.9)
    assert np.isinf(found)
