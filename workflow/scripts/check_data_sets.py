"""Runs the tests of the data sets of a pulse."""

import json
from collections.abc import Sequence
from pathlib import Path

from workflow.checks.report import run_tests, write_report
from workflow.scripts.job import run


def main(*, boundaries: Sequence[Path], cubes: Sequence[Path], errors: Path, report: Path, code: str) -> None:
    """Test the files `results/KIND/PULSE/` of a pulse; write one line per test if all pass.

    `code` is the digest of the tests and of all that they import.
    """
    results = boundaries[0].parents[2]
    names = [path.relative_to(results).as_posix() for path in (*boundaries, *cubes, errors)]
    lines = run_tests(
        "test_data_sets.py", {"ROCKING_RESULTS": str(results.resolve()), "ROCKING_DATA_SETS": json.dumps(names)}
    )
    write_report(report, lines, code)


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
