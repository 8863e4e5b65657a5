"""What each process of the server runs: `application`, which uvicorn calls."""

from __future__ import annotations

import gc
import sys

from fastapi import FastAPI

from rocking_api.app import create_app
from rocking_api.settings import Settings

GC_THRESHOLD = 20_000  # net allocations that start a garbage collection [-]

SWITCH_INTERVAL = 0.0005
"""Time after which a thread of Python passes the interpreter lock to one that waits for it [s]; the default is 0.005.

The event loop waits that long after each read from a connection while another thread parses a body. Under 64 uploads of
5 MB `/health` takes 0.008 s in the median rather than 0.017 to 0.030 s, on two busy cores.
"""


def application() -> FastAPI:
    """The service with the settings of the environment.

    Imported objects, and the kernels once they are loaded, are excluded from garbage collection: a full collection of
    them stops the event loop for 0.1 to 0.3 s.
    """
    sys.setswitchinterval(SWITCH_INTERVAL)
    gc.collect()
    gc.freeze()
    gc.set_threshold(GC_THRESHOLD)
    return create_app(Settings(), when_ready=gc.freeze)
