"""Processes that solve cells with the package of this tree or of another checkout."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.checkout_worker import RESULT


class Checkout:
    """A process that solves chunks with the package of a checkout."""

    def __init__(self, root: Path, processor: str = "") -> None:
        worker = Path(__file__).with_name("checkout_worker.py")
        environment = os.environ | {"PYTHONPATH": str(root), "OMP_NUM_THREADS": "1"}
        environment |= {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""} if processor else {}
        self._process = subprocess.Popen(
            [sys.executable, "-P", str(worker)], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE
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
