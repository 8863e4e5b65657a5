"""Runs the tests of the finished products (workflow/checks) and writes their results."""

import os
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from workflow.scripts.job import run


class Verdicts:
    """Collects the result of each test, without run times, so that equal runs give equal files."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" or report.outcome != "passed":
            self.lines.append(f"{report.outcome} {report.nodeid.partition('::')[2]}")


def main(*, manifest: Path, tests: Sequence[Path], report: Path, code: str) -> None:
    """Test the results beside `manifest`; write one line per test to `report` if all pass.

    The job fails if a test does.
    """
    os.environ["ROCKING_RESULTS"] = str(manifest.parent.resolve())
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"  # seconds for plugins that these tests do not use
    verdicts = Verdicts()
    files = [str(path) for path in tests if path.name.startswith("test_")]
    status = pytest.main(["-q", "-p", "no:cacheprovider", *files], plugins=[verdicts])
    if status != 0:
        sys.exit(f"the finished products failed their tests (pytest status {int(status)})")
    report.write_text("\n".join([*sorted(verdicts.lines), f"code {code}"]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    run(main, snakemake)  # noqa: F821  (given by Snakemake)
