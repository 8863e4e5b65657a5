"""The mutation trial: which changes it makes, and that it distinguishes changes that a test notices from others."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from stress.mutations import AREAS, ROOT, draw_mutants, mutants_of

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


@pytest.mark.parametrize("area", AREAS, ids=lambda area: area.name)
def test_areas_name_existing_files_and_changes_are_valid_python(area) -> None:
    assert all(list(ROOT.glob(pattern)) for pattern in area.sources)
    assert all(list(ROOT.glob(pattern)) for pattern in (*area.first, *area.then))
    first, again = draw_mutants(area, 30, seed=1), draw_mutants(area, 30, seed=1)
    assert first == again
    assert len({(mutant.path, mutant.start) for mutant in first}) == 30
    for mutant in first:
        text = (ROOT / mutant.path).read_text()
        ast.parse(text[: mutant.start] + mutant.new + text[mutant.start + len(mutant.old) :])


def result_of_trial(folder: Path, timeout: int) -> str:
    """Return the result of the trial for the tests of a folder."""
    program = "import pathlib, sys; from stress.mutations import run_tests;  "
    program += "print(*run_tests(pathlib.Path(sys.argv[1]), ('.',), float(sys.argv[2])))"
    command = [sys.executable, "-c", program, str(folder), str(timeout)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()[0]


@pytest.mark.parametrize(("change", "expected"), [("x - low|x + low", "survived"), ("max|min", "noticed")])
def test_a_change_is_noticed_if_a_test_fails(tmp_path: Path, change: str, expected: str) -> None:
    (tmp_path / "source.py").write_text(SOURCE.replace(*change.split("|")))
    (tmp_path / "test_source.py").write_text(TEST)
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    assert result_of_trial(tmp_path, 60) == expected


def test_a_change_that_never_ends_is_a_timeout(tmp_path: Path) -> None:
    (tmp_path / "test_source.py").write_text("def test_waits():\n    while True:\n        pass\n")
    assert result_of_trial(tmp_path, 3) == "timeout"
