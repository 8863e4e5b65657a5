"""What a run of the tests takes of long work: a part of it; `make test-all`, which sets FUZZ_ALL=1, takes all.

What is marked `long` is left out of a run; of an enumeration it tries a random sample, another one in each run.
A failure shows the seed of the sample, with which `FUZZ_SEED` repeats it.
"""

import os
import random
import sys
from collections.abc import Iterable, Sequence
from typing import Any, TypeVar

import pytest

Case = TypeVar("Case")

ALL = os.environ.get("FUZZ_ALL") == "1"
# the processes of one run have one seed, since all of them must collect the same tests
SEED = int(os.environ.get("FUZZ_SEED") or random.Random(os.environ.get("PYTEST_XDIST_TESTRUNUID")).randrange(1_000_000))


def sample(cases: Sequence[Case], count: int) -> list[Case]:
    """Return some of the cases, in their order; pytest shows the seed with the output of a test that fails."""
    if ALL:
        return [*cases]
    sys.stdout.write(f"FUZZ_SEED={SEED} repeats this sample\n")
    return [cases[k] for k in sorted(random.Random(SEED).sample(range(len(cases)), count))]


def number(few: Case, many: Case) -> Case:
    """A size of the work: how many random cases are tried, how far apart they are, or which of two is tried."""
    return many if ALL else few


def but_long(cases: Iterable[Any], *kept: Any) -> list[Any]:
    """Parameters of a test, of which a run without the long ones tries those that are kept."""
    found = [(case, case in kept) for case in cases]
    assert len(kept) == sum(known for _, known in found)
    return [case if known else pytest.param(case, marks=pytest.mark.long) for case, known in found]
