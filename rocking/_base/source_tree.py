"""The Python files that a module imports, directly or indirectly, and digests of them.

The imports are read from the syntax tree of the source text: nothing is executed.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Collection, Iterable
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
"""Folder of the package and, in a checkout, of `workflow/` and `environment.lock`; in an installation of all others."""

_BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")  # attributes of statements that hold statements


class SourceTree:
    """The Python files of a folder as they are now: each is read once, for any number of digests.

    `root` holds the files and the lock; absolute imports are resolved from it. Imports are followed into `packages`
    only, by default into all: an installation has the packages of others beside this one.
    """

    def __init__(self, root: Path, packages: Collection[str] | None = None) -> None:
        self.root = root.resolve()
        self._packages = packages
        self._contents: dict[Path, bytes] = {}
        self._syntax: dict[Path, ast.Module] = {}
        self._imported: dict[Path, list[Path]] = {}

    def package(self) -> list[Path]:
        """Return all files of the package, sorted."""
        return sorted((self.root / "rocking").rglob("*.py"))

    def files(self, *paths: Path) -> list[Path]:
        """Return these files and all files of `packages` that they import, directly or indirectly; sorted.

        A package with an `__init__.pyi` loads its names lazily. Importing a module through it does not add a dependency
        on every public name; importing a name that is not a module does, and then all its files are included.
        """
        seen: set[Path] = set()
        waiting = [path.resolve() for path in paths]
        while waiting:
            path = waiting.pop()
            if path not in seen:
                seen.add(path)
                waiting += self._imports(path)
        return sorted(seen)

    def digest(self, *paths: Path) -> str:
        """Return the sha256 (hex) of `files(*paths)`, by default of the package, and of `environment.lock` if there."""
        files = self.files(*(paths or self.package()))
        lock = self.root / "environment.lock"
        if lock.exists():
            files.append(lock)
        return self.digest_of(files)

    def digest_of(self, files: Iterable[Path]) -> str:
        """Return the sha256 (hex) of the names below `root` and the contents of these files alone."""
        digest = hashlib.sha256()
        for path in files:
            content = self.content(path)
            digest.update(f"{path.relative_to(self.root).as_posix()} {len(content)}\n".encode())
            digest.update(content)
        return digest.hexdigest()

    def content(self, path: Path) -> bytes:
        """Return the bytes of a file."""
        if path not in self._contents:
            self._contents[path] = path.read_bytes()
        return self._contents[path]

    def syntax(self, path: Path) -> ast.Module:
        """Return the syntax tree of a file."""
        if path not in self._syntax:
            self._syntax[path] = ast.parse(self.content(path))
        return self._syntax[path]

    def _imports(self, path: Path) -> list[Path]:
        if path not in self._imported:
            files: set[Path] = set()
            for name, attribute_of in _absolute_names(path.relative_to(self.root), self.syntax(path)):
                if self._packages is None or name.partition(".")[0] in self._packages:
                    files.update(_module_files(name, attribute_of, self.root))
            self._imported[path] = sorted(files)
        return self._imported[path]


def imported_names(syntax: ast.Module) -> Iterable[tuple[str, str | None, int]]:
    """Yield the names that a module imports, the module of which each may be an attribute, and the relative level."""
    waiting: list[ast.AST] = [syntax]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, None, 0
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                yield alias.name, node.module or "", node.level
        for block in _BLOCKS:  # expressions, nine tenths of the nodes, hold no import
            waiting += getattr(node, block, ())


def _absolute_names(path: Path, syntax: ast.Module) -> Iterable[tuple[str, str]]:
    """Yield the dotted names that a file at `path` imports, and the module of which each may be an attribute."""
    for name, base, level in imported_names(syntax):
        if base is None:
            yield name, ""
            continue
        parts = path.parts[:-level] if level else ()
        parent = ".".join([*parts, *([base] if base else [])])
        yield f"{parent}.{name}", parent


def _module_files(name: str, attribute_of: str, root: Path) -> Iterable[Path]:
    """Yield the files of a dotted name; if it is not a module, the files of the module that has it as an attribute."""
    base = root.joinpath(*name.split("."))
    module = base.with_suffix(".py") if base.name else base
    initial = base / "__init__.py"
    if (base / "__init__.pyi").is_file():
        yield from base.rglob("*.py")
    elif module.is_file():
        yield module
    elif initial.is_file():
        yield initial
    elif attribute_of:
        yield from _module_files(attribute_of, "", root)
    parent = name.rpartition(".")[0]
    if "." in parent and (root.joinpath(*parent.split(".")) / "__init__.py").is_file():
        yield root.joinpath(*parent.split(".")) / "__init__.py"
