"""The mutation trial: which changes it makes, and that it distinguishes changes that a test notices from others."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from stress.imports import ImportGraph
from stress.mutations import ROOT, imported_by_tests, modules, mutants_of

SOURCE = """def clipped(x: float, low: float = 0.0) -> float:
    if x < low and low != 1:
        return -low
    return max(x - low, low)
"""
TEST = """from source import clipped


def test_clipped():
    assert clipped(3.0) == 3.0
"""


def changed(path: Path) -> set[str]:
    text = path.read_text()
    found = mutants_of(path)
    assert all(text[m.start : m.start + len(m.old)] == m.old for m in found)
    return {text[: m.start] + m.new + text[m.start + len(m.old) :] for m in found}


def test_every_operator_constant_and_sign_is_changed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("stress.mutations.ROOT", tmp_path)
    (tmp_path / "source.py").write_text(SOURCE)
    expected = [
        ("= 0.0", "= 1.0"),
        ("x < low", "x <= low"),
        ("x < low", "x >= low"),
        (" and ", " or "),
        ("!= 1", "== 1"),
        ("!= 1", "!= 0"),
        ("!= 1", "!= 2"),
        ("-low", "low"),
        ("max", "min"),
        ("x - low", "x + low"),
    ]
    assert changed(tmp_path / "source.py") == {SOURCE.replace(old, new) for old, new in expected}


TREE = {
    "rocking/__init__.py": "",
    "rocking/__init__.pyi": "from .inner.a import f as f\nfrom . import inner as inner\n",
    "rocking/inner/__init__.py": "",
    "rocking/inner/a.py": "from rocking.inner.b import g",
    "rocking/inner/b.py": "",
    "api/service/app.py": "import rocking.inner.b",
    "tests/helper.py": "from rocking.inner import a as one\none.x",
    "tests/test_public.py": "import rocking\nrocking.f(1)",
    "tests/test_helper.py": "import numpy as np\nfrom tests.helper import cell",
    "tests/api/conftest.py": "from service import app",
    "tests/api/test_service.py": "",
}


def test_imports_are_counted_through_public_names_helpers_and_fixtures(tmp_path: Path) -> None:
    for name, text in TREE.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    graph = ImportGraph(tmp_path)
    a, b = tmp_path / "rocking/inner/a.py", tmp_path / "rocking/inner/b.py"
    found = [
        graph.distances(tmp_path / f"tests/{name}.py") for name in ("test_public", "test_helper", "api/test_service")
    ]
    assert [one.get(a) for one in found] == [1, 2, None]
    assert [one.get(b) for one in found] == [2, 3, 3]


def test_tests_of_each_module_are_those_that_import_it() -> None:
    imported = imported_by_tests(ROOT)
    assert imported["tests/model/test_masonry_arch.py"]["rocking/_model/linkage.py"] == 1
    known = {module for found in imported.values() for module in found}
    missing = {path.relative_to(ROOT).as_posix() for path in modules(["rocking", "api/rocking_api"])} - known
    by_name = {"__main__.py", "mesh_process.py", "sheet_process.py", "server.py"}  # of processes that tests start
    assert {Path(path).name for path in missing} <= {"__init__.py", *by_name}  # docstrings


TREES = {
    "survived": {"source.py": SOURCE.replace("x - low", "x + low"), "test_source.py": TEST, "pytest.ini": "[pytest]\n"},
    "noticed": {"source.py": SOURCE.replace("max", "min"), "test_source.py": TEST, "pytest.ini": "[pytest]\n"},
    "timeout": {"test_source.py": "def test_waits():\n    while True:\n        pass\n"},
}
"""Files by the result of their tests: a change that no test notices, one that a test does, one that never ends."""

TRIALS = """
import pathlib, sys
from stress.mutations import run_tests
for folder in map(pathlib.Path, sys.argv[1:]):
    print(run_tests(folder, ('.',), 3.0 if folder.name == "timeout" else 60.0)[0])
"""


def test_a_change_is_noticed_if_a_test_fails_or_does_not_end(tmp_path: Path) -> None:
    """In one process, as a trial is: it loads the libraries once, and here no plugins."""
    for name, files in TREES.items():
        (tmp_path / name).mkdir()
        for file, text in files.items():
            (tmp_path / name / file).write_text(text)
    command = [sys.executable, "-c", TRIALS, *(str(tmp_path / name) for name in TREES)]
    environment = os.environ | {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split() == [*TREES]
