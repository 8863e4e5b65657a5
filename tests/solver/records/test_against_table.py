"""Every case of the reference table: outcome, and the peak within what the rounding of the input explains."""

import numpy as np
import pytest

import rocking
from tests.solver.records.tables import Row, rows

ROUNDING = 2.2e-16
ROWS = rows()


@pytest.mark.parametrize("row", ROWS, ids=[str(k) for k in range(len(ROWS))])
def test_outcome_and_peak_of_each_case(row: Row) -> None:
    response = rocking.peak_response(row.motion, **row.groups)
    assert bool(response.overturned) == row.overturned
    if row.overturned:
        assert np.isnan(response.peak_rotation)
    elif np.isnan(row.amplification):
        # the response depends on the last bits of the input: the outcome is still right
        assert response.outcome == rocking.Outcome.RECOVERS
    else:
        allowed = 1000 * ROUNDING * max(1.0, row.amplification)
        assert float(response.peak_rotation) == pytest.approx(row.peak_rotation, rel=allowed)
