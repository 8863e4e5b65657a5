"""A disk on which nothing more than the first bytes of a file have room."""

from collections.abc import Iterator
from contextlib import contextmanager

ROOM = 100  # length that a file may have [bytes], less than any output


@contextmanager
def full_disk() -> Iterator[None]:
    """In the block, files of this process cannot be written beyond their first `ROOM` bytes.

    The system refuses the rest of a write in its middle, as on a full disk, because of a limit of the sizes of files.
    """
    import resource  # noqa: PLC0415  (not on every system)

    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (ROOM, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
