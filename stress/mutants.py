"""The changes of a mutation trial, and the tests of each: `make mutants`.

cosmic-ray makes the changes in the clone build/mutants, one at a time, and keeps a session. `python -m stress.mutants
--session FILE` leaves some changes in it, drawn from a seed, in modules of the folders. Without a session, as
cosmic-ray calls it after a change, it runs the tests that import the changed module until one fails: those that import
it through few others, and then those that import little, first.
"""

from __future__ import annotations

import ast
import json
import os
import random
import re
import resource
import sqlite3
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from contextlib import closing
from functools import cache
from pathlib import Path

from benchmarks.measure import arguments
from rocking._base.source_tree import imported_names

TREE = Path(__file__).parents[1] / "build/mutants"

BUDGET = 120.0
"""Processor time after which no further test file is run for a change [s]."""

TRIVIAL = re.compile(
    r"Operator_BitOr_|(Add|Sub|Mul|Div|Mod|Pow)_(Bit|[LR]Shift)|(Lt|LtE|Gt|GtE|Eq|NotEq)_Is|USub_Invert"
)
"""Changes that are not tried: of annotations, and those that stop every test, as `<<` between numbers does."""


def sample(session: Path, count: int, seed: int, folders: list[str]) -> None:
    """Leave `count` changes at different places in a session."""
    columns = "module_path, start_pos_row, start_pos_col, operator_name, occurrence, job_id"
    places = defaultdict(list)
    with closing(sqlite3.connect(session)) as database, database:
        for *place, operator, _, job in database.execute(f"SELECT {columns} FROM mutation_specs ORDER BY {columns}"):
            if not TRIVIAL.search(operator) and any(f"mutants/{folder}" in place[0] for folder in folders):
                places[tuple(place)].append(job)
        draw = random.Random(seed)
        kept = [draw.choice(places[place]) for place in draw.sample([*places], min(count, len(places)))]
        for table in ("mutation_specs", "work_items"):
            database.execute(
                f"DELETE FROM {table} WHERE job_id NOT IN (SELECT value FROM json_each(?))", [json.dumps(kept)]
            )


class ImportGraph:
    """The imports between the Python files below `root` and in its `api/`, read from the text: nothing is executed."""

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
            for folder in (self.root, self.root / "api", self.root / "assessment"):
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


def ordered_tests(module: Path, tree: Path) -> list[Path]:
    """The test files of a tree that import a module, in the order in which they run."""
    graph = ImportGraph(tree)
    imported = {test: graph.distances(test) for test in tree.glob("tests/**/test_*.py")}
    importing = (test for test, found in imported.items() if module in found)
    return sorted(importing, key=lambda test: (imported[test][module], len(imported[test]), test))


def run_tests(tree: Path) -> int:
    """Run the tests of what is changed in a clone; returns the status of the last file."""
    changed = subprocess.run(["git", "diff", "--name-only"], cwd=tree, capture_output=True, text=True, check=True)
    environment = os.environ | {"PYTHONPATH": f"{tree}{os.pathsep}{tree / 'api'}"}
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-m", "not slow", "-p", "no:cacheprovider", "--tb=line"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    for test in ordered_tests(tree / changed.stdout.strip(), tree):
        if resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before > BUDGET:
            break
        status = subprocess.run([*command, str(test)], cwd=tree, env=environment, check=False).returncode
        if status not in (0, 5):  # 5: none of its tests is selected
            return status
    return 0


def main() -> None:
    """Command line."""
    options = arguments(__doc__, session=Path(), count=150, seed=1, folders=["rocking", "api", "assessment"])
    if options.session == Path():
        sys.exit(run_tests(TREE))
    sample(options.session, options.count, options.seed, options.folders)


if __name__ == "__main__":
    main()
