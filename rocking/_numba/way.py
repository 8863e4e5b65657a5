"""Which of two ways the kernels are compiled: faster, by private names of numba, or by its public interface alone."""

import os
from types import ModuleType

import numba

TRIED = (0, 68)
"""The newest numba tried with the faster way; with a newer one the kernels compile by the public interface.

To try another: install it, run `pytest tests/base tests/solver`, and change this number and the remark at the
requirement in `pyproject.toml`.
"""


def _faster_way() -> ModuleType | None:
    version = numba.version_info.short
    if os.environ.get("ROCKING_PLAIN_NUMBA") == "1" or None in version or version > TRIED:
        return None
    try:
        from rocking._numba import internals  # noqa: PLC0415  # imports names that this numba may lack
    except (ImportError, AttributeError):
        return None
    return internals


INTERNALS = _faster_way()
"""The module of the faster way; None if this numba may lack its names, or if `ROCKING_PLAIN_NUMBA` is 1."""
