"""The mutation trial finds tests for every module."""

from pathlib import Path

import pytest

from stress.mutations import ROOT, imported_by_tests, modules


@pytest.mark.long
def test_tests_of_each_module_are_those_that_import_it() -> None:
    imported = imported_by_tests(ROOT)
    assert imported["tests/model/test_masonry_arch.py"]["rocking/_model/linkage.py"] == 1
    known = {module for found in imported.values() for module in found}
    missing = {path.relative_to(ROOT).as_posix() for path in modules(["rocking", "api/rocking_api"])} - known
    by_name = {"__main__.py", "mesh_process.py", "sheet_process.py", "server.py"}  # of processes that tests start
    assert {Path(path).name for path in missing} <= {"__init__.py", *by_name}  # docstrings
