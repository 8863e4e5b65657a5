"""Compilation of the numerical kernels with numba, with a cache of the machine code on disk.

`kernel` marks a function that other kernels call; `entry` marks one that is called from Python. Only entries are
cached, each as one module with all the kernels that it calls, and each entry has one signature.

Reason for the single module: numba compiles each kernel as a separate library and links a copy of it, as a weak symbol,
into each caller, where it is optimised again. A process that compiles uses the strong symbol of the separate library; a
process that loads the caller from the cache has only the copy. Both are correct, but the second optimisation may fuse
other multiplications and additions, so that results differed in the last bits between the two processes. Here the
copies have internal linkage in the module of the entry, and every process runs the same instructions.

The cache of numba tracks the file of the called function, its place and its time, not the files of the kernels that it
calls. Here the name of the cache folder contains a digest of the sources of the kernels and of the modules of the
package that they import: a change in any of them leads to recompilation, a copy of the package does not.
"""

from __future__ import annotations

import gc
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
from numba.core.caching import UserProvidedCacheLocator
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import InlineOverloads, NativeLowering, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes, InlineInlinables, LiteralUnroll
from numba.extending import register_jitable
from numpy.typing import NDArray

import rocking._numba.array_functions  # noqa: F401  # before the first function is compiled or loaded

Record = Any
"""A numpy record of named numbers and short arrays, passed to a kernel by address."""

FloatArray = NDArray[np.float64]
"""A float64 array; the kernels' docstrings give shapes."""

SimdVector = Any
"""One number for each SIMD lane, see `rocking._numba.simd`."""

Series = NDArray[np.float64]
"""Coefficients of power series in tau, one column for each SIMD lane: shape (degree + 1, LANES)."""

_PACKAGE = Path(__file__).parents[1]

_WITH_ARRAYS: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",
    "fastmath": {"contract"},
    "no_cfunc_wrapper": True,
}
"""Nopython mode, no interpreter lock, fused multiply-add allowed but no reordering."""

_OPTIONS: dict[str, Any] = {**_WITH_ARRAYS, "_nrt": False}
"""The same without reference counts of arrays.

numba counts the references to an array argument with atomic operations in each function that is not inlined: a fifth of
the time of a rigid block.
"""


class _SingleModuleLibrary(JITCodeLibrary):
    """A library in which the copies of other kernels have internal linkage and names of their own.

    The linker of numba finds internal functions by name, too: the first one that it has loaded. The copy of a kernel in
    an entry is compiled for the calls of the entry, perhaps with fewer arguments. Under its own name it would be called
    by any kernel that Python calls; names agree within a process, and by chance between the processes that compile and
    load an entry, since they contain a running number. The functions that count references keep their names: they are
    the same everywhere, and the pass that removes pairs of them finds them by name (kernels took 1.7 times the time).
    """

    def finalize(self) -> None:
        _link_all_called(self, self._final_module)
        self._linking_libraries = []
        super().finalize()

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            if function.linkage.name == "linkonce_odr":
                function.linkage = "internal"
                if not function.name.startswith("NRT_"):
                    function.name = f"{self.name}.{function.name}"
        super()._optimize_final_module()


@register_pass(mutates_CFG=False, analysis_only=False)
class _UseSingleModuleLibrary(LoweringPass):
    """Selects `_SingleModuleLibrary` as the target of code generation."""

    _name = "rocking_one_module"

    def __init__(self) -> None:
        LoweringPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        state.library = _SingleModuleLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return False


class _NoEnvironment:
    """Stands for the code generator where numba stores the environment of a function that Python calls."""

    @staticmethod
    def set_env(name: str, environment: Any) -> None:
        pass


class _LinkedLibrary(JITCodeLibrary):
    """A library that is only linked into entries: neither optimised nor translated to machine code by itself.

    It does not contain the libraries that it calls: an entry links each of them once.
    """

    def own_module(self) -> Any:
        """The module without those that it calls."""
        return super()._get_module_for_linking()

    def _get_module_for_linking(self) -> Any:
        """The module with all that it calls, for a function that numba compiles as usual."""
        whole = self.own_module().clone()
        _link_all_called(self, whole)
        return whole

    def _optimize_functions(self, ll_module: Any) -> None:
        pass

    def finalize(self) -> None:
        self._raise_if_finalized()
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:  # noqa: ARG002
        return 0

    @property
    def codegen(self) -> Any:
        return _NoEnvironment


def _link_all_called(library: Any, module: Any) -> None:
    """Link the libraries that a library calls, directly or not, into a module: each once, after one that calls it."""
    linked: set[Any] = set()

    def link(caller: Any) -> None:
        for called in caller._linking_libraries:
            if called not in linked:
                linked.add(called)
                inside = isinstance(called, _LinkedLibrary)
                module.link_in(called.own_module() if inside else called._get_module_for_linking(), preserve=True)
                if inside:
                    link(called)

    link(library)


@register_pass(mutates_CFG=False, analysis_only=False)
class _UseLinkedLibrary(LoweringPass):
    """Selects `_LinkedLibrary` as the target of code generation."""

    _name = "rocking_linked"

    def __init__(self) -> None:
        LoweringPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        state.library = _LinkedLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return False


_UNUSED = (InlineClosureLikes, InlineInlinables, InlineOverloads, LiteralUnroll, NopythonRewrites)
"""Passes for what kernels do not have: inner functions, functions that numba inlines, expressions of arrays.

Each looks through the whole function: without them compilation takes a twentieth less.
"""


