"""The solver compiled by the public interface of numba agrees with the references as well."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.sampling import ALL

ROOT = Path(__file__).parents[2]

ESSENTIAL = (
    (
        "tests/base/test_simd.py",
        "tests/solver/test_against_tables.py",
        "tests/solver/records/test_against_table.py",
    )
    if ALL
    else (
        "tests/base/test_simd.py::test_functions_are_accurate_to_rounding",
        "tests/solver/records/test_against_table.py::test_outcome_and_peak_of_each_case[0]",
    )
)
"""A sample: vectors, slender blocks under records; `make test-all` runs all. The time is that of the compiler."""

WITHOUT_COLLECTION = "import gc, sys, pytest; gc.disable(); sys.exit(pytest.main(sys.argv[1:]))"
"""A seventh of the time of the compiler is a search for garbage among what it keeps."""


@pytest.mark.long
def test_the_solver_agrees_with_its_references_without_private_names_of_numba(tmp_path):
    variables = {"ROCKING_PLAIN_NUMBA": "1", "NUMBA_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", WITHOUT_COLLECTION, "-q", "-p", "no:cacheprovider", *ESSENTIAL]
    done = subprocess.run(command, cwd=ROOT, env=os.environ | variables, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
