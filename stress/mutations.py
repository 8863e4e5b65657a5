"""Mutation trial: change single operators and constants, run the tests: `python -m stress.mutations`.

A change replaces an operator, a comparison, `and`/`or`, a sign, a constant, `min`/`max` or `sin`/`cos`. It is drawn
from a seed and made in a copy of the tracked files; the tests that import its module, directly or indirectly, run until
the first failure. The log holds one JSON line for each change; a run with the same log continues where the last one
ended. Options: the folders whose modules are changed, the folder of the copy, the minutes after which no further change
is tried, and the seconds of tests for each change (`--budget`), without it.
"""

from __future__ import annotations

import ast
import json
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numba  # noqa: F401  # loaded once, before the trials fork
import pytest
import scipy.optimize  # noqa: F401
import xarray  # noqa: F401

from benchmarks.measure import arguments
from stress.imports import ImportGraph

ROOT = Path(__file__).parents[1]

SWAPS: dict[type[ast.AST], tuple[str, tuple[str, ...]]] = {
    ast.Add: ("+", ("-",)),
    ast.Sub: ("-", ("+",)),
    ast.Mult: ("*", ("/",)),
    ast.Div: ("/", ("*",)),
    ast.Lt: ("<", ("<=", ">=")),
    ast.LtE: ("<=", ("<", ">")),
    ast.Gt: (">", (">=", "<=")),
    ast.GtE: (">=", (">", "<")),
    ast.Eq: ("==", ("!=",)),
    ast.NotEq: ("!=", ("==",)),
    ast.Is: ("is", ("is not",)),
    ast.IsNot: ("is not", ("is",)),
    ast.And: ("and", ("or",)),
    ast.Or: ("or", ("and",)),
    ast.BitAnd: ("&", ("|",)),
    ast.BitOr: ("|", ("&",)),
}
"""Operators: how they are written, and their replacements."""

NAMES = {"min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum", "sin": "cos", "cos": "sin"}
"""Functions that replace each other."""


BATCH_SECONDS = 15.0
"""Time of the tests that run in one process [s]; the last of them may take longer."""

COMPILE_SECONDS, SLOWER = 240.0, 4.0
"""A batch ends after the time to compile all kernels [s] and this multiple of its time without a change: a timeout."""


@dataclass(frozen=True)
class Batch:
    """Test files that run in one process, and their time without a change [s]."""

    files: tuple[str, ...]
    seconds: float


@dataclass(frozen=True)
class Mutant:
    """One change: `old` at `start` in the text of a file becomes `new`."""

    path: str
    line: int
    start: int
    old: str
    new: str


def mutants_of(path: Path) -> list[Mutant]:
    """Return every possible change of a file."""
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines(keepends=True)
    before = [0]
    for line in lines:
        before.append(before[-1] + len(line))

    def place(line: int, column: int) -> int:
        return before[line - 1] + len(lines[line - 1].encode()[:column].decode())

    def begin(node: Any) -> int:
        return place(node.lineno, node.col_offset)

    def end(node: Any) -> int:
        return place(node.end_lineno, node.end_col_offset)

    def changes(node: ast.AST) -> Iterator[tuple[int, str, str]]:
        pairs: list[tuple[ast.AST, Any, Any]] = []
        if isinstance(node, ast.BinOp):
            pairs = [(node.op, node.left, node.right)]
        elif isinstance(node, ast.Compare):
            pairs = [*zip(node.ops, [node.left, *node.comparators], node.comparators, strict=False)]
        elif isinstance(node, ast.BoolOp):
            pairs = [(node.op, *two) for two in zip(node.values, node.values[1:], strict=False)]
        for op, left, right in pairs:
            old, news = SWAPS.get(type(op), ("", ()))
            between = text[end(left) : begin(right)]
            if old and "#" not in between and between.count(old) == 1:
                yield from ((end(left) + between.index(old), old, new) for new in news)
        if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add | ast.Sub):
            start = text.index("=", end(node.target)) - 1
            yield start, text[start : start + 2], "-=" if isinstance(node.op, ast.Add) else "+="
        if isinstance(node, ast.UnaryOp):
            first = text[begin(node) : begin(node.operand)]
            if first in ("-", "not ", "~"):
                yield begin(node), first, ""
        if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            old = text[begin(node) : end(node)]
            if isinstance(node.value, bool):
                yield begin(node), old, str(not node.value)
            elif isinstance(node.value, int):
                yield from ((begin(node), old, str(node.value + one)) for one in (-1, 1))
            else:
                yield begin(node), old, "1.0" if node.value == 0.0 else repr(1.5 * node.value)
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if name in NAMES:
                yield end(node.func) - len(name), name, NAMES[name]

    found = []
    for node in ast.walk(_without_annotations(ast.parse(text))):
        for start, old, new in changes(node):
            line = text.count("\n", 0, start) + 1
            found.append(Mutant(str(path.relative_to(ROOT)), line, start, old, new))
    return sorted(set(found), key=lambda mutant: (mutant.start, mutant.new))


