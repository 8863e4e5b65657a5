"""Random layouts of files of records and traces: what is read is the truth, or it is refused with the reason."""

import pytest

from tests.excitation.dialects import run
from tests.sampling import SEED, number

CASES = number(100, 10_000)


@pytest.mark.parametrize("seed", [1, SEED], ids=["stored", "drawn"])  # processes of one run draw different seeds
def test_no_dialect_is_read_as_another_motion(seed):
    """The seed is in a failure."""
    assert run(CASES, seed) > 0.9 * CASES  # with all that a person who knows the file may state
