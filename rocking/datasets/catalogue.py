"""The files of a results folder: data sets by name, with size and sha256, noticed when they change."""

from __future__ import annotations

import errno
import hashlib
import os
import re
import stat
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

import xarray as xr

from rocking.datasets.cube import decode_dataset
from rocking.errors import DatasetError

CLOCK_TICK = 20_000_000
"""Within this, two changes of a file may bear the same time [ns]: the clocks of file systems tick every 1 to 10 ms."""

MAX_READS = 5
"""Attempts to read a file that changes meanwhile [-]."""

_PART = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")  # of a name: no "..", nothing hidden


class UnknownDatasetError(KeyError):
    """There is no data set of this name."""


class FileVersion(NamedTuple):
    """What identifies the bytes of a file without reading them.

    A file put in its place has another inode, and every write moves the time of change (ctime), which no program can
    set as it can the time of modification. Not noticed are: writes after the clock of the machine was set back, writes
    on file systems that keep no time of change, and writes through a memory map before the system records them.
    """

    device: int
    inode: int
    size: int
    modified: int
    changed: int

    @classmethod
    def of(cls, status: os.stat_result) -> FileVersion:
        """The version that a file, or a folder, has by its status; times in ns, size in bytes."""
        return cls(status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)

    @property
    def is_settled(self) -> bool:
        """Whether a later change is certain to bear another time."""
        return time.time_ns() - self.changed > CLOCK_TICK


def version_of(path: Path) -> FileVersion | None:
    """The version of the file, or folder, that lies there now; None if that cannot be told."""
    try:
        return FileVersion.of(path.stat())
    except OSError:
        return None


@dataclass(frozen=True)
class DatasetFile:
    """One version of a data set file: its name (path below the folder, without suffix), size [bytes] and sha256."""

    name: str
    size: int
    sha256: str


class DataFile:
    """An open data set file. What is read from it is of one version, whatever is put in its place meanwhile.

    Parameters
    ----------
    name : str
        Of the data set.
    path : path
        Of its file.

    Attributes
    ----------
    version : FileVersion
        Of the file when it was opened, or last read.

    Raises
    ------
    OSError
        If it cannot be opened, or is no regular file.
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
        """The descriptor."""
        return self._file.fileno()

    def content(self) -> bytes:
        """All bytes, as they were at one moment.

        Raises
        ------
        DatasetError
            If they cannot be read, or the file changes again and again.
        """
        try:
            for _ in range(MAX_READS):
                self.version = self._settled()
                self._file.seek(0)
                content = self._file.read()
                if self.is_unchanged():
                    return content
        except OSError as error:
            raise _unreadable(self.name, error) from error
        raise DatasetError(f"{self.name}: changes while it is read; ask again in a moment")

    def is_unchanged(self) -> bool:
        """Whether the file is certain to hold what was read from it.

        Its time of change also moves when its name goes to another file, or its permissions change: then only the bytes
        tell.
        """
        return FileVersion.of(os.fstat(self.fileno())) == self.version

    def close(self) -> None:
        """Close the descriptor."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _settled(self) -> FileVersion:
        """The version of the file now, told apart from those to come."""
        status = os.fstat(self.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "not a regular file")
        version = FileVersion.of(status)
        if version.is_settled:
            return version
        time.sleep(CLOCK_TICK / 1e9)
        return FileVersion.of(os.fstat(self.fileno()))


class Catalogue:
    """The data sets below a results folder.

    Parameters
    ----------
    results : path
        Folder that the workflow fills; it need not exist yet.
    """

    def __init__(self, results: Path | str) -> None:
        self.results = Path(results)
        self.lock = threading.RLock()
        """To be held while a file is read: the netCDF library is not safe for threads."""
        self._products: dict[str, tuple[FileVersion, DatasetFile]] = {}

    def names(self) -> list[str]:
        """Names of all data sets, such as `spectra/sine/eta-0.85`, sorted."""
        return self.scan()[0]

    def scan(self) -> tuple[list[str], dict[str, str]]:
        """Names of all data sets, sorted, and why which folders cannot be read; "results" stands for all of it."""
        names: list[str] = []
        unreadable: dict[str, str] = {}
        _scan(self.results, (), frozenset(), names, unreadable)
        return sorted(names), unreadable

    def open(self, name: str) -> DataFile:
        """The file of a data set, to be closed by the caller.

        Raises
        ------
        UnknownDatasetError
            If there is no data set of that name.
        DatasetError
            If its file cannot be read.
        """
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
        """Size and sha256 of a data set.

        Raises
        ------
        UnknownDatasetError, DatasetError
            As `open`.
        """
        with self.open(name) as file:
            return self.product_of(file)

    def product_of(self, file: DataFile) -> DatasetFile:
        """Size and sha256 of an open data set, computed once per version of the file.

        Raises
        ------
        DatasetError
            As `DataFile.content`.
        """
        with self.lock:
            known = self._products.get(file.name)
            if known is None or known[0] != file.version:
                digest = hashlib.sha256(file.content()).hexdigest()
                known = self._products[file.name] = file.version, DatasetFile(file.name, file.version.size, digest)
            return known[1]

    def dataset(self, name: str) -> tuple[DatasetFile, xr.Dataset]:
        """A data set, read into memory and checked, and which version of it that is.

        Raises
        ------
        UnknownDatasetError
            If there is no data set of that name.
        DatasetError
            If it is damaged, or cannot be read.
        """
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
    """Collect the data sets below a folder; `above` identifies the folders around it, to which links may lead back."""
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
        if not _PART.fullmatch(entry.name):
            continue
        inner = *parts, entry.name
        if parts and entry.name.endswith(".nc"):
            names.append("/".join(inner).removesuffix(".nc"))
        elif _may_be_folder(entry):
            _scan(folder / entry.name, inner, above | {identity}, names, unreadable)


def _may_be_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # a loop of links, say; the reason comes with the attempt to read it
        return True


def _open_without_waiting(path: str, flags: int) -> int:
    """A pipe in place of a file is opened at once too, rather than when somebody writes to it."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _unreadable(name: str, error: OSError) -> DatasetError:
    return DatasetError(f"{name}: cannot be read: {error.strerror}")
