"""The cache of machine code on disk: one folder for each state of the sources, in it one for each entry.

The cache of numba tracks the file of the called function, its place and its time, not the files of the kernels that it
calls. Here the name of the folder contains a digest of the sources of the kernels, of the modules of this package that
they import, and of the versions of the other packages: a change in any of them leads to recompilation.

numba loads whatever it finds, and fails where it cannot write. Here the folder of an entry holds a digest of its files,
which is compared before they are loaded: what is damaged is made again; where the folder cannot be written, the entry
is compiled in each process. Either gives one warning in a process.
"""

import ast
import gc
import hashlib
import os
import shutil
import sys
import tempfile
import threading
import time
import uuid
import warnings
from collections.abc import Callable, Iterable
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol

import llvmlite  # type: ignore[import-untyped]
import numba
import numpy as np
from llvmlite import binding

from rocking._base.source_tree import SourceTree, imported_names
from rocking._numba.way import INTERNALS

PACKAGE = Path(__file__).parents[1]

DIGEST = "sha256"  # file with the digest of the other files of an entry

COMPLETE = "complete"
"""File in the folder of a state that marks it as complete: it serves where it can only be read, as in an installation
of another user or in a container."""

LATENCY = 1.0
"""How long the files of an entry may differ from their digest [s]: a process writes them first, then the digest."""

COMPILERS = {"numba", "llvmlite"}  # modules that import one of these are part of what is compiled,

DECORATORS = {"kernel", "specialised_kernel", "array_kernel", "jitable", "entry", "light_entry", "array_entry"}
"""and those with a function that one of these names of `rocking._numba.compilation` decorates."""

MADE_WITH = (llvmlite, np, numba)
"""Packages that modules with compiled code import: their versions count, not their files."""

NOT_KEPT = threading.Event()  # set when machine code was compiled that could not be written to the disk

_WARNED = threading.Event()


class Make(Protocol):
    """Makes the compiled form of a function; it compiles when it is called."""

    def __call__(self, *, cache: bool) -> Any:
        """With `cache`, its machine code is kept in `numba.config.CACHE_DIR`."""


@lru_cache(maxsize=1)
def cache_folder() -> str | None:
    """Folder of the compiled kernels: below NUMBA_CACHE_DIR if set, else beside the package, else in the user cache.

    None, with a warning, if none of them is writable or, by the faster way, complete.
    """
    given = os.environ.get("NUMBA_CACHE_DIR")
    user = Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()) / "rocking"
    parents = [Path(given)] if given else [PACKAGE / "__pycache__", user]
    sources = SourceTree(PACKAGE.parent, {PACKAGE.name})
    # a file in the folder tells for which state of the whole package it is: imports are followed once for each state
    marker = f"sources-{_digest(sources, sources.package())}"
    known = (found.parent.name for parent in parents for found in parent.glob(f"kernels-*/{marker}"))
    name = next(known, None) or f"kernels-{kernel_digest(sources)}"
    for parent in parents:
        if _is_writable(parent / name, marker) or _can_be_read(parent / name):
            return str(parent / name)
    _warn_not_kept("no cache folder is writable")
    return None


def kernel_digest(sources: SourceTree) -> str:
    """Digest of what compiled code depends on: processor, Python, `MADE_WITH`, kernel files with what they import here.

    The processor is the machine's, or the one that NUMBA_CPU_NAME and NUMBA_CPU_FEATURES name: the folder is then
    found on every machine.
    """
    collecting = gc.isenabled()
    gc.disable()  # the syntax trees are kept: to look for garbage among them takes half of the time
    try:
        compiled = [path for path in sources.package() if _is_compiled(sources, path)]
        return _digest(sources, sources.files(*compiled))
    finally:
        if collecting:
            gc.enable()