def _without_annotations(tree: ast.Module) -> ast.Module:
    for node in ast.walk(tree):
        for name in ("annotation", "returns"):
            if getattr(node, name, None) is not None:
                setattr(node, name, None)
    return tree


def draw_mutants(folders: list[str], count: int, seed: int) -> list[Mutant]:
    """Draw changes of the modules below some folders without replacement."""
    random_ = random.Random(seed)
    queues = []
    for path in modules(folders):
        queue = mutants_of(path)
        random_.shuffle(queue)
        queues.append(queue)
    found: list[Mutant] = []
    while len(found) < count and any(queues):
        # the probability of a file is proportional to the square root of its number of changes
        queue = random_.choices(queues, [len(queue) ** 0.5 for queue in queues])[0]
        mutant = queue.pop()
        if all((mutant.path, mutant.start) != (other.path, other.start) for other in found):
            found.append(mutant)
    return found


def modules(folders: list[str]) -> list[Path]:
    """Return the modules below some folders of the tree; a module may be given by its own name."""
    return sorted(path for name in folders for path in [*(ROOT / name).rglob("*.py"), ROOT / name] if path.is_file())


def imported_by_tests(tree: Path) -> dict[str, dict[str, int]]:
    """Return for each test file the modules that it imports, and through how many others, by `ImportGraph`."""
    graph = ImportGraph(tree)
    return {
        test.relative_to(tree).as_posix(): {
            module.relative_to(tree).as_posix(): steps for module, steps in graph.distances(test).items()
        }
        for test in sorted(tree.glob("tests/**/test_*.py"))
    }


def batches_of(
    module: str, imported: dict[str, dict[str, int]], seconds: dict[str, float], budget: float
) -> list[Batch]:
    """Return the test files that import a module, in batches that run one after the other until one fails.

    Those that import it directly and those that take little time come first. They take at most `budget` [s] together,
    and each batch about `BATCH_SECONDS`: a process collects all tests of a batch before the first one runs.
    """
    cost = {
        test: found[module] * seconds[test] for test, found in imported.items() if module in found and test in seconds
    }
    batches = [Batch((), 0.0)]
    for test in sorted(cost, key=lambda test: (cost[test], test)):
        if sum(batch.seconds for batch in batches) + seconds[test] > budget:
            break
        if batches[-1].seconds > BATCH_SECONDS:
            batches.append(Batch((), 0.0))
        batches[-1] = Batch((*batches[-1].files, test), batches[-1].seconds + seconds[test])
    return batches if batches[0].files else []


