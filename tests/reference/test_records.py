"""The multi-precision integration under records: against the table of another one; the solver against it."""

import math

import numpy as np
import pytest

from reference.exact_response import working_precision
from reference.records import BITS, integrate_record, response_and_amplification
from stress.records import judge, random_case, summary
from tests.sampling import number
from tests.solver.records.tables import rows


@pytest.mark.parametrize("k", [8, 40, 63, 116, 181])
def test_cases_of_the_table(k: int) -> None:
    row = rows()[k]
    groups = row.groups | {"alpha": row.groups["alpha"] or None}
    with working_precision(BITS):
        response = integrate_record(row.motion.acceleration.tolist(), row.motion.time_step, **groups)
    assert response.overturned == row.overturned
    if not row.overturned:
        rounding = 1e-14 * max(1.0, row.amplification)  # the samples in m/s2 are rounded
        assert float(response.peak_rotation) == pytest.approx(row.peak_rotation, rel=rounding)


def test_the_amplification_of_a_small_single_flight_follows_from_its_threshold() -> None:
    """A triangle of height just above 1: the peak grows with a power of the excess, so the amplification is large."""
    found = [
        response_and_amplification([0.0, 1.0, 0.0], 0.5, frequency_parameter=1.0, slenderness=s, restitution=0.0)[1]
        for s in (0.9, 0.99)
    ]
    assert 1.0 < found[0] < found[1]
    assert found[1] / found[0] == pytest.approx(0.1 / 0.01, rel=0.3)


def test_random_cases() -> None:
    """`python -m stress.records` runs a thousand."""
    found = summary([judge(*random_case(seed)) for seed in range(number(5, 50))])
    assert found["wrong"] == 0
    assert found["overturned"] > 0
    assert found["largest error over allowed"] < 0.1


def test_the_random_cases_include_the_extremes_of_restitution() -> None:
    restitutions = np.array([random_case(seed)[1]["restitution"] for seed in range(200)], dtype=np.float64)
    assert (restitutions == 0.0).any()
    assert (restitutions == 1.0).any()
    assert not math.isnan(restitutions.sum())
