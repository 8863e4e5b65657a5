"""Runs a module of tests in this process, and writes the result of each test."""

import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import pytest

from rocking._base.output_file import write_output


class Verdicts:
    """Collects the result of each test, without run times, so that equal runs give equal files."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.nodeid.endswith("[NOTSET]"):  # a test of files of which there are none
            return
        if report.when == "call" or report.outcome != "passed":
            self.lines.append(f"{report.outcome} {report.nodeid.partition('::')[2]}")


def run_tests(name: str, environment: Mapping[str, str]) -> list[str]:
    """Results of the tests of a module beside this one, one line each; the process ends if one fails."""
    os.environ.update(environment)
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"  # seconds for plugins that these tests do not use
    verdicts = Verdicts()
    status = pytest.main(["-q", "-p", "no:cacheprovider", str(Path(__file__).with_name(name))], plugins=[verdicts])
    if status != 0:
        sys.exit(f"the finished products failed their tests (pytest status {int(status)})")
    return verdicts.lines


def write_report(report: Path, lines: Iterable[str], code: str) -> None:
    """Write the results of tests and the digest of their code."""
    write_output(report, "\n".join([*sorted(lines), f"code {code}"]) + "\n")
