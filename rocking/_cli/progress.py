"""An indicator on stderr while a command computes for more than a second."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager

DELAY = 1.0  # time after which the indicator appears [s]; commands that are faster do not load what it needs
REFRESH = 0.2  # time between updates of the indicator [s]
LONG = 4.0  # time after which the indicator says that first calls are longer [s]


@contextmanager
def progress(text: str) -> Iterator[Callable[[float], None]]:
    """Show `text` and the elapsed time on a terminal until the block ends; nothing if stderr is piped."""
    ended = threading.Event()
    shares: deque[float] = deque(maxlen=1)
    shown = threading.Thread(target=_show, args=(text, shares, ended), daemon=True)
    shown.start()
    try:
        yield shares.append
    finally:
        ended.set()
        shown.join()


def _show(text: str, shares: deque[float], ended: threading.Event) -> None:
    """Show the indicator from `DELAY` on until the work has ended."""
    begin = time.monotonic()
    if ended.wait(DELAY):
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal or ended.is_set():
        return
    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    # the results go to stdout, which must not pass through the console of the indicator
    with Progress(*columns, console=console, transient=True, redirect_stdout=False, redirect_stderr=False) as shown:
        task = shown.add_task(text, total=None)
        shown.tasks[0].start_time = begin
        while not ended.wait(REFRESH):
            note = f", {100.0 * shares[-1]:.0f} %" if shares else ""
            if time.monotonic() - begin > LONG and not note:
                note = " (the first calls compile parts of the solver)"
            shown.update(task, description=text + note)
