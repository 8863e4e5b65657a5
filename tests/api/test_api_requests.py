"""Random requests to all routes."""

import asyncio

import pytest

from tests.api.fuzzer import EXTREME_KINDS, ask_all
from tests.sampling import number


@pytest.mark.alone
@pytest.mark.slow
def test_random_requests(results):
    statuses, faults = asyncio.run(ask_all(results, seed=2, first=0, count=number(150, 5000)))
    assert not faults
    assert {"200", "304", "404", "405", "413", "415", "422"} <= set(statuses)


@pytest.mark.alone
@pytest.mark.slow
def test_extreme_numbers_and_steps_long_tables_and_arithmetic_in_units(results):
    statuses, faults = asyncio.run(ask_all(results, seed=1, first=0, count=number(150, 9000), kinds=EXTREME_KINDS))
    assert not faults
    assert {"200", "422"} <= set(statuses)
