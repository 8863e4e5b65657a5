"""Compilation of the numerical kernels with numba.

`kernel` marks a function that other kernels call; `entry` marks one that is called from Python. Only entries are kept
on disk (`rocking._numba.kernel_cache`), each with all the kernels that it calls, and each entry has one signature.

Kernels compile in one of two ways, which give the same results (`rocking._numba.way`): the faster one takes a third of
the time by private names of numba (`rocking._numba.internals`), the plain one uses its public interface alone.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numba
import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

from rocking._numba.kernel_cache import keep_on_disk
from rocking._numba.way import INTERNALS

Record = Any  # a numpy record of named numbers and short arrays, passed to a kernel by address

Fields = list[tuple[str, type] | tuple[str, type, tuple[int, ...]]]
"""Names, types and shapes of consecutive fields of a record."""

FloatArray = NDArray[np.float64]  # a float64 array; the kernels' docstrings give shapes
SimdVector = Any  # one number for each SIMD lane, see `rocking._numba.simd`

Series = NDArray[np.float64]
"""Coefficients of power series in tau, one column for each SIMD lane: shape (degree + 1, LANES)."""

_ARITHMETIC: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}
"""No exception for a division by zero; fused multiply-add allowed but no reordering."""

_OPTIONS: dict[str, Any] = {"nogil": True, **_ARITHMETIC}


def _plain(function: Callable[..., Any], *, cache: bool = False) -> Any:
    """Compile by the public interface of numba."""
    return numba.njit(cache=cache, **_OPTIONS)(function)


def kernel(function: Callable[..., Any], *, arrays: bool = False, specialised: bool = False) -> Callable[..., Any]:
    """Compile `function`, which creates no arrays, for entries that call it.

    Calls from Python compile it in each process.
    """
    made: Callable[..., Any]
    if INTERNALS is None:
        made = _plain(function)
    else:
        made = (INTERNALS.SpecialisedKernel if specialised else INTERNALS.Kernel)(function, _OPTIONS, arrays=arrays)
    return made


specialised_kernel = partial(kernel, specialised=True)
"""`kernel` compiled for each constant that is passed to it, where branches that cost time depend on it."""

array_kernel = partial(kernel, arrays=True)  # `kernel` that may create arrays, with reference counts


def jitable(function: Callable[..., Any]) -> Callable[..., Any]:
    """Let kernels call `function`, which remains an ordinary function in Python."""
    made: Callable[..., Any] = register_jitable(**_ARITHMETIC)(function)
    return made


def entry(function: Callable[..., Any], *, arrays: bool = False, light: bool = False) -> Callable[..., Any]:
    """Compile `function`, which creates no arrays, and keep the machine code on disk.

    It is called from Python, with arrays as `contiguous_array` returns them.
    """

    def make(*, cache: bool) -> Any:
        if INTERNALS is None:
            return _plain(function, cache=cache)
        return INTERNALS.entry(function, _OPTIONS, arrays=arrays, light=light, cache=cache)

    made: Callable[..., Any] = keep_on_disk(make, function)
    return made


light_entry = partial(entry, light=True)  # `entry` that LLVM optimises less, and no slower: a first response waits less
array_entry = partial(entry, arrays=True)  # `entry` that may create arrays, with reference counts


def contiguous_array(array: NDArray[Any]) -> NDArray[Any]:
    """The array, or a copy of it, contiguous, aligned and writable: the only layout that entries accept."""
    # numpy warns when the flag `writeable` of a broadcast view is read
    return array if array.flags.owndata and array.flags.carray else np.array(array, order="C")
