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
from functools import lru_cache
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).resolve().parents[2]
"""Folder of the package and, in a checkout, of `workflow/` and `environment.lock`."""


def source_files(*paths: Path, root: Path = PROJECT) -> list[Path]:
    """All files under `root` that the given files import, directly or indirectly, and these files; sorted.

    `rocking/__init__.py` only loads names lazily. Importing a module through it does not add a dependency on every
    public name; importing a name that is not a module does, and then all files of the package are included.

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
    """sha256 (hex) of settings (numbers, strings, lists, mappings), independent of the order of their keys."""
    return hashlib.sha256(json.dumps(settings, sort_keys=True).encode()).hexdigest()


def _package(root: Path) -> tuple[Path, ...]:
    return tuple((root / "rocking").rglob("*.py"))


@lru_cache(maxsize=1024)
def _imports(source: bytes) -> tuple[tuple[str, str | None, int], ...]:
    """The names that a module imports, with the module of which each may be an attribute, and the relative level.

    Kept by the content: every rule of the workflow asks for the digest of its code, and most share their modules.
    """
    found: list[tuple[str, str | None, int]] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found += [(alias.name, None, 0) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            found += [(alias.name, node.module or "", node.level) for alias in node.names]
    return tuple(found)


def _imported_files(path: Path, root: Path) -> Iterable[Path]:
    for name, base, level in _imports(path.read_bytes()):
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
