"""Parts of long enumerations: a run of the tests takes a random sample, `make test-all` all.

Each run draws another sample, so that many runs together cover the whole. A failure shows its seed, with which
`FUZZ_SEED` repeats the sample; FUZZ_ALL=1 takes all.
"""

import os
import random
import sys
from collections.abc import Sequence
from typing import TypeVar

Case = TypeVar("Case")

ALL = os.environ.get("FUZZ_ALL") == "1"
SEED = int(os.environ.get("FUZZ_SEED") or random.SystemRandom().randrange(1_000_000))


def sample(cases: Sequence[Case], count: int) -> list[Case]:
    """Return some of the cases, in their order; pytest shows the seed with the output of a test that fails."""
    if ALL:
        return [*cases]
    sys.stdout.write(f"FUZZ_SEED={SEED} repeats this sample\n")
    return [cases[k] for k in sorted(random.Random(SEED).sample(range(len(cases)), count))]
