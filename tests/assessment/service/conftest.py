"""The fixtures of the tests of the service, and of its pages in a browser."""

from tests.api.conftest import client, own_results, results
from tests.api.explorer.conftest import address, browser, context_of, open_page, running_service, service

__all__ = [
    "address",
    "browser",
    "client",
    "context_of",
    "open_page",
    "own_results",
    "results",
    "running_service",
    "service",
]
