"""The ledger docs/equations.md is complete: functions can be imported, tests exist, numbers are in the code."""

import ast
import importlib
import re
from functools import cache
from pathlib import Path
from pkgutil import resolve_name

import pytest

from workflow.claims.table import read_misprints

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "equations.md").read_text()
NUMBERS = [
    *(f"2.{n}" for n in range(1, 5)),
    *(f"3.{n}" for n in range(1, 32)),
    *(f"4.{n}" for n in range(1, 17)),
    *(f"5.{n}" for n in range(1, 4)),
    "6.1",
    *(f"A {n}" for n in range(1, 5)),
]
NUMERIC_ONLY = {"2.1", "2.3", "3.1", "3.2", "4.2", "4.3", "4.10", "4.11", "5.1", "5.2"}
"""Equations of motion, definitions and statements that no single line of the named modules computes."""


def table(columns: int, heading: str) -> list[list[str]]:
    section = PAGE.split(f"## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("| ")][1:]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    assert all(len(row) == columns for row in rows)
    return rows


LEDGER = table(5, "Ledger")
SLIPS = table(5, "Slips in the paper's text")
QUOTED = sorted(set(re.findall(r"`([^`]+)`", PAGE)))
NAMES = [q for q in QUOTED if q.startswith("rocking.")]
TESTS = [q for q in QUOTED if q.startswith("tests/")]


def defining_file(name: str) -> Path:
    found = resolve_name(name)
    definition = found.fget if isinstance(found, property) else found
    module = getattr(definition, "__module__", None) or name.rsplit(".", 1)[0]
    return Path(str(importlib.import_module(module).__file__))


@cache
def functions_of(path: str) -> set[str]:
    return {node.name for node in ast.walk(ast.parse((ROOT / path).read_text())) if isinstance(node, ast.FunctionDef)}


def test_every_numbered_equation_has_one_row_in_order():
    assert [row[0].strip("()") for row in LEDGER] == NUMBERS


def test_the_page_quotes_functions_and_tests_only():
    assert set(QUOTED) == {*NAMES, *TESTS}


@pytest.mark.parametrize("name", NAMES)
def test_name_imports(name):
    assert resolve_name(name) is not None


def test_named_tests_exist():
    named = [test.split("::") for test in TESTS]
    assert [(path, function) for path, function in named if function not in functions_of(path)] == []


@pytest.mark.parametrize("row", [r for r in LEDGER if r[0].strip("()") not in NUMERIC_ONLY], ids=lambda r: r[0])
def test_each_number_is_in_the_code(row):
    files = {defining_file(name) for name in re.findall(r"`([^`]+)`", row[2])}
    sources = {file for path in files for file in (path.parent.glob("*.py") if path.stem == "__init__" else [path])}
    assert any(row[0] in source.read_text() for source in sources), f"{row[0]} in none of {sorted(sources)}"


def test_one_row_for_each_slip():
    assert [int(row[0]) for row in SLIPS] == list(range(1, 17))
    for _, where, printed, right, test in SLIPS:
        assert where
        assert printed != right
        assert "`tests/paper/test_errata.py::" in test


def test_table_of_misprints_has_the_same_rows():
    assert [[*misprint.values()] for misprint in read_misprints(ROOT / "docs" / "equations.md")] == [
        row[1:] for row in SLIPS
    ]
