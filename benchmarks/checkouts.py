"""Cells that processes solve, each with the package of this tree or of another checkout.

A process runs this file, which imports nothing of the checkout but the package, so that it runs with that of any
commit. A line of JSON on standard input describes a chunk: a grid, or the seed from which its cells are drawn. The
answer on standard output is a line of JSON (number of cells, processor time [s]) and the records `RESULT` of the
responses. A chunk with a seed may name some of its cells, and factors of their inputs: then only these are solved.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rocking

INPUTS = ("slenderness", "frequency_ratio", "restitution", "alpha")
"""Under a record the second is the frequency parameter p [rad/s]."""

RESULT = np.dtype([("peak_rotation", "f8"), ("outcome", "i1"), ("impacts", "i4"), ("chatter", "?")])

AT_LIMIT = 0.02
"""Share of the cells with eta = 0, and of those with eta = 1 [-]."""

Array = NDArray[np.float64]


def draw(chunk: dict[str, Any]) -> list[Array]:
    """The inputs of all cells of a chunk; alpha is 0 for slender blocks."""
    random, size = np.random.default_rng(chunk["seed"]), chunk["size"]
    slenderness = random.uniform(0.02, 1.0, size)
    low, high = (0.5, 10.0) if chunk["record"] else (0.1, 30.0)
    frequency = np.exp(random.uniform(np.log(low), np.log(high), size))
    eta = np.clip(random.uniform(-AT_LIMIT, 1.0 + AT_LIMIT, size), 0.0, 1.0)
    alpha = random.uniform(0.01, 1.4, size) if chunk["rigid"] else np.zeros(size)
    return [slenderness, frequency, eta, alpha]


@lru_cache
def grid(count: int, highest: float, order: str) -> dict[str, Array]:
    """The inputs of a square grid: in rows, in random order, or with 32 restitutions at each point."""
    points = np.meshgrid(np.linspace(0.02, highest, count), np.linspace(0.5, 12.0, count), indexing="ij")
    cells = [values.ravel() for values in (*points, np.full(points[0].shape, 0.85))]
    if order == "random":
        shuffled = np.random.default_rng(0).permutation(count**2)
        cells = [values[shuffled] for values in cells]
    elif order == "eta":
        cells = [np.repeat(cells[0], 32), np.repeat(cells[1], 32), np.tile(np.linspace(0.5, 0.98, 32), count**2)]
    return dict(zip(INPUTS, cells, strict=False))


@lru_cache
def read_motion(path: str) -> rocking.Record:
    """The record of a file."""
    return rocking.read_record(path)


def solve(chunk: dict[str, Any]) -> tuple[NDArray[np.void], float]:
    """The responses of a chunk, array (cells,) of `RESULT`, and the processor time [s]."""
    if "order" in chunk:
        cells = grid(chunk["count"], chunk["highest"], chunk["order"])
        return timed(partial(rocking.peak_response, chunk["pulse"], **cells, alpha=chunk["alpha"], threads=1))
    cells = draw(chunk)
    if "cells" in chunk:
        chosen = np.array(chunk["cells"], np.intp)
        cells = [values[chosen] * factor for values, factor in zip(cells, chunk["factors"], strict=True)]
        cells[2] = np.minimum(cells[2], 1.0)
    inputs: dict[str, Any] = dict(zip(INPUTS, cells, strict=True))
    if chunk["record"]:
        inputs["frequency_parameter"] = inputs.pop("frequency_ratio")
        # before version 1.0 records had a function of their own
        of_record = getattr(rocking, "record_response", rocking.peak_response)
        call = partial(of_record, read_motion(chunk["pulse"]), threads=1)
    else:
        call = partial(rocking.peak_response, chunk["pulse"], threads=1)
    call(**{name: values[: values.size // 50] for name, values in inputs.items()})  # compiled before the time is taken
    return timed(partial(call, **inputs))


def timed(call: Callable[[], rocking.Response]) -> tuple[NDArray[np.void], float]:
    """What a call returns, and its processor time [s]."""
    started = time.process_time()
    response = call()
    seconds = time.process_time() - started
    found = np.empty(response.shape, RESULT)
    for name in RESULT.names or ():
        found[name] = getattr(response, name)
    return found, seconds


class Checkout:
    """A process that solves chunks with the package of a checkout."""

    def __init__(self, root: Path, processor: str = "") -> None:
        environment = os.environ | {"PYTHONPATH": str(root), "OMP_NUM_THREADS": "1"}
        environment |= {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""} if processor else {}
        self._process = subprocess.Popen(
            [sys.executable, "-P", __file__], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )

    def close(self) -> None:
        """End the process."""
        self._process.communicate()

    def start(self, chunk: dict[str, Any]) -> None:
        """Let the process solve a chunk."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(chunk).encode() + b"\n")
        self._process.stdin.flush()

    def result(self) -> tuple[NDArray[np.void], float]:
        """The responses of the chunk that was started, and its processor time [s]."""
        assert self._process.stdout is not None
        about = json.loads(self._process.stdout.readline() or b"null")
        if about is None:
            sys.exit(f"a process has ended with status {self._process.wait()}")
        content = self._process.stdout.read(about["cells"] * RESULT.itemsize)
        return np.frombuffer(content, RESULT), float(about["seconds"])

    def solve(self, chunk: dict[str, Any], cells: NDArray[np.intp], factors: NDArray[np.float64]) -> NDArray[np.void]:
        """The responses of some cells of a chunk with inputs multiplied by factors (4,)."""
        self.start(chunk | {"cells": cells.tolist(), "factors": factors.tolist()})
        return self.result()[0]


def main() -> None:
    """Answer until standard input ends."""
    for line in sys.stdin:
        found, seconds = solve(json.loads(line))
        sys.stdout.buffer.write(json.dumps({"cells": found.size, "seconds": seconds}).encode() + b"\n")
        sys.stdout.buffer.write(found.tobytes())
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