def run_tests(tree: Path, files: tuple[str, ...], timeout: float) -> tuple[str, str]:
    """Run test files of a tree until the first failure, in a forked process that has the libraries loaded."""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
        child = os.fork()
        if child == 0:
            os.setsid()
            os.chdir(tree)
            os.environ["PYTHONPATH"] = sys.path[0] = str(tree)
            os.dup2(output.fileno(), 1)
            os.dup2(output.fileno(), 2)
            options = ["-q", "-x", "-m", "not slow", "-p", "no:cacheprovider", "--tb=line", "-o", "addopts="]
            os._exit(int(pytest.main([*options, "--import-mode=importlib", *files])))
        stop, status = time.monotonic() + timeout, (0, 0)
        while status[0] == 0 and time.monotonic() < stop:
            time.sleep(0.05)
            status = os.waitpid(child, os.WNOHANG)
        if status[0] == 0:
            os.killpg(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return "timeout", ""
        output.seek(0)
        lines = output.read().splitlines()
    if os.waitstatus_to_exitcode(status[1]) in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
        return "survived", ""
    failed = [line for line in lines if line.startswith(("FAILED", "ERROR"))]
    return "noticed", failed[0] if failed else " | ".join(lines[-8:])


def run(mutant: Mutant, batches: list[Batch], tree: Path, kept: set[Path]) -> dict[str, Any]:
    """Make a change in a copy of the tree, run the tests, undo the change; return the line of the log."""
    path = tree / mutant.path
    before, stat = path.read_text(), path.stat()
    stop = mutant.start + len(mutant.old)
    assert before[mutant.start : stop] == mutant.old, mutant
    result, by, begun = "survived", "", time.monotonic()
    try:
        path.write_text(before[: mutant.start] + mutant.new + before[stop:])
        for batch in batches:
            result, by = run_tests(tree, batch.files, COMPILE_SECONDS + SLOWER * batch.seconds)
            if result != "survived":
                break
    finally:
        path.write_text(before)
        os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))
        for folder in compiled_kernels(tree) - kept:
            shutil.rmtree(folder)
    source = before.splitlines()[mutant.line - 1].strip()
    tests = sum(len(batch.files) for batch in batches)
    took = round(time.monotonic() - begun, 1)
    return asdict(mutant) | {"source": source, "result": result, "by": by, "tests": tests, "seconds": took}


def compiled_kernels(tree: Path) -> set[Path]:
    """Return the folders of compiled kernels."""
    return set((tree / "rocking" / "__pycache__").glob("kernels-*"))


def prepare_tree(tree: Path) -> None:
    """Copy the files as they are staged, if that was not done, and compile the kernels."""
    if not tree.exists():
        subprocess.run(["git", "checkout-index", "--all", f"--prefix={tree}/"], cwd=ROOT, check=True)
    environment = os.environ | {"PYTHONPATH": str(tree)}
    subprocess.run([sys.executable, "-m", "rocking.precompile"], cwd=tree, env=environment, check=True)


def measure_tests(tree: Path, files: Iterable[str], limit: float) -> dict[str, float]:
    """Run test files of the tree without a change, and return their times [s], which are kept in the tree.

    Those that fail or take longer than `limit` [s] are left out.
    """
    kept = tree / "seconds.json"
    seconds: dict[str, float | None] = json.loads(kept.read_text()) if kept.exists() else {}
    for test in files:
        if test not in seconds:
            begun = time.monotonic()
            result, by = run_tests(tree, (test,), limit)
            seconds[test] = round(time.monotonic() - begun, 2) if result == "survived" else None
            kept.write_text(json.dumps(seconds, indent=1))
            if result != "survived":
                print(f"left out: {test}, without a change {result} {by}", flush=True)
    return {test: time for test, time in seconds.items() if time is not None}


def main() -> None:
    """Command line."""
    folders, build = ["rocking", "api/rocking_api"], ROOT / "build"
    options = arguments(
        __doc__, folders=folders, seed=1, count=150, tree=build / "mutants", log=build / "mutants.jsonl",
        minutes=math.inf, budget=120.0,
    )  # fmt: skip
    tree = options.tree.resolve()
    lines = options.log.read_text().splitlines() if options.log.exists() else []
    done = {(record["path"], record["start"], record["new"]) for record in map(json.loads, lines)}
    wanted = draw_mutants(options.folders, options.count, options.seed)
    left = [mutant for mutant in wanted if (mutant.path, mutant.start, mutant.new) not in done]
    prepare_tree(tree)
    imported = imported_by_tests(tree)
    changed = {mutant.path for mutant in left}
    needed = [test for test, found in imported.items() if not changed.isdisjoint(found)]
    seconds = measure_tests(tree, needed, options.budget)
    kept = compiled_kernels(tree)
    stop = time.monotonic() + 60.0 * options.minutes
    for mutant in left:
        if time.monotonic() > stop:
            break
        record = run(mutant, batches_of(mutant.path, imported, seconds, options.budget), tree, kept)
        with options.log.open("a") as log:
            print(json.dumps(record), file=log)
        place = f"{record['path']}:{record['line']} {record['old']} -> {record['new']}"
        print(f"{record['result']:9}{place}: {record['by'] or record['source']}", flush=True)


if __name__ == "__main__":
    main()
