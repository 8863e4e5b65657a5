"""The array functions of numba, imported without SciPy.

numba registers them when it compiles or loads its first function. Then it looks for the BLAS of SciPy, which it needs
for products of matrices, by importing it: a quarter of the time in which a process gives its first response. SciPy is a
dependency of this package, so that BLAS is there, and numba imports it where a product is compiled; no kernel has one.
"""

from __future__ import annotations

from numba.np import linalg


def _found() -> None:
    """In place of `numba.np.linalg.ensure_blas`, which raises ImportError if there is no SciPy."""


_ensure_blas, linalg.ensure_blas = linalg.ensure_blas, _found
try:
    from numba.np import arraymath  # noqa: F401
finally:
    linalg.ensure_blas = _ensure_blas
