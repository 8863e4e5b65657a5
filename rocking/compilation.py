"""Compiles the numerical kernels with numba and keeps the machine code, so that only the very first call pays.

Numba's own cache watches the file of the function that is called, not the files of the kernels that it calls. Here
the cache folder is named after a digest of all kernel sources, so that an edit of any of them compiles anew.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

Record = Any
"""A numpy record of named numbers and short arrays, handed to a kernel by address."""

Vector = NDArray[np.float64]
"""A float64 array; the kernels' docstrings give shapes."""

Lanes = Any
"""One number for each of several cells, see `lanes`."""

Series = NDArray[np.float64]
"""Coefficients of power series in tau, one column for each cell: shape (degree + 1, lanes)."""

_PACKAGE = Path(__file__).parent


@lru_cache(maxsize=1)
def _cache_folder() -> str:
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(_PACKAGE.glob("*.py")):
        text = source.read_bytes()
        if b"\n@kernel" in text or b"numba.extending" in text:
            digest.update(text)
    parent = _PACKAGE / "__pycache__"
    if not os.access(parent if parent.exists() else _PACKAGE, os.W_OK):
        parent = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "rocking"
    return str(parent / f"kernels-{digest.hexdigest()[:16]}")


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile `function` in nopython mode: no interpreter lock, fused multiply-add allowed, cached on disk."""
    config: Any = numba.config  # its attributes are made at run time
    before = config.CACHE_DIR
    config.CACHE_DIR = _cache_folder()
    try:
        return numba.njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})(function)
    finally:
        config.CACHE_DIR = before
