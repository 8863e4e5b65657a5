"""Digests that say which code and which settings a result came from.

A result depends on the modules that its script imports, directly or through others, and on the locked environment. The
imports are read from the source text, so nothing is executed and a change in a module touches only what depends on it.
"""

from __future__ import annotations

import ast
import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).resolve().parents[2]
"""Folder that holds the package and, in a checkout, `workflow/` and `environment.lock`."""


def source_files(*paths: Path, root: Path = PROJECT) -> list[Path]:
    """All files under `root` that the given files import, directly or through others, themselves included; sorted.

    `rocking/__init__.py` only forwards names lazily, so importing a module through it does not make the result depend
    on every public name; asking it for a name that is no module does, and then the whole package counts.

    Parameters
    ----------
    *paths : Path
        Python files under `root`.
    root : Path
        Folder from which absolute imports are resolved.
    """
    seen: set[Path] = set()
    waiting = [path.resolve() for path in paths]
    while waiting:
        path = waiting.pop()
        if path not in seen:
            seen.add(path)
            waiting += _imported_files(path, root.resolve())
    return sorted(seen)


def code_digest(*paths: Path, root: Path = PROJECT) -> str:
    """sha256 (hex) of the `source_files` of `paths`, by default the whole package, and of `environment.lock` if there.

    Parameters
    ----------
    *paths : Path
        Python files under `root`; none means every module of `rocking`.
    root : Path
        Folder that holds them and the lock.
    """
    files = source_files(*(paths or _package(root)), root=root)
    lock = root.resolve() / "environment.lock"
    digest = hashlib.sha256()
    for path in [*files, *([lock] if lock.exists() else [])]:
        content = path.read_bytes()
        digest.update(f"{path.relative_to(root.resolve()).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


def settings_digest(settings: Mapping[str, Any]) -> str:
    """sha256 (hex) of plain settings (numbers, strings, lists, mappings), whatever the order of their keys."""
    return hashlib.sha256(json.dumps(settings, sort_keys=True).encode()).hexdigest()


def _package(root: Path) -> tuple[Path, ...]:
    return tuple((root / "rocking").rglob("*.py"))


def _imported_files(path: Path, root: Path) -> Iterable[Path]:
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield from _module_files(alias.name, root)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parts = path.relative_to(root).parts[: -node.level]
                base = ".".join([*parts, *([base] if base else [])])
            for alias in node.names:
                yield from _module_files(f"{base}.{alias.name}", root, attribute_of=base)


def _module_files(name: str, root: Path, attribute_of: str | None = None) -> Iterable[Path]:
    """Files behind a dotted name; where it is no module, those of the module that it is an attribute of."""
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
