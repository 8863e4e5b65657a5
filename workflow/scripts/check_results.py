"""Runs the tests of the finished products, and joins their results with those of the data sets."""

from collections.abc import Sequence
from pathlib import Path

from workflow.checks.report import run_tests, write_report
from workflow.scripts.job import run


def main(*, manifest: Path, reports: Sequence[Path], report: Path, code: str) -> None:
    """Test the results beside `manifest`; write one line per test, also of the data sets (`reports`), if all pass.

    `code` is the digest of the tests and of all that they import.
    """
    lines = [line for path in reports for line in path.read_text(encoding="utf-8").splitlines()]
    lines += run_tests("test_products.py", {"ROCKING_RESULTS": str(manifest.parent.resolve())})
    write_report(report, [line for line in lines if not line.startswith("code ")], code)


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
