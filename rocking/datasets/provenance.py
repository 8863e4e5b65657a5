"""Digests of the code and the settings from which a result was computed.

A result depends on the modules that its script imports, directly or indirectly, and on the locked environment. The
imports are read from the source text: nothing is executed, and a change of a module affects only results that depend on
it.
"""

from __future__ import annotations

import ast
import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).resolve().parents[2]
"""Folder of the package and, in a checkout, of `workflow/` and `environment.lock`."""


class SourceTree:
    """The Python files of a folder as they are now: each is read once, for any number of digests.

    Parameters
    ----------
    root : Path
        Folder that holds the files and the lock, and from which absolute imports are resolved.
    """

    def __init__(self, root: Path = PROJECT) -> None:
        self.root = root.resolve()
        self._contents: dict[Path, bytes] = {}
        self._imported: dict[Path, list[Path]] = {}

    def files(self, *paths: Path) -> list[Path]:
        """All files under `root` that the given files import, directly or indirectly, and these files; sorted.

        `rocking/__init__.py` only loads names lazily. Importing a module through it does not add a dependency on every
        public name; importing a name that is not a module does, and then all files of the package are included.
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
        """sha256 (hex) of the `files` of `paths`, none: of the whole package, and of `environment.lock` if there."""
        files = self.files(*(paths or _package(self.root)))
        lock = self.root / "environment.lock"
        digest = hashlib.sha256()
        for path in [*files, *([lock] if lock.exists() else [])]:
            content = self._content(path)
            digest.update(f"{path.relative_to(self.root).as_posix()} {len(content)}\n".encode())
            digest.update(content)
        return digest.hexdigest()

    def _content(self, path: Path) -> bytes:
        if path not in self._contents:
            self._contents[path] = path.read_bytes()
        return self._contents[path]

    def _imports(self, path: Path) -> list[Path]:
        if path not in self._imported:
            self._imported[path] = sorted({*_imported_files(path, self._content(path), self.root)})
        return self._imported[path]


def settings_digest(settings: Mapping[str, Any]) -> str:
    """sha256 (hex) of settings (numbers, strings, lists, mappings), independent of the order of their keys."""
    return hashlib.sha256(json.dumps(settings, sort_keys=True).encode()).hexdigest()


def _package(root: Path) -> tuple[Path, ...]:
    return tuple((root / "rocking").rglob("*.py"))


def _imported_names(source: bytes) -> Iterable[tuple[str, str | None, int]]:
    """The names that a module imports, with the module of which each may be an attribute, and the relative level."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, None, 0
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                yield alias.name, node.module or "", node.level


def _imported_files(path: Path, source: bytes, root: Path) -> Iterable[Path]:
    for name, base, level in _imported_names(source):
        if base is None:
            yield from _module_files(name, root)
            continue
        parts = path.relative_to(root).parts[:-level] if level else ()
        full = ".".join([*parts, *([base] if base else [])])
        yield from _module_files(f"{full}.{name}", root, attribute_of=full)


def _module_files(name: str, root: Path, attribute_of: str | None = None) -> Iterable[Path]:
    """Files of a dotted name; if it is not a module, those of the module that has it as an attribute."""
    place = root.joinpath(*name.split("."))
    module = place.with_suffix(".py") if place.name else place
    initial = place / "__init__.py"
    if name == "rocking":
        yield from _package(root)
    elif module.is_file():
        yield module
    elif initial.is_file():
        yield initial
    elif attribute_of:
        yield from _module_files(attribute_of, root)
    parent = name.rpartition(".")[0]
    if "." in parent and (root.joinpath(*parent.split(".")) / "__init__.py").is_file():
        yield root.joinpath(*parent.split(".")) / "__init__.py"
