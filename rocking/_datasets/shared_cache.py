"""A folder in which processes share what they computed from data sets.

It holds one folder for each data set, with what is known of one version of its file, and what other modules put there.
Everything can be computed again: the folder may be deleted at any time, and where it cannot be written the callers do
without it. What is known of a version is valid for files with the same `FileVersion`, also after a restart: damage that
a disk causes without a write is not noticed as long as the record exists.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO

from rocking._base.version import __version__
from rocking._datasets.checksum import PARTIAL

if sys.platform != "win32":
    import fcntl

LOG = logging.getLogger("rocking._datasets")

MIN_FREE_BYTES = 1_000_000_000
"""Free space of the file system that a large new file leaves for others [bytes]."""

MAX_WRITE_SECONDS = 3600
"""Age from which an unfinished file is taken for that of a killed process [s]."""

RECORD = "version.json"
"""Name of the file with what is known of a version."""


@dataclass(frozen=True)
class KnownVersion:
    """What is known of one version of a data set file.

    Attributes
    ----------
    sha256 : str
        Digest of the file.
    checked : bool
        Whether the data set was read and checked.
    problem : str or None
        Description of its problem, None if it is intact or was not checked.
    """

    sha256: str
    checked: bool = False
    problem: str | None = None


class SharedCache:
    """The cache of the data sets of one results folder.

    Parameters
    ----------
    folder : path
        Folder of the caches of all results folders, created when first needed; only its owner can read what it holds.
    results : path
        The results folder.
    """

    def __init__(self, folder: Path, results: Path) -> None:
        digest = hashlib.sha256(os.fsencode(results.resolve())).hexdigest()
        self._folder = folder / digest[:16]
        self._is_usable = True

    def folder_of(self, name: str) -> Path:
        """Folder of a data set; it need not exist."""
        return self._folder / name.replace("/", "+")  # no name contains a plus sign

    def known(self, name: str, version: tuple[int, ...]) -> KnownVersion | None:
        """What is known of a version of a data set file; None if nothing is."""
        try:
            found = json.loads((self.folder_of(name) / RECORD).read_bytes())
            if (found.pop("version"), found.pop("package")) == ([*version], __version__):
                return KnownVersion(**found)
        except (OSError, ValueError, TypeError, KeyError, AttributeError):
            pass  # missing, or not written by this package
        return None

    def store(self, name: str, version: tuple[int, ...], known: KnownVersion) -> None:
        """Keep what is known of a version of a data set file."""
        record = {"version": version, "package": __version__, **asdict(known)}
        with suppress(OSError), self.replacing(self.folder_of(name) / RECORD, 0) as file:
            file.write(json.dumps(record).encode())

    @contextmanager
    def replacing(self, path: Path, size: int) -> Iterator[IO[bytes]]:
        """A file that gets the name `path`, in the folder of a data set, at the end of the `with` block.

        Parameters
        ----------
        path : path
            Name; an existing file is replaced, other processes keep the one that they have opened.
        size : int
            Its size [bytes].

        Raises
        ------
        OSError
            If it cannot be written, or would leave less than `MIN_FREE_BYTES` on the file system; logged once.
        """
        partial = None
        try:
            path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            if size and shutil.disk_usage(path.parent).free < size + MIN_FREE_BYTES:
                raise OSError(f"less than {(size + MIN_FREE_BYTES) / 1e9:.1f} GB are free")
            with tempfile.NamedTemporaryFile(suffix=PARTIAL, dir=path.parent, delete=False) as file:
                partial = Path(file.name)
                yield file
            partial.replace(path)
        except OSError as error:
            if self._is_usable:
                LOG.warning("the cache %s cannot be used, data sets take private memory: %s", self._folder, error)
            self._is_usable = False
            raise
        finally:
            if partial is not None:
                partial.unlink(missing_ok=True)

    @contextmanager
    def alone(self, name: str) -> Iterator[None]:
        """Other processes that enter this block for the same data set wait, if the file system has locks.

        They then find what this process has stored. Not to be entered twice by one thread.
        """
        folder = self.folder_of(name)
        descriptor = None
        try:
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            descriptor = os.open(folder, os.O_RDONLY)  # fails on Windows
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        except OSError:
            pass  # several processes may do the same work
        try:
            yield
        finally:
            if descriptor is not None:
                os.close(descriptor)

    def remove_others(self, path: Path) -> None:
        """Delete the files beside one that have its suffix, and what a killed process has left unfinished."""
        for other in _entries(path.parent):
            with suppress(OSError):
                is_left = other.suffix == PARTIAL and time.time() - other.stat().st_mtime > MAX_WRITE_SECONDS
                if is_left or (other.suffix == path.suffix and other != path):
                    other.unlink()

    def keep_only(self, names: Collection[str]) -> None:
        """Delete the folders of data sets that do not exist any more."""
        for folder in set(_entries(self._folder)) - {self.folder_of(name) for name in names}:
            shutil.rmtree(folder, ignore_errors=True)


def _entries(folder: Path) -> list[Path]:
    try:
        return [*folder.iterdir()]
    except OSError:
        return []
