"""The faster way to compile kernels, by names of numba that are not public; all of them are in this file.

An entry, which Python calls, is one module with all the kernels that it calls.

Reason for the single module: numba compiles each kernel as a separate library and links a copy of it, as a weak symbol,
into each caller, where it is optimised again. A process that compiles uses the strong symbol of the separate library; a
process that loads the caller from the cache has only the copy. Both are correct, but the second optimisation may fuse
other multiplications and additions, so that results differed in the last bits between the two processes. Here the
copies have internal linkage in the module of the entry, and every process runs the same instructions.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import UserProvidedCacheLocator
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher
from numba.core.targetconfig import ConfigStack
from numba.core.types.functions import BaseFunction
from numba.core.types.npytypes import Record

_PACKAGE = Path(__file__).parents[1]


def _with_private(options: dict[str, Any], *, arrays: bool) -> dict[str, Any]:
    """The options, without reference counts of arrays where none are created.

    numba counts the references to an array argument with atomic operations in each function that is not inlined: a
    fifth of the time of a rigid block.
    """
    return options if arrays else options | {"_nrt": False}


class _SingleModuleLibrary(JITCodeLibrary):
    """A library in which the copies of other kernels have internal linkage and names of their own.

    The linker of numba finds internal functions by name, too: the first one that it has loaded. The copy of a kernel in
    an entry is compiled for the calls of the entry, perhaps with fewer arguments. Under its own name it would be called
    by any kernel that Python calls; names agree within a process, and by chance between the processes that compile and
    load an entry, since they contain a running number. The functions that count references keep their names: they are
    the same everywhere, and the pass that removes pairs of them finds them by name (kernels took 1.7 times the time).
    """

    opt: int | None = None
    """LLVM's level of optimisation; None: numba's passes. Another one changes last digits of slender peaks."""

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
        if self.opt is None:
            super()._optimize_final_module()
        else:
            manager, builder = self._codegen._module_pass_manager(opt=self.opt)
            manager.run(self._final_module, builder)


class _LightLibrary(_SingleModuleLibrary):
    """The library of an entry that gains nothing where LLVM inlines and unrolls more."""

    opt = 1


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


@contextmanager
def _remembering(kind: Any, name: str, key: Callable[..., Any]) -> Iterator[None]:
    """Let numba call a method of `kind` once for each `key` of its arguments, until the block ends."""
    method, known = getattr(kind, name), {}

    def remembered(*args: Any) -> Any:
        call = key(*args)
        if call not in known:
            known[call] = method(*args)
        return known[call]

    setattr(kind, name, remembered)
    try:
        yield
    finally:
        setattr(kind, name, method)


def _call(function: Any, _: Any, args: Any, kws: Any) -> tuple[Any, ...]:
    """What the signature of a call depends on."""
    return function, tuple(args), tuple(kws.items()), ConfigStack.top_or_none()


def _itself(record: Any) -> Any:
    return record


class _KernelCompiler(Compiler):
    """The compiler of numba with another library: here of the kernels inside entries."""

    library: type[JITCodeLibrary] = _LinkedLibrary

    def compile_extra(self, func: Any) -> Any:
        self.state.library = self.library(self.state.targetctx.codegen(), func.__qualname__)
        self.state.library.enable_object_caching()
        return super().compile_extra(func)


class _EntryCompiler(_KernelCompiler):
    """Compiler of entries.

    Garbage is not collected meanwhile: compilation makes millions of objects and keeps most of them. numba looks
    through all implementations of an operation at each place where a kernel has it, and writes out the types of the
    arguments of a kernel at each pass: here once for each combination of types, in a quarter less time.
    """

    library = _SingleModuleLibrary

    def compile_extra(self, func: Any) -> Any:
        collecting = gc.isenabled()
        gc.disable()
        try:
            with _remembering(BaseFunction, "get_call_type", _call), _remembering(Record, "__repr__", _itself):
                return super().compile_extra(func)
        finally:
            if collecting:
                gc.enable()


class _LightEntryCompiler(_EntryCompiler):
    """Compiler of light entries."""

    library = _LightLibrary


class PackageCacheLocator(UserProvidedCacheLocator):
    """Where numba keeps the entries of this package: in files that do not depend on where and when it was installed.

    numba finds it by its name; any other file has the place and the time of numba's own cache.
    """

    def get_cache_path(self) -> str:
        """The folder that was set for the entry."""
        return str(Path(self._cache_path))

    def ensure_cache_path(self) -> None:
        """Nothing: numba would refuse a folder that can only be read."""

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        """None: numba's own, a digest of the path, fails for a path that the locale cannot express."""
        del py_file
        return ""

    def get_source_stamp(self) -> str:
        """The same at any time: the name of the folder depends on the sources."""
        return ""

    @classmethod
    def from_function(cls, function: Callable[..., Any], file: str) -> PackageCacheLocator | None:
        """The locator, or None for a function outside this package."""
        return cls(function, file) if Path(file).is_relative_to(_PACKAGE) else None


def entry(function: Callable[..., Any], options: dict[str, Any], *, arrays: bool, light: bool, cache: bool) -> Any:
    """Compile `function` as one module, with a cache in `numba.config.CACHE_DIR`; `light`: optimised less."""
    config: Any = numba.config  # its attributes are made at run time
    before = config.CACHE_LOCATOR_CLASSES
    config.CACHE_LOCATOR_CLASSES = f"{__name__}.{PackageCacheLocator.__name__},{UserProvidedCacheLocator.__name__}"
    try:
        options = _with_private(options, arrays=arrays)
        compiler = _LightEntryCompiler if light else _EntryCompiler
        return numba.njit(pipeline_class=compiler, cache=cache, **options)(function)
    finally:
        config.CACHE_LOCATOR_CLASSES = before


_CONSTANTS = (numba.types.IntegerLiteral, numba.types.BooleanLiteral)


class Kernel(CPUDispatcher):
    """A kernel: inside entries code to be linked; from Python a function of its own, compiled when it is called."""

    def __init__(self, function: Callable[..., Any], options: dict[str, Any], *, arrays: bool) -> None:
        options = _with_private(options, arrays=arrays)
        inside = options | {"nopython": True, "no_cpython_wrapper": True}
        super().__init__(py_func=function, targetoptions=inside, pipeline_class=_KernelCompiler)
        self._from_python = lru_cache(maxsize=1)(lambda: numba.njit(**options)(function))

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """The signature of a call in a kernel; one for all integers, not one for each constant that kernels pass."""
        plain = [numba.types.unliteral(arg) if isinstance(arg, _CONSTANTS) else arg for arg in args]
        return super().get_call_template(plain, kws)

    def __call__(self, *args: Any) -> Any:
        return self._from_python()(*args)


class SpecialisedKernel(Kernel):
    """A kernel that is compiled for each constant that kernels pass."""

    get_call_template = CPUDispatcher.get_call_template
