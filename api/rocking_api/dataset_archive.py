"""Data sets as one zip archive, which is made while it is sent: no more than one file is held."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator

from rocking._base.errors import DatasetError
from rocking._datasets.catalogue import Catalogue, UnknownDatasetError
from rocking._datasets.netcdf import find_damage, sha256_of

OLDEST = 1980, 1, 1, 0, 0, 0
"""Time stamp of all files in the archive, the first that zip knows: equal files give equal bytes."""


CHUNK_BYTES = 128 * 1024  # bytes that are sent at once


class _Sink(bytearray):
    """A file without positions, which keeps what is written until it is taken."""

    def write(self, data: bytes) -> int:
        self.extend(data)
        return len(data)

    def flush(self) -> None:
        """Nothing is buffered elsewhere."""

    def taken(self) -> bytes:
        """All bytes since the last call."""
        found = bytes(self)
        self.clear()
        return found


def archive(catalogue: Catalogue, names: list[str]) -> Iterator[bytes]:
    """The parts of a zip archive of the netCDF files of data sets, and at its end SHA256SUMS of what it holds.

    A data set that is damaged, cannot be read or is removed meanwhile is left out.
    """
    sink, sums = _Sink(), ""
    with zipfile.ZipFile(sink, "w") as target:  # type: ignore[call-overload]  # needs no more than `write` and `flush`
        for name in names:
            try:
                with catalogue.open(name) as file:
                    content = file.content()
            except (UnknownDatasetError, DatasetError):
                continue
            if find_damage(content) is not None:
                continue
            sums += f"{sha256_of(content)}  {name}.nc\n"
            info = zipfile.ZipInfo(f"{name}.nc", OLDEST)
            info.file_size = len(content)  # beyond 2 GiB an entry needs another header
            with target.open(info, "w") as entry:  # stored: it is compressed already
                for start in range(0, len(content), CHUNK_BYTES):
                    entry.write(content[start : start + CHUNK_BYTES])
                    yield sink.taken()
        target.writestr(zipfile.ZipInfo("SHA256SUMS", OLDEST), sums)
    yield sink.taken()