class _Compiler(CompilerBase):
    """The compiler of numba with another library, which the pass `select` sets before lowering."""

    select: Any

    def define_pipelines(self) -> list[Any]:
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.passes = [one for one in passes.passes if one[0] not in _UNUSED]
        passes.add_pass_after(self.select, self._before_lowering(passes))
        passes.finalize()
        return [passes]

    @staticmethod
    def _before_lowering(passes: Any) -> Any:
        classes = [kind for kind, _ in passes.passes]
        return classes[classes.index(NativeLowering) - 1]


class _EntryCompiler(_Compiler):
    """Compiler of entries.

    Garbage is not collected meanwhile: compilation makes millions of objects and keeps most of them.
    """

    select = _UseSingleModuleLibrary

    def compile_extra(self, func: Any) -> Any:
        collecting = gc.isenabled()
        gc.disable()
        try:
            return super().compile_extra(func)
        finally:
            if collecting:
                gc.enable()


class _KernelCompiler(_Compiler):
    """Compiler of the kernels inside entries."""

    select = _UseLinkedLibrary


class PackageCacheLocator(UserProvidedCacheLocator):
    """Where numba keeps the entries of this package: in files that do not depend on where and when it was installed.

    numba finds it by its name; any other file has the place and the time of numba's own cache.
    """

    def __init__(self, function: Callable[..., Any], file: str) -> None:
        super().__init__(function, file)
        folder = Path(self._cache_path).parent
        self._cache_path = str(folder / function.__module__)

    def get_source_stamp(self) -> str:
        """The same at any time: the folder is that of the sources."""
        return ""

    @classmethod
    def from_function(cls, function: Callable[..., Any], file: str) -> PackageCacheLocator | None:
        """The locator, or None for a function outside this package."""
        return cls(function, file) if Path(file).is_relative_to(_PACKAGE) else None


_CONSTANTS = (numba.types.IntegerLiteral, numba.types.BooleanLiteral)


class _Kernel(CPUDispatcher):
    """A kernel: inside entries code to be linked; from Python a function of its own, compiled when it is called."""

    def __init__(self, function: Callable[..., Any], options: dict[str, Any]) -> None:
        inside = options | {"nopython": True, "no_cpython_wrapper": True}
        super().__init__(py_func=function, targetoptions=inside, pipeline_class=_KernelCompiler)
        self._from_python = numba.njit(**options)(function)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """The signature of a call in a kernel; one for all integers, not one for each constant that kernels pass."""
        plain = [numba.types.unliteral(arg) if isinstance(arg, _CONSTANTS) else arg for arg in args]
        return super().get_call_template(plain, kws)

    def __call__(self, *args: Any) -> Any:
        return self._from_python(*args)


class _SpecialisedKernel(_Kernel):
    """A kernel that is compiled for each constant that kernels pass."""

    get_call_template = CPUDispatcher.get_call_template


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile `function`, which creates no arrays, for entries that call it.

    Calls from Python compile it in each process.
    """
    return _Kernel(function, _OPTIONS)


def specialised_kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """`kernel` compiled for each constant that is passed to it, where branches that cost time depend on it."""
    return _SpecialisedKernel(function, _OPTIONS)


def array_kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """`kernel` that may create arrays, with reference counts."""
    return _Kernel(function, _WITH_ARRAYS)


def jitable(function: Callable[..., Any]) -> Callable[..., Any]:
    """Let kernels call `function`, which remains an ordinary function in Python."""
    made: Callable[..., Any] = register_jitable(error_model="numpy", fastmath={"contract"})(function)
    return made


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile `function`, which creates no arrays, and keep the machine code on disk.

    It is called from Python, with arrays as `contiguous_array` returns them.
    """
    return _cached(function, _OPTIONS)


def array_entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """`entry` that may create arrays, with reference counts."""
    return _cached(function, _WITH_ARRAYS)


def _cached(function: Callable[..., Any], options: dict[str, Any]) -> Callable[..., Any]:
    folder = cache_folder()
    compile_ = numba.njit(pipeline_class=_EntryCompiler, cache=folder is not None, **options)
    config: Any = numba.config  # its attributes are made at run time
    before = config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES
    config.CACHE_DIR = folder or config.CACHE_DIR
    config.CACHE_LOCATOR_CLASSES = f"{__name__}.{PackageCacheLocator.__name__},{UserProvidedCacheLocator.__name__}"
    try:
        compiled: Callable[..., Any] = compile_(function)
    finally:
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = before
    return compiled


def contiguous_array(array: NDArray[Any]) -> NDArray[Any]:
    """The array, or a copy of it, contiguous, aligned and writable: the only layout that entries accept."""
    # numpy warns when the flag `writeable` of a broadcast view is read
    return array if array.flags.owndata and array.flags.carray else np.array(array, order="C")


@lru_cache(maxsize=1)
def cache_folder() -> str | None:
    """Folder of the compiled kernels: below NUMBA_CACHE_DIR if set, else beside the package, else in the user cache.

    None, with a warning, if none of them is writable.
    """
    name = f"kernels-{_digest(_PACKAGE)}"
    given = os.environ.get("NUMBA_CACHE_DIR")
    user = Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()) / "rocking"
    for parent in [Path(given)] if given else [_PACKAGE / "__pycache__", user]:
        if _is_writable(parent / name):
            return str(parent / name)
    warnings.warn(
        "no writable cache folder for the compiled kernels of rocking: each process compiles them in half a minute; "
        "set NUMBA_CACHE_DIR to a writable folder",
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
    """Digest of what compiled code depends on: processor, Python, numba, and the kernel files with their imports."""
    files = {path.relative_to(package): path.read_bytes() for path in package.rglob("*.py")}
    compiled = re.compile(rb"^@(\w*kernel|jitable|\w*entry)$|numba\.extending", re.M)
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
