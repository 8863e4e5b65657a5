"""Compiles the numerical kernels with numba and keeps the machine code on disk, so that only the very first call pays.

`kernel` marks a function that other kernels call; `entry` marks one that is called from Python. Only entries are kept
on disk, each as one module that holds all kernels it calls, and every entry has one signature.

Why one module: numba compiles each kernel as a library of its own and links a copy of it, as a weak symbol, into each
of its callers, where it is optimised once more. In a process that compiles, the loader prefers the strong symbol of the
separate library; in a process that loads the caller from the cache there is only the copy. Both are correct, but the
second optimisation may fuse other multiplications and additions, so that answers differed in the last bits between the
two processes. Here the copies are made internal to the module of the entry: every process runs the same instructions.

Numba's own cache watches the file of the function that is called, not the files of the kernels that it calls. Here
the cache folder is named after a digest of the kernels' sources and of all that these import from the package, so that
an edit of any of them compiles anew.
"""

from __future__ import annotations

import hashlib
import os
import re
import sys
import tempfile
import warnings
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numba
import numpy as np
from llvmlite import binding  # type: ignore[import-untyped]
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.typed_passes import NativeLowering
from numba.extending import register_jitable
from numpy.typing import NDArray

Record = Any
"""A numpy record of named numbers and short arrays, handed to a kernel by address."""

FloatArray = NDArray[np.float64]
"""A float64 array; the kernels' docstrings give shapes."""

SimdVector = Any
"""One number for each of several cells, see `lanes`."""

Series = NDArray[np.float64]
"""Coefficients of power series in tau, one column for each cell: shape (degree + 1, lanes)."""

_PACKAGE = Path(__file__).parents[1]

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}, "no_cfunc_wrapper": True}
"""Nopython mode, no interpreter lock, fused multiply-add allowed but no reordering."""


class _SingleModuleLibrary(JITCodeLibrary):
    """A library in which the copies of other kernels are internal."""

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            if function.linkage.name == "linkonce_odr":
                function.linkage = "internal"
        super()._optimize_final_module()


@register_pass(mutates_CFG=False, analysis_only=False)
class _UseSingleModuleLibrary(LoweringPass):
    """Has the code generated into a `_SingleModuleLibrary`."""

    _name = "rocking_one_module"

    def __init__(self) -> None:
        LoweringPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        state.library = _SingleModuleLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return False


class _EntryCompiler(CompilerBase):
    """Numba's compiler with that pass before the generation of code."""

    def define_pipelines(self) -> list[Any]:
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(_UseSingleModuleLibrary, self._before_lowering(passes))
        passes.finalize()
        return [passes]

    @staticmethod
    def _before_lowering(passes: Any) -> Any:
        classes = [kind for kind, _ in passes.passes]
        return classes[classes.index(NativeLowering) - 1]


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile `function` as a part of the entries that call it; called from Python it is compiled anew each time."""
    compiled: Callable[..., Any] = numba.njit(**_OPTIONS)(function)
    return compiled


def jitable(function: Callable[..., Any]) -> Callable[..., Any]:
    """Let kernels call `function`, which remains an ordinary function in Python."""
    made: Callable[..., Any] = register_jitable(error_model="numpy", fastmath={"contract"})(function)
    return made


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile `function` and keep the machine code on disk.

    It is called from Python, with arrays as `contiguous_array` returns them.
    """
    folder = cache_folder()
    compile_ = numba.njit(pipeline_class=_EntryCompiler, cache=folder is not None, **_OPTIONS)
    config: Any = numba.config  # its attributes are made at run time
    before = config.CACHE_DIR
    config.CACHE_DIR = folder or before
    try:
        compiled: Callable[..., Any] = compile_(function)
    finally:
        config.CACHE_DIR = before
    return compiled


def contiguous_array(array: NDArray[Any]) -> NDArray[Any]:
    """The array, or a copy, contiguous, aligned and writable: the one kind that entries take."""
    # to ask a view that numpy has broadcast whether it is writable raises a warning
    return array if array.flags.owndata and array.flags.carray else np.array(array, order="C")


@lru_cache(maxsize=1)
def cache_folder() -> str | None:
    """Folder of the machine code: below NUMBA_CACHE_DIR if that is set, else beside the package, else of the user.

    None, with a warning, if none of them can be written to.
    """
    name = f"kernels-{_digest(_PACKAGE)}"
    given = os.environ.get("NUMBA_CACHE_DIR")
    user = Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()) / "rocking"
    for parent in [Path(given)] if given else [_PACKAGE / "__pycache__", user]:
        if _is_writable(parent / name):
            return str(parent / name)
    warnings.warn(
        "the compiled kernels of rocking cannot be kept, as no cache folder can be written to: every process compiles "
        "them, about half a minute; set NUMBA_CACHE_DIR to a folder that can be written to",
        RuntimeWarning,
        stacklevel=2,
    )
    return None


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def _digest(package: Path) -> str:
    """Digest of what machine code depends on: processor, Python, numba; files with kernels and what these import."""
    files = {path.relative_to(package): path.read_bytes() for path in package.rglob("*.py")}
    compiled = re.compile(rb"^@(kernel|jitable|entry)$|numba\.extending", re.M)
    waiting = [path for path, text in files.items() if compiled.search(text)]
    seen: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in seen:
            seen.add(path)
            imported = re.findall(rb"^from rocking\.([\w.]+) import", files[path], re.M)
            modules = [Path(*name.decode().split(".")) for name in imported]
            named = {one for module in modules for one in (module.with_suffix(".py"), module / "__init__.py")}
            waiting += [one for one in named if one in files]
    features = binding.get_host_cpu_features().flatten()
    made_by = sys.version, numba.__version__, binding.get_host_cpu_name(), features
    digest = hashlib.sha256("\n".join(made_by).encode())
    for path in sorted(seen):
        digest.update(f"{path.as_posix()} {len(files[path])}\n".encode())
        digest.update(files[path])
    return digest.hexdigest()[:16]
