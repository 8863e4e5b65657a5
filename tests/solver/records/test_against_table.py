"""Every case of the reference table: outcome, peak within what the rounding of the input explains, amplification."""

import numpy as np
import pytest

import rocking
from rocking._solver.bodies import solve_with_bound
from rocking._solver.records.record_response import check_record_groups
from rocking._solver.state import block_cells
from rocking.suites import record_amplification
from tests.solver.records.tables import Row, record, rows

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


def test_the_error_of_each_peak_is_within_its_bound() -> None:
    """The bound of `BodyResponse.error_bound`, on the cells of the table."""
    errors = []
    for row in ROWS:
        if row.overturned:
            continue
        arguments = {"alpha": None, "vertical_scale": None} | row.groups
        groups = {name: np.atleast_1d(value) for name, value in check_record_groups(row.motion, **arguments).items()}
        cells = block_cells(
            groups["frequency_parameter"] * row.motion.time_step,
            groups["slenderness"],
            groups["restitution"],
            groups["alpha"],
            groups["vertical_scale"],
        )
        records, _, bound = solve_with_bound(row.motion, cells, None, None)
        errors.append(abs(records["peak_rotation"][0] - row.peak_rotation) - bound[0])
    assert len(errors) > 100
    assert max(errors) <= 0.0


SENSITIVE = [row for row in ROWS if 0.1 < row.amplification < 1e2]


@pytest.mark.parametrize("row", SENSITIVE[::6], ids=[str(k) for k in range(0, len(SENSITIVE), 6)])
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
