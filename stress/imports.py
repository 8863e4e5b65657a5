"""Which modules a test imports, and through how many others: read from the source text, nothing is executed."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from rocking._base.source_tree import imported_names


class ImportGraph:
    """The imports between the Python files of a tree.

    Parameters
    ----------
    root : Path
        Folder that holds the packages; those of `api/` are found as well.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        self._public = dict(
            name for stub in sorted(root.glob("rocking/**/__init__.pyi")) for name in _public(root, stub)
        )
        self._packages = {place.name for place in (*root.iterdir(), *root.glob("api/*")) if place.is_dir()}
        self.imports = cache(self._imports)

    def distances(self, path: Path) -> dict[Path, int]:
        """All files that a file imports, each with the length of the shortest chain of imports, 1 for its own ones.

        A test also imports the `conftest.py` of its folder.
        """
        found, wave = {path: 0}, [path]
        while wave:
            following = dict.fromkeys(file for one in wave for file in self.imports(one) if file not in found)
            found |= dict.fromkeys(following, found[wave[0]] + 1)
            wave = list(following)
        return found

    def _imports(self, path: Path) -> set[Path]:
        files = {file for name in _names(ast.parse(path.read_bytes())) if (file := self._file(name)) is not None}
        beside = path.with_name("conftest.py")
        return files | ({beside} if path.name.startswith("test_") and beside.exists() else set())

    def _file(self, name: str) -> Path | None:
        """The file of a dotted name: a module, or the module that defines it."""
        while name.partition(".")[0] in self._packages:
            name = self._public.get(name, name)
            for folder in (self.root, self.root / "api"):
                place = folder.joinpath(*name.split("."))
                for file in (place.with_suffix(".py"), place / "__init__.py"):
                    if file.is_file():
                        return file
            name = name.rpartition(".")[0]
        return None


def _public(root: Path, stub: Path) -> Iterator[tuple[str, str]]:
    """The names that a package loads lazily, and where they are defined."""
    package = ".".join(stub.parent.relative_to(root).parts)
    for name, base, _ in imported_names(ast.parse(stub.read_bytes())):
        if base:
            yield f"{package}.{name}", f"{package}.{base}"


def _names(tree: ast.Module) -> Iterator[str]:
    """The dotted names that a file imports, and those that it looks up in what it imports."""
    imported: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            base = f"{node.module}." if isinstance(node, ast.ImportFrom) else ""
            imported |= {one.asname or one.name: base + one.name for one in node.names}
    yield from imported.values()
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in imported:
            yield f"{imported[node.value.id]}.{node.attr}"
