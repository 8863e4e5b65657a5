"""An indicator on stderr while a command computes for more than a second."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

DELAY = 1.0
"""Time after which the indicator appears [s]."""

LONG = 4.0
"""Time after which the indicator says that first calls are longer [s]."""


@contextmanager
def progress(text: str) -> Iterator[None]:
    """Show `text` and the elapsed time on a terminal until the block ends; nothing if stderr is piped.

    Parameters
    ----------
    text : str
        What is done.
    """
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield
        return
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    # the results go to stdout, which must not pass through the console of the indicator
    shown = Progress(*columns, console=console, transient=True, redirect_stdout=False, redirect_stderr=False)
    task = shown.add_task(text, total=None)
    ended, lock = threading.Event(), threading.Lock()

    def start() -> None:
        if not ended.wait(DELAY):
            with lock:
                if not ended.is_set():
                    shown.start()
        if not ended.wait(LONG):
            shown.update(task, description=f"{text} (the first calls compile parts of the solver)")

    waiting = threading.Thread(target=start, daemon=True)
    waiting.start()
    try:
        yield
    finally:
        with lock:
            ended.set()
            shown.stop()
        waiting.join()
