"""Files of clients, read in processes of their own with limits of time and memory.

A file of a few bytes can ask for any number of triangles or cells, and a parser in a thread cannot be stopped. The
module of such a process calls `print_result`; it loads little, because loading the package takes longer than reading.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from rocking._base.errors import InvalidArgumentError

if TYPE_CHECKING:
    from rocking._numba.cancellation import StopFlag

SECONDS = 10  # most processor time of a file [s]
MEMORY = 1024**3  # most memory beyond that of the modules [bytes]
_POLL = 0.1  # time between two looks at the stop flag [s]


def result_of(
    module: str, raw: bytes, parameter: str, name: str, stop: StopFlag, options: tuple[str, ...] = ()
) -> dict[str, Any]:
    """What the process of a module prints for the path of a file with these bytes, and options."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"file{PurePath(name).suffix.lower()}"
        path.write_bytes(raw)
        code, output = _run([sys.executable, "-m", module, str(path), *options], stop)
    limits = f"a {parameter} that is read within {SECONDS} s and {MEMORY // 1024**2} MiB"
    found: dict[str, Any] = {"allowed": limits} if code else json.loads(output)
    if "allowed" in found:
        raise InvalidArgumentError(parameter, name, found["allowed"])
    return found


def _run(command: list[str], stop: StopFlag) -> tuple[int, bytes]:
    """Exit code and output of a process, which ends with the flag."""
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    with subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment
    ) as process:
        try:
            while True:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    output, _ = process.communicate(timeout=_POLL)
                    return process.returncode, output
                stop.check()
        finally:
            process.kill()


def print_result(read: Callable[[], dict[str, Any]]) -> None:
    """Print what is read within the limits, or what is allowed."""
    _limit()
    try:
        found = read()
    except InvalidArgumentError as error:
        found = {"allowed": error.allowed}
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001  (of the reader of a damaged file: no limit was exceeded)
        found = {"allowed": f"a file without the defect that its reader found ({type(error).__name__})"}
    sys.stdout.write(json.dumps(found))


def _limit() -> None:
    """Bound what this process may use from here on; elsewhere than on Linux the time limit of requests remains."""
    if sys.platform == "linux":
        import resource  # noqa: PLC0415  (other systems do not have it)

        used = int(Path("/proc/self/statm").read_text("ascii").split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))
        spent = resource.getrusage(resource.RUSAGE_SELF)
        seconds = SECONDS + int(spent.ru_utime + spent.ru_stime)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