def keep_on_disk(make: Make, function: Callable[..., Any]) -> Any:
    """The compiled form of a function, with its machine code in the folder of the kernels if that is writable."""
    parent = cache_folder()
    if parent is None:
        return make(cache=False)
    folder = Path(parent, f"{function.__module__}.{function.__qualname__.replace('<locals>.', '')}")
    if not _is_writable(folder) and not _can_be_read(Path(parent)):
        _warn_not_kept(f"{folder} is not writable")
        return make(cache=False)
    config: Any = numba.config  # its attributes are made at run time
    before, config.CACHE_DIR = config.CACHE_DIR, str(folder)
    try:
        compiled = make(cache=True)
    finally:
        config.CACHE_DIR = before
    load_or_compile = compiled.compile

    def compile_checked(signature: Any) -> Any:
        known = compiled.stats.cache_misses.total()
        try:
            _remove_if_damaged(folder)
            entry_point = load_or_compile(signature)
            if compiled.stats.cache_misses.total() > known:
                _write_digest(folder)
            return entry_point
        except OSError as error:
            shutil.rmtree(folder, ignore_errors=True)
            _warn_not_kept(str(error))
        if compiled.stats.cache_misses.total() > known:
            return load_or_compile(signature)  # numba has compiled it: it writes last
        # it failed before: compile without the disk
        uncached = make(cache=False)
        uncached.compile(signature)
        (overload,) = uncached.overloads.values()
        compiled.add_overload(overload)
        return overload.entry_point

    compiled.compile = compile_checked  # numba calls it for each new combination of types of the arguments
    return compiled


def _remove_if_damaged(folder: Path) -> None:
    """Remove the folder of an entry if its files remain different from their digest."""
    end = time.monotonic() + LATENCY
    while not _is_intact(folder):
        if time.monotonic() > end:
            removed = folder.with_name(f"{folder.name}.{uuid.uuid4().hex}")
            folder.rename(removed)  # at once for all processes
            shutil.rmtree(removed, ignore_errors=True)
            _warn(f"the compiled kernels of rocking in {folder} were damaged: they are compiled again")
            return
        time.sleep(0.05)


def _is_intact(folder: Path) -> bool:
    """Whether the files of an entry, if there are any, are those that were written."""
    try:
        found = _files_digest(folder)
        return found is None or (folder / DIGEST).read_text() == found
    except (OSError, ValueError):
        return False


def _write_digest(folder: Path) -> None:
    while not _is_intact(folder):  # another process may have written its files after the digest was taken
        temporary = folder / f"{DIGEST}.tmp.{uuid.uuid4().hex}"
        temporary.write_text(str(_files_digest(folder)))
        temporary.replace(folder / DIGEST)


def _files_digest(folder: Path) -> str | None:
    """Digest of the files that numba has written, None if there are none."""
    digest = hashlib.sha256()
    files = [path for path in folder.rglob("*") if path.is_file() and path.name != DIGEST and ".tmp." not in path.name]
    for path in sorted(files):
        content = path.read_bytes()
        digest.update(f"{path.name} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest() if files else None


def _is_compiled(sources: SourceTree, path: Path) -> bool:
    if b"numba" not in sources.content(path):  # a tenth of a second less than to parse all files
        return False
    syntax = sources.syntax(path)
    modules = {(base or name).partition(".")[0] for name, base, _ in imported_names(syntax)}
    functions = [node for node in syntax.body if isinstance(node, ast.FunctionDef)]
    decorators = {one.id for node in functions for one in node.decorator_list if isinstance(one, ast.Name)}
    return bool(modules & COMPILERS or decorators & DECORATORS)


def _digest(sources: SourceTree, files: Iterable[Path]) -> str:
    config: Any = numba.config
    name = binding.get_host_cpu_name() if config.CPU_NAME is None else config.CPU_NAME
    features = binding.get_host_cpu_features().flatten() if config.CPU_FEATURES is None else config.CPU_FEATURES
    way = "plain" if INTERNALS is None else "faster"
    made_by = sys.version, *(f"{one.__name__} {one.__version__}" for one in MADE_WITH), way, name, features
    return hashlib.sha256("\n".join([*made_by, sources.digest_of(files)]).encode()).hexdigest()[:16]


def _is_writable(folder: Path, marker: str | None = None) -> bool:
    """Whether files can be made in a folder; a missing folder is made, and an empty file `marker` in it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
        if marker is not None:
            (folder / marker).touch()
    except OSError:
        return False
    return True


def _can_be_read(folder: Path) -> bool:
    """Whether it holds all entries; the plain way writes into each."""
    return INTERNALS is not None and (folder / COMPLETE).exists()


def _warn_not_kept(reason: str) -> None:
    NOT_KEPT.set()
    _warn(
        f"the compiled kernels of rocking cannot be kept on disk ({reason}): each process compiles them, in half a "
        "minute; set NUMBA_CACHE_DIR to a writable folder with 10 MB of free space"
    )


def _warn(text: str) -> None:
    if not _WARNED.is_set():
        _WARNED.set()
        warnings.warn(text, RuntimeWarning, stacklevel=3)
