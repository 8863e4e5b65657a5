"""The compiled kernels of the solver: loaded when the service starts, after compilation if necessary.

A separate process compiles: in a thread the compiler would hold the interpreter lock for tenths of a second, which
blocks the event loop. This process then loads the machine code in a thread; /health takes at most 0.02 s meanwhile, as
the garbage collector does not scan the imported modules (see `server`); with it, one pause takes 0.2 to 0.3 s.
"""

from __future__ import annotations

import asyncio
import logging
import sys

import anyio
import anyio.to_thread

from rocking.precompile import is_missing, load_kernels

LOG = logging.getLogger("rocking.service")


class NotReadyError(RuntimeError):
    """The kernels are still being compiled; the client may retry."""


def compile_command() -> list[str] | None:
    """The command that compiles the kernels, which is logged; None if they are in the cache."""
    if not is_missing():
        return None
    LOG.info("compiling the kernels, up to a minute; requests wait for it")
    return [sys.executable, "-m", "rocking.precompile"]


class Kernels:
    """State of the kernels."""

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._loading: asyncio.Future[None] | None = None
        self.is_loaded = True

    async def load(self) -> None:
        """Load them."""
        self._loading, self.is_loaded = asyncio.get_running_loop().create_future(), False
        try:
            if (command := compile_command()) is not None:
                compiled = await anyio.run_process(command, check=False)
                if compiled.returncode:
                    LOG.warning("the compiler failed: %s", compiled.stderr.decode())
            await anyio.to_thread.run_sync(load_kernels, abandon_on_cancel=True)
        finally:
            self.is_loaded = True
            self._loading.cancel()  # waiting requests continue, and meet the same error if there is one

    async def wait(self) -> None:
        """Return once they are loaded; usually at once."""
        if self._loading is None or self.is_loaded:
            return
        await asyncio.wait({self._loading}, timeout=self._seconds)
        if not self._loading.done():
            raise NotReadyError("the solver is being compiled; retry in a minute")
