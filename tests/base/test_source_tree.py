"""Digests of code change if and only if a dependency of the result changes."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from rocking._base.source_tree import SourceTree, imported_names

TREE = {
    "rocking/__init__.py": "import lazy_loader",
    "rocking/__init__.pyi": "",
    "rocking/a.py": "import math\nfrom rocking.b import x",
    "rocking/b.py": "from rocking.group import y",
    "rocking/c.py": "",
    "rocking/group/__init__.py": "from rocking.group.inner import y",
    "rocking/group/inner.py": "y = 1",
    "rocking/group/other.py": "",
    "rocking/lazy/__init__.py": "import lazy_loader",
    "rocking/lazy/__init__.pyi": "from .one import name as name",
    "rocking/lazy/one.py": "name = 1",
    "rocking/lazy/two.py": "",
    "script.py": "from rocking import a",
    "lazy.py": "from rocking import peak_response",
    "nested.py": "import rocking.group.other",
    "lazy_name.py": "from rocking.lazy import name",
    "lazy_module.py": "from rocking.lazy.one import name",
}

GROUP = {"rocking/group/__init__.py", "rocking/group/inner.py"}


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name, text in TREE.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("script.py", {"script.py", "rocking/a.py", "rocking/b.py", *GROUP}),
        ("nested.py", {"nested.py", "rocking/group/other.py", *GROUP}),
        ("lazy.py", {"lazy.py", *(name for name in TREE if name.startswith("rocking/") and name.endswith(".py"))}),
        ("lazy_name.py", {"lazy_name.py", *(f"rocking/lazy/{name}.py" for name in ("__init__", "one", "two"))}),
        ("lazy_module.py", {"lazy_module.py", *(f"rocking/lazy/{name}.py" for name in ("__init__", "one"))}),
    ],
)  # fmt: skip
def test_imports_are_followed(tree: Path, script: str, expected: set[str]) -> None:
    files = SourceTree(tree).files(tree / script)
    assert {path.relative_to(tree).as_posix() for path in files} == expected


def test_imports_are_followed_to_the_packages_of_the_tree_alone(tree: Path) -> None:
    (tree / "numba").mkdir()
    (tree / "numba/__init__.py").write_text("import rocking.c")
    (tree / "rocking/b.py").write_text("import numba\nfrom numba import njit\nimport numba.np.linalg")
    everything = SourceTree(tree).files(tree / "rocking/a.py")
    assert {tree / "numba/__init__.py", tree / "rocking/c.py"} < {*everything}
    assert SourceTree(tree, {"rocking"}).files(tree / "rocking/a.py") == [tree / "rocking/a.py", tree / "rocking/b.py"]


def test_digest_depends_on_imported_files_and_the_lock_only(tree: Path) -> None:
    first = SourceTree(tree).digest(tree / "script.py")
    (tree / "rocking/c.py").write_text("unrelated = 1")
    assert SourceTree(tree).digest(tree / "script.py") == first
    (tree / "rocking/group/inner.py").write_text("y = 2")
    second = SourceTree(tree).digest(tree / "script.py")
    assert second != first
    (tree / "environment.lock").write_text("numpy==2.4.6")
    assert SourceTree(tree).digest(tree / "script.py") != second


def test_digest_is_independent_of_the_folder(tree: Path, tmp_path: Path) -> None:
    moved = tmp_path / "elsewhere"
    for name, text in TREE.items():
        (moved / name).parent.mkdir(parents=True, exist_ok=True)
        (moved / name).write_text(text)
    assert SourceTree(moved).digest(moved / "script.py") == SourceTree(tree).digest(tree / "script.py")


@pytest.mark.parametrize(
    "around",
    [
        "if x:\n {}",
        "if x:\n pass\nelif y:\n {}",
        "for x in y:\n pass\nelse:\n {}",
        "while x:\n {}",
        "with x:\n {}",
        "try:\n {}\nfinally:\n pass",
        "try:\n pass\nexcept x:\n {}",
        "try:\n pass\nexcept* x:\n {}",
        "try:\n pass\nfinally:\n {}",
        "match x:\n case 1:\n  {}",
        "class X:\n async def f():\n  async with x:\n   {}",
        "def f():\n async def g():\n  async for x in y:\n   {}",
    ],
)
def test_imports_in_any_block_are_found(around: str) -> None:
    assert [*imported_names(ast.parse(around.format("from .a import b")))] == [("b", "a", 1)]
    assert [*imported_names(ast.parse(around.format("f = lambda: x if y else z")))] == []
