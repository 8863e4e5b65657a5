"""The data set files of a results folder: name, size and sha256, and detection of changed files."""

from __future__ import annotations

import errno
import os
import re
import stat
import threading
import time
from collections.abc import Callable, Hashable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Generic, NamedTuple, Self, TypeVar

import xarray as xr

from rocking._base.errors import DatasetError
from rocking._datasets.checksum import sha256_of
from rocking._datasets.cube import decode_dataset, reject_large

CLOCK_TICK = 20_000_000
"""Changes of a file within this time may have the same time stamp [ns]: file system clocks advance by 1 to 10 ms."""

MAX_READS = 5  # attempts to read a file that changes while it is read [-]

_PART = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")  # one part of a name: neither ".." nor a hidden file


class UnknownDatasetError(KeyError):
    """No data set has this name."""


class FileVersion(NamedTuple):
    """Identifies the content of a file without reading it.

    A file that replaces another one has a different inode. Every write updates the time of change (ctime), which,
    unlike the time of modification, programs cannot set. The following writes are not detected: those after the system
    clock was set back, those on file systems without a time of change, and those through a memory map before the system
    records them.
    """

    device: int
    inode: int
    size: int
    modified: int
    changed: int

    @classmethod
    def of(cls, status: os.stat_result) -> FileVersion:
        """Return the version of a file or folder from its status; times in ns, size in bytes."""
        return cls(status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)

    @property
    def is_settled(self) -> bool:
        """True if any later change is certain to have a different time stamp."""
        return time.time_ns() - self.changed > CLOCK_TICK


def version_of(path: Path) -> FileVersion | None:
    """Return the current version of a file or folder; None if its status cannot be read."""
    try:
        return FileVersion.of(path.stat())
    except OSError:
        return None


@dataclass(frozen=True)
class DatasetFile:
    """One version of a data set file: name (path below the results folder without suffix), size [bytes] and sha256."""

    name: str
    size: int
    sha256: str


class DataFile:
    """An open data set file. All reads are of one version, even if the file is replaced in the meantime.

    `version`: of the file when it was opened or last read. Raises `OSError` if it cannot be opened or is not a
    regular file.
    """

    def __init__(self, name: str, path: Path) -> None:
        self.name = name
        self.path = path
        self._file = open(path, "rb", opener=_open_without_waiting)  # noqa: SIM115  (closed by `close`)
        try:
            self.version = self._settled()
        except BaseException:
            self.close()
            raise

    def fileno(self) -> int:
        """Return the file descriptor."""
        return self._file.fileno()

    def content(self) -> bytes:
        """Read all bytes of the file, of one version.

        Raises `DatasetError` if it cannot be read, is larger than `MAX_FILE_BYTES`, or changes all the time.
        """
        try:
            # the version is the same before and after the read, so that all bytes are of it; else read again
            for _ in range(MAX_READS):
                self.version = self._settled()
                reject_large(self.name, self.version.size)
                self._file.seek(0)
                content = self._file.read()
                if self.is_unchanged():
                    return content
        except OSError as error:
            raise _unreadable(self.name, error) from error
        raise DatasetError(f"{self.name}: changes while it is read; ask again in a moment")

    def is_unchanged(self) -> bool:
        """True if the content is certain to be what was read before.

        The time of change is also updated when the file is replaced or its permissions change; only the bytes show
        whether the content is the same then.
        """
        return FileVersion.of(os.fstat(self.fileno())) == self.version

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _settled(self) -> FileVersion:
        """Return the current version of the file, after a wait while a later version could not be distinguished."""
        status = os.fstat(self.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "not a regular file")
        version = FileVersion.of(status)
        if version.is_settled:
            return version
        time.sleep(CLOCK_TICK / 1e9)
        return FileVersion.of(os.fstat(self.fileno()))


K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class VersionCache(Generic[K, V]):
    """Values computed from files, each valid for one version of its file. Callers hold a lock where they need one."""

    def __init__(self) -> None:
        self._entries: dict[K, tuple[Path, FileVersion, V]] = {}

    def __len__(self) -> int:
        """Number of values that are kept."""
        return len(self._entries)

    def current(self, key: K) -> V | None:
        """Return the value of a key if the file at its path has not changed since; None otherwise."""
        entry = self._entries.get(key)
        if entry is None or entry[1] != version_of(entry[0]):
            return None
        with suppress(KeyError):  # another thread may have removed it
            self._entries[key] = self._entries.pop(key)  # used last
        return entry[2]

    def store(self, key: K, path: Path, version: FileVersion, value: V) -> V:
        """Keep a value that was computed from this version of a file; returns it."""
        self._entries[key] = path, version, value
        return value

    def items(self) -> list[tuple[K, V]]:
        """Return all keys and values; those that were stored or used last are at the end."""
        return [(key, entry[2]) for key, entry in list(self._entries.items())]

    def forget(self, key: K) -> None:
        """Keep the value of a key no longer."""
        self._entries.pop(key, None)

    def value(self, key: K, file: DataFile, compute: Callable[[DataFile], V]) -> V:
        """Return the value of a key for an open file, computed once per version of the file."""
        entry = self._entries.get(key)
        if entry is not None and entry[1] == file.version:
            return entry[2]
        value = compute(file)  # which may read the file, and set its version to the one that was read
        return self.store(key, file.path, file.version, value)


