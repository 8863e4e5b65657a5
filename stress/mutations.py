"""Mutation trial: change single operators and constants, run the tests: `python -m stress.mutations`.

A change replaces an operator, a comparison, `and`/`or`, a sign, a constant, `min`/`max` or `sin`/`cos`. It is drawn
from a seed and made in a copy of the tracked files; the tests of its area run until the first failure. The log holds
one JSON line for each change; a run with the same log continues where the last one ended.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numba  # noqa: F401  # loaded once, before the trials fork
import pytest
import scipy.optimize  # noqa: F401
import xarray  # noqa: F401

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


@dataclass(frozen=True)
class Area:
    """Modules whose changes should fail the same tests."""

    name: str
    sources: tuple[str, ...]
    first: tuple[str, ...]
    """Tests that run first."""
    then: tuple[str, ...]
    """Tests that run if those pass."""

    def tests(self, tree: Path) -> tuple[str, ...]:
        """Return the test files of a tree in the order in which they run."""
        found = (path for pattern in (*self.first, *self.then) for path in sorted(tree.glob(pattern)))
        return tuple(dict.fromkeys(str(path.relative_to(tree)) for path in found))


def tests(*names: str) -> tuple[str, ...]:
    """Return the paths of test files."""
    return tuple(f"tests/*/test_{name}.py" for name in names)


AREAS = (
    Area(
        "kernels",
        tuple(
            f"rocking/{name}.py"
            for name in ("solver/kernels/*", "solver/arcs/*", "solver/taylor/*", "history/sampling")
        ),
        tests("intervals", "free_rocking", "golden_thresholds", "slender_arcs", "taylor", "against_tables", "chatter"),
        tests(
            "rigid_against_tables",
            "equations_of_motion",
            "limits",
            "symmetries",
            "peak_response",
            "history",
            "corners",
            "searches_end",
            "stress",
        ),
    ),
    Area(
        "analysis",
        tuple(
            f"rocking/{name}.py"
            for name in (
                *("model/*", "solver/*", "boundary/*", "history/*", "excitation/*"),
                *("orientation", "groups/scale_law", "errors"),
            )
        ),
        tests(
            *("block", "pulses", "contact", "orientation", "groups", "boundary", "boundary_frequency", "history"),
            *("boundary_curves", "free_rocking", "peak_response", "closed_form_peak"),
        ),
        tests(
            *("limits", "symmetries", "golden_thresholds", "equations_of_motion", "lookup", "history_contact"),
            *("rigid_against_tables", "ablations", "cli", "arguments", "outcome_margin", "boundary_cells"),
        ),
    ),
    Area(
        "formulas",
        ("rocking/closed_form/*.py", "rocking/groups/*.py"),
        tests(
            *("closed_form_coefficients", "closed_form_cases", "closed_form_no_impact", "closed_form_peak", "groups"),
            "closed_form_ad_hoc",
        ),
        tests("errata", "golden_thresholds"),
    ),
    Area(
        "lookup",
        (
            *("rocking/lookup/*.py", "rocking/spectra/*.py", "rocking/interpolation/*.py"),
            "rocking/datasets/cube.py",
        ),
        tests("interpolation", "level_interval", "lookup", "lookup_levels", "boundary_curves"),
        (*tests("cube", "ablations"), "tests/api/test_api_response.py", "tests/api/test_api_state.py"),
    ),
    Area("service", ("api/rocking_api/**/*.py",), ("tests/api/test_*.py",), ()),
)


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
    text = path.read_text()
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


def draw_mutants(area: Area, count: int, seed: int) -> list[Mutant]:
    """Draw changes of an area without replacement."""
    random_ = random.Random(f"{area.name} {seed}")
    queues = []
    for pattern in area.sources:
        for path in sorted(ROOT.glob(pattern)):
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


def run_tests(tree: Path, files: tuple[str, ...], timeout: float) -> tuple[str, str]:
    """Run test files of a tree until the first failure, in a forked process that has the libraries loaded."""
    with tempfile.TemporaryFile("w+") as output:
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
    if status[1] == 0:
        return "survived", ""
    failed = [line for line in lines if line.startswith(("FAILED", "ERROR"))]
    return "noticed", failed[0] if failed else " | ".join(lines[-8:])


def run(mutant: Mutant, area: Area, tree: Path, kept: set[Path], timeout: float) -> dict[str, Any]:
    """Make a change in a copy of the tree, run the tests, undo the change; return the line of the log."""
    path = tree / mutant.path
    before, stat = path.read_text(), path.stat()
    stop = mutant.start + len(mutant.old)
    assert before[mutant.start : stop] == mutant.old, mutant
    # tests named after the module come first
    files = sorted(area.tests(tree), key=lambda name: path.stem not in name)
    try:
        path.write_text(before[: mutant.start] + mutant.new + before[stop:])
        result, by = run_tests(tree, tuple(files), timeout)
    finally:
        path.write_text(before)
        os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))
        for folder in compiled_kernels(tree) - kept:
            shutil.rmtree(folder)
    source = before.splitlines()[mutant.line - 1].strip()
    return asdict(mutant) | {"area": area.name, "source": source, "result": result, "by": by}


def compiled_kernels(tree: Path) -> set[Path]:
    """Return the folders of compiled kernels."""
    return set((tree / "rocking" / "__pycache__").glob("kernels-*"))


def prepare_tree(tree: Path, areas: list[Area]) -> set[Path]:
    """Copy the files as they are staged, and run all tests once: they must pass, which also compiles the kernels."""
    if not tree.exists():  # the files that git has staged
        subprocess.run(["git", "checkout-index", "--all", f"--prefix={tree.resolve()}/"], cwd=ROOT, check=True)
    for area in areas:
        result, by = run_tests(tree, area.tests(tree), 3600.0)
        if result != "survived":
            sys.exit(f"{area.name}: the tests fail without a change: {by}")
    return compiled_kernels(tree)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=32, help="changes of each area")
    parser.add_argument("--area", nargs="*", choices=[area.name for area in AREAS])
    parser.add_argument(
        "--tree", type=Path, default=ROOT / "build" / "mutants", help="folder of the copy; created if missing"
    )
    parser.add_argument("--log", type=Path, default=ROOT / "build" / "mutants.jsonl")
    parser.add_argument("--most", type=int, help="maximum number of changes in this run; default: all")
    parser.add_argument("--timeout", type=float, default=400.0, help="seconds for each group of tests")
    options = parser.parse_args()
    lines = options.log.read_text().splitlines() if options.log.exists() else []
    done = {(record["path"], record["start"], record["new"]) for record in map(json.loads, lines)}
    areas = [area for area in AREAS if not options.area or area.name in options.area]
    wanted = [(mutant, area) for area in areas for mutant in draw_mutants(area, options.count, options.seed)]
    left = [pair for pair in wanted if (pair[0].path, pair[0].start, pair[0].new) not in done]
    kept = prepare_tree(options.tree, areas)
    for mutant, area in left[: options.most]:
        record = run(mutant, area, options.tree, kept, options.timeout)
        with options.log.open("a") as log:
            print(json.dumps(record), file=log)
        place = f"{record['path']}:{record['line']} {record['old']} -> {record['new']}"
        print(f"{record['result']:9}{place}: {record['by'] or record['source']}", flush=True)


if __name__ == "__main__":
    main()
