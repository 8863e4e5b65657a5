"""Output files that people name: an existing file is replaced as a whole, or stays as it is."""

from __future__ import annotations

import errno
import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

from rocking._base.errors import InvalidArgumentError

PARTIAL = ".partial"
"""Suffix of a file that is being written; a process that is killed leaves it behind."""

MODE = 0o666  # of a new file, less what the process denies to others


@contextmanager
def replacement_of(path: str | PathLike[str]) -> Iterator[Path]:
    """Yield an empty temporary file beside `path`, which replaces it at the end of the `with` block.

    If the block raises, or the content does not reach the disk, an existing file stays as it is and the temporary file
    is deleted. An existing file keeps its mode, and a symbolic link its name: the file behind it is replaced. What is
    not a regular file, such as a pipe or /dev/stdout, cannot be replaced, and is yielded itself.

    Parameters
    ----------
    path : path
        The file to write. Its folder must exist and allow new files.

    Raises
    ------
    OSError
        If the file or its folder cannot be written.
    """
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_file():
        yield target
        return
    if target.exists() and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    temporary = target.with_name(f".rocking-{secrets.token_hex(8)}{PARTIAL}")
    os.close(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, MODE))
    try:
        if target.exists():
            temporary.chmod(stat.S_IMODE(target.stat().st_mode))
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def write_output(path: str | PathLike[str], content: str | bytes) -> None:
    """Write a whole file by `replacement_of`; text is encoded as UTF-8, with its line ends as they are."""
    with replacement_of(path) as temporary:
        temporary.write_bytes(content.encode() if isinstance(content, str) else content)


@contextmanager
def output_errors(parameter: str, path: str | PathLike[str]) -> Iterator[None]:
    """Convert an error of the system, such as a full disk, into an `InvalidArgumentError` of the file's argument."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        raise InvalidArgumentError(parameter, str(path), f"a file that can be written ({reason})") from None