class Catalogue:
    """The data sets below a results folder, which the workflow fills; it need not exist yet."""

    def __init__(self, results: Path | str) -> None:
        self.results = Path(results)
        self.lock = threading.RLock()
        """To be held while a file is read: the netCDF library is not thread-safe."""
        self._products = VersionCache[str, DatasetFile]()

    def names(self) -> list[str]:
        """Names of all data sets, such as `spectra/sine/eta-0.85`, sorted."""
        return self.scan()[0]

    def scan(self) -> tuple[list[str], dict[str, str]]:
        """Names of all data sets, sorted, and why folders cannot be read, by folder; "results" is the root."""
        names: list[str] = []
        unreadable: dict[str, str] = {}
        _scan(self.results, (), frozenset(), names, unreadable)
        return sorted(names), unreadable

    def open(self, name: str) -> DataFile:
        """Open the file of a data set; the caller closes it. Raises `UnknownDatasetError` or `DatasetError`."""
        parts = name.split("/")
        if len(parts) < 2 or not all(_PART.fullmatch(part) for part in parts):
            raise UnknownDatasetError(name)
        path = self.results / f"{name}.nc"
        try:
            return DataFile(name, path)
        except FileNotFoundError as error:
            if path.is_symlink():
                raise _unreadable(name, error) from error
            raise UnknownDatasetError(name) from None
        except OSError as error:
            if error.errno in (errno.ENOTDIR, errno.ENAMETOOLONG):
                raise UnknownDatasetError(name) from None
            raise _unreadable(name, error) from error

    def product(self, name: str) -> DatasetFile:
        """Return size and sha256 of a data set; raises as `open`."""
        with self.open(name) as file:
            return self.product_of(file)

    def product_of(self, file: DataFile) -> DatasetFile:
        """Return size and sha256 of an open data set, computed once per version of the file."""
        with self.lock:
            return self._products.value(file.name, file, self._dataset_file)

    def known_digest(self, file: DataFile) -> str | None:
        """Return the sha256 of an open data set if it was computed for this version of the file before."""
        product = self._products.current(file.name)
        return None if product is None else product.sha256

    def _dataset_file(self, file: DataFile) -> DatasetFile:
        content = file.content()
        return DatasetFile(file.name, len(content), sha256_of(content))

    def dataset(self, name: str) -> tuple[DatasetFile, xr.Dataset]:
        """Read and check a data set; return its version and the data. Raises as `open`, also if it is damaged."""
        with self.open(name) as file, self.lock:
            content = file.content()
            return self.product_of(file), decode_dataset(content, name)


def _scan(
    folder: Path,
    parts: tuple[str, ...],
    above: frozenset[tuple[int, int]],
    names: list[str],
    unreadable: dict[str, str],
) -> None:
    """Collect the data sets below a folder; `above` holds its parent folders, to which symbolic links may lead back."""
    try:
        status = folder.stat()
        identity = status.st_dev, status.st_ino
        entries = [] if identity in above else list(os.scandir(folder))
    except FileNotFoundError:
        return
    except OSError as error:
        unreadable["/".join(parts) or "results"] = f"cannot be read: {error.strerror}"
        return
    for entry in entries:
        if not _PART.fullmatch(entry.name) or entry.name.endswith(".zarr"):  # a store has thousands of files
            continue
        inner = *parts, entry.name
        if parts and entry.name.endswith(".nc"):
            names.append("/".join(inner).removesuffix(".nc"))
        elif _may_be_folder(entry):
            _scan(folder / entry.name, inner, above | {identity}, names, unreadable)


def _may_be_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # such as a loop of symbolic links; reading the folder gives the reason
        return True


def _open_without_waiting(path: str, flags: int) -> int:
    """Open without blocking: opening a named pipe would wait for a writer."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _unreadable(name: str, error: OSError) -> DatasetError:
    return DatasetError(f"{name}: cannot be read: {error.strerror}")
