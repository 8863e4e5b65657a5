"""Extreme numbers in Python and on the command line, in a process of its own with 2 GB."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.sampling import ALL, SEED, number

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="limits the memory of a process as Linux does")
@pytest.mark.parametrize("part", number(["all"], ["python", "commands"]))
def test_every_number_is_answered_or_refused(results, part):
    argv = [sys.executable, "-m", "tests.api.extreme_numbers", str(results), "--part", part]
    argv += [] if ALL else ["--sample", str(SEED)]
    done = subprocess.run(argv, cwd=ROOT, capture_output=True, text=True, check=False, timeout=1200)
    assert done.returncode == 0, f"{argv[2:]}\n{done.stdout[-5000:]}{done.stderr[-2000:]}"
    assert " answered" in done.stdout
