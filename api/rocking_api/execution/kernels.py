"""The compiled kernels of the solver: loaded when the service starts, compiled before if need be.

The compiler works in a process of its own: in a thread it would hold Python's lock for tenths of a second at a time, in
which nothing is answered. This process then loads the machine code, in a thread.
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
    """The kernels are still being compiled: to be asked again later."""


class Kernels:
    """Whether they are loaded.

    Parameters
    ----------
    seconds : float
        How long a request waits for them [s].
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._loading: asyncio.Future[None] | None = None

    async def load(self) -> None:
        """Load them."""
        self._loading = asyncio.get_running_loop().create_future()
        try:
            if is_missing():
                LOG.info("the kernels are compiled, up to a minute; questions wait for it")
                compiled = await anyio.run_process([sys.executable, "-m", "rocking.precompile"], check=False)
                if compiled.returncode:
                    LOG.warning("the compiler failed", extra={"fields": {"stderr": compiled.stderr.decode()}})
            await anyio.to_thread.run_sync(load_kernels, abandon_on_cancel=True)
        finally:
            self._loading.cancel()  # who waits goes on, and meets the same error if there is one

    async def wait(self) -> None:
        """Return once they are loaded, at once as a rule.

        Raises
        ------
        NotReadyError
            If that takes too long.
        """
        if self._loading is None or self._loading.done():
            return
        await asyncio.wait({self._loading}, timeout=self._seconds)
        if not self._loading.done():
            raise NotReadyError("the solver is being compiled; ask again in a minute")
