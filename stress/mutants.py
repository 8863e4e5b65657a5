"""The changes of a mutation trial, and the tests of each: `make mutants`.

cosmic-ray makes the changes in the clone build/mutants, one at a time, and keeps a session. `python -m stress.mutants
--session FILE` leaves some changes in it, drawn from a seed, in modules of the folders. Without a session, as
cosmic-ray calls it after a change, it runs the tests that import the changed module until one fails: those that import
it through few others, and then those that import little, first.
"""

from __future__ import annotations

import json
import os
import random
import re
import resource
import sqlite3
import subprocess
import sys
from collections import defaultdict
from contextlib import closing
from pathlib import Path

from benchmarks.measure import arguments
from stress.imports import ImportGraph

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
    for test in ordered_tests(tree / changed.stdout.strip(), tree):
        if resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime > BUDGET:
            break
        status = subprocess.run([*command, str(test)], cwd=tree, env=environment, check=False).returncode
        if status not in (0, 5):  # 5: none of its tests is selected
            return status
    return 0


def main() -> None:
    """Command line."""
    options = arguments(__doc__, session=Path(), count=150, seed=1, folders=["rocking", "api"])
    if options.session == Path():
        sys.exit(run_tests(TREE))
    sample(options.session, options.count, options.seed, options.folders)


if __name__ == "__main__":
    main()
