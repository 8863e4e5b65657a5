"""Cancellation: a flag that any thread can set, read by searches and by the loops of the kernels.

Functions that may run long have an argument `stop`. They raise `StoppedError` within hundredths of a second, as a rule,
after the flag was set. The arrays that a stopped kernel has written are incomplete.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from rocking._base.errors import StoppedError

T = TypeVar("T")

NEVER_STOPPED = np.zeros(1, np.uint8)  # flag of kernels that are not cancelled


class StopFlag:
    """Requests the end of the work that holds this flag. Once set it remains set.

    Attributes
    ----------
    array : uint8 array (1,)
        Read by the kernels: 0, or 1 when set.
    """

    def __init__(self) -> None:
        self.array: NDArray[np.uint8] = np.zeros(1, np.uint8)
        self._children: list[StopFlag] = []

    def set(self) -> None:
        """Request the end of the work and of its children; from any thread."""
        self.array[0] = 1
        for part in self._children.copy():
            part.set()

    def is_set(self) -> bool:
        """Whether the flag is set."""
        return bool(self.array[0])

    def check(self) -> None:
        """Raise `StoppedError` if the flag is set."""
        if self.array[0]:
            raise StoppedError("the work was cancelled")

    @contextmanager
    def child(self) -> Iterator[StopFlag]:
        """A flag for a part of the work; set together with this one, or separately."""
        part = StopFlag()
        self._children.append(part)
        try:
            if self.is_set():
                part.set()
            yield part
        finally:
            self._children.remove(part)


def run_with_timeout(work: Callable[[StopFlag], T], seconds: float, stop: StopFlag) -> T | None:
    """Part of the work of this thread with a time limit [s], None beyond it; `StoppedError` if `stop` was set."""
    with stop.child() as part:
        timer = threading.Timer(seconds, part.set)
        timer.daemon = True
        timer.start()
        try:
            return work(part)
        except StoppedError:
            stop.check()
            return None
        finally:
            timer.cancel()


def check_stop(stop: StopFlag | None) -> None:
    """Raise `StoppedError` if a flag is given and set."""
    if stop is not None:
        stop.check()


def flag_array(stop: StopFlag | None) -> NDArray[np.uint8]:
    """The array that kernels read."""
    return NEVER_STOPPED if stop is None else stop.array


def _flag_is_set(_: Any, flag: Any) -> Any:
    def lower(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        place = context.make_array(signature.args[0])(context, builder, values[0]).data
        value = builder.load_atomic(place, ordering="monotonic", align=1)
        return builder.icmp_unsigned("!=", value, ir.Constant(value.type, 0))

    return types.boolean(flag), lower


is_stopped: Any = intrinsic(_flag_is_set)
"""is_stopped(array): whether the flag is set, for kernels: an atomic load stays in the loop when it is optimised."""
