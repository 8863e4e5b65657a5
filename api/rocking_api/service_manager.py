"""Messages to a service manager such as systemd: that the service is ready, and that it answers.

The protocol is that of sd_notify(3): a datagram to the socket `NOTIFY_SOCKET`. A service that does not repeat the
message within `WATCHDOG_USEC` microseconds is restarted (`WatchdogSec=` of its unit).
"""

from __future__ import annotations

import logging
import math
import os
import socket

LOG = logging.getLogger("rocking.service")

ANSWERS = b"READY=1\nWATCHDOG=1"
"""The service is started, and answers. Only the first READY=1 has an effect."""


def tell_that_it_answers() -> None:
    """Tell the service manager that this service answers; does nothing without one.

    Called by the event loop itself, or by the main process of workers whose event loops run.
    """
    address = os.environ.get("NOTIFY_SOCKET")
    if not address:
        return
    if address.startswith("@"):  # a name that is no file
        address = "\0" + address[1:]
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
        sender.setblocking(False)
        try:
            sender.sendto(ANSWERS, address)
        except OSError:
            LOG.warning("the service manager was not reached", exc_info=True)


def watchdog_seconds() -> float:
    """Time after which the service manager restarts a service that does not answer [s]; infinite without one."""
    own = str(os.getpid())
    if os.environ.get("WATCHDOG_PID", own) != own:  # meant for another process, which has started this one
        return math.inf
    return float(os.environ.get("WATCHDOG_USEC", math.inf)) / 1e6
