"""A service over the results folder while the guide is built, for the example that asks a server."""

from __future__ import annotations

import atexit
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

SECONDS = 120
"""Time for the service to start [s]."""


def start(app: Any) -> None:
    """Start `rocking serve` on a free port unless ROCKING_SERVER names a service, and wait until it listens."""
    if not app.config.sphinx_gallery_conf["plot_gallery"] or "ROCKING_SERVER" in os.environ:
        return
    log = Path(tempfile.mkdtemp(prefix="rocking-guide-")) / "log"
    command = [sys.executable, "-m", "rocking._cli", "serve", "--port", "0", "--results", os.environ["ROCKING_RESULTS"]]
    with log.open("w") as output:
        service = subprocess.Popen(command, stdout=output, stderr=output)
    atexit.register(stop, service)  # also if the build fails, of which extensions are not told
    deadline = time.monotonic() + SECONDS
    while not (found := re.search(r"running on (http://127\.0\.0\.1:\d+)", log.read_text())):
        if service.poll() is not None or time.monotonic() > deadline:
            raise RuntimeError(f"the service did not start: {log.read_text()}")
        time.sleep(0.1)
    os.environ["ROCKING_SERVER"] = found[1]


def stop(service: subprocess.Popen[bytes]) -> None:
    """Stop the service when the build ends."""
    service.terminate()
    service.wait(timeout=60)


def setup(app: Any) -> dict[str, bool]:
    """Register the extension; the gallery runs at builder-inited, too, so that this comes first."""
    app.connect("builder-inited", start, priority=1)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
