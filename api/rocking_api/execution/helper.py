"""Files of foreign formats, read by a helper process with limits of time and memory.

A file of a few bytes can ask for any number of triangles or cells, and a parser in a thread cannot be stopped. There is
one helper, which is started when it is first needed and ends with the request that exceeds its limits.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from pathlib import Path, PurePath
from typing import Any, TypeVar

import anyio
import anyio.to_process
from anyio import BrokenWorkerProcess, CapacityLimiter

from rocking._base.errors import InvalidArgumentError

T = TypeVar("T")

SECONDS = 10  # most time of a file [s]
MEMORY = 1024**3  # most memory beyond that of the modules [bytes]


class Helper:
    """The helper process of a service."""

    def __init__(self) -> None:
        self._limiter = CapacityLimiter(1)

    async def read(self, parameter: str, name: str, read: Callable[..., T], *arguments: Any) -> T:
        """What a function of a module makes of a file; `parameter` and `name` are those of the file in errors.

        Raises `InvalidArgumentError` for a file that exceeds the limits, or that its reader refuses.
        """
        try:
            async with self._limiter:
                with anyio.fail_after(SECONDS):
                    return await anyio.to_process.run_sync(_within_limits, read, *arguments, cancellable=True)
        except (TimeoutError, MemoryError, BrokenWorkerProcess):
            limits = f"a {parameter} that is read within {SECONDS} s and {MEMORY // 1024**2} MiB"
            raise InvalidArgumentError(parameter, name, limits) from None
        except InvalidArgumentError as error:  # which names the temporary file
            raise InvalidArgumentError(parameter, name, error.allowed) from None
        except OSError:
            raise
        except Exception as error:  # noqa: BLE001  # whatever the reader meets in a damaged file
            allowed = f"a file without the defect that its reader found ({type(error).__name__})"
            raise InvalidArgumentError(parameter, name, allowed) from None


def _within_limits(read: Callable[..., T], *arguments: Any) -> T:
    """Call a function in this process, whose memory is bounded from now on."""
    if sys.platform == "linux":
        import resource  # noqa: PLC0415  # other systems do not have it

        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        if hard == resource.RLIM_INFINITY:  # once
            used = int(Path("/proc/self/statm").read_text("ascii").split()[0]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))
    return read(*arguments)


def read_from_file(read: Callable[..., T], raw: bytes, name: str, *arguments: Any) -> T:
    """What a reader that needs a path makes of the bytes of a file; its ending is that of `name`."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"file{PurePath(name).suffix.lower()}"
        path.write_bytes(raw)
        return read(path, *arguments)
