"""What the checker of the CF conventions finds in a file."""

import warnings
from functools import cache
from pathlib import Path

from compliance_checker.runner import CheckSuite


@cache
def _suite() -> CheckSuite:
    suite = CheckSuite()
    suite.load_all_available_checkers()
    return suite


def complaints(path: Path, standard: str = "cf:1.11") -> list[str]:
    """Return all messages, recommendations included, as with `--criteria strict`."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the dependencies of the checker
        dataset = _suite().load_dataset(str(path))
        groups, errors = _suite().run_all(dataset, [standard])[standard]
        dataset.close()
    assert not errors
    return [message for group in groups if group.value[0] < group.value[1] for message in group.msgs]
