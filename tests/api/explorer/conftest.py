"""The service on a free port of this machine, and a browser that visits it."""

import asyncio
import os
import socket
import threading
import time

import pytest
import uvicorn
from playwright.sync_api import expect, sync_playwright
from rocking_api.app import create_app
from rocking_api.settings import Settings
from starlette.responses import JSONResponse

from tests.api.explorer.chromium import HOW, find

LIMIT = 30_000  # [ms] for any one thing to appear: the machine may be busy

expect.set_options(timeout=LIMIT)


class Service:
    """The service of a results folder on a port of its own; it can be slow, busy, or stopped and started again."""

    def __init__(self, results):
        self.results = results
        self.seconds = 0.0  # that answers under /v1, and to forms, are late
        self.refusals = 0  # times that it is busy instead
        with socket.create_server(("127.0.0.1", 0)) as probe:
            self.port = probe.getsockname()[1]
        self.start()

    @property
    def address(self):
        return f"http://127.0.0.1:{self.port}"

    def start(self):
        self.app = create_app(Settings(results=self.results))
        config = uvicorn.Config(self, port=self.port, ws="none", log_level="error", timeout_graceful_shutdown=1)
        self.server = uvicorn.Server(config)
        self.thread = threading.Thread(target=self.server.run)
        self.thread.start()
        deadline = time.monotonic() + 60
        while not self.server.started and time.monotonic() < deadline:
            time.sleep(0.02)

    def stop(self):
        self.server.should_exit = True
        self.thread.join(timeout=60)

    async def __call__(self, scope, receive, send):
        if scope["type"] == "http" and (scope["path"].startswith("/v1/") or scope["method"] == "POST"):
            if self.refusals:
                self.refusals -= 1
                await JSONResponse({"detail": "busy"}, 503, {"Retry-After": "1"})(scope, receive, send)
                return
            end = time.monotonic() + self.seconds
            while self.seconds and time.monotonic() < end:  # those that wait are let go when it recovers
                await asyncio.sleep(0.02)
        await self.app(scope, receive, send)


@pytest.fixture(scope="package")
def package_service(results):
    service = Service(results)
    yield service
    service.stop()


@pytest.fixture
def service(package_service):
    yield package_service
    package_service.seconds, package_service.refusals = 0.0, 0
    if not package_service.thread.is_alive():
        package_service.start()


@pytest.fixture(scope="package")
def address(package_service):
    return package_service.address


@pytest.fixture(scope="package")
def launch():
    """Starts a browser, with variables of the environment."""
    if os.environ.get("ROCKING_NO_BROWSER"):
        pytest.skip("ROCKING_NO_BROWSER is set")
    found = find()
    if found is None:
        pytest.skip(HOW)
    with sync_playwright() as playwright:

        def launched(**environment):
            environment = {**os.environ, **found.environment, **environment}
            return playwright.chromium.launch(executable_path=found.path, args=list(found.flags), env=environment)

        yield launched


@pytest.fixture(scope="package")
def browser(launch):
    browser = launch()
    yield browser
    browser.close()


@pytest.fixture
def open_page(browser, address):
    """Opens a page of the service; afterwards, nothing may have failed in it or been asked of another host."""
    wrong, contexts = [], []

    def opened(path="/", *, failing=False, reduced_motion="reduce", **options):  # an animation occupies a processor
        options |= {"base_url": address, "locale": "en-GB", "reduced_motion": reduced_motion}
        context = browser.new_context(**options)
        context.set_default_timeout(LIMIT)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda message: wrong.append(message.text) if _is_fault(message, failing) else None)
        page.on(
            "request",
            lambda request: wrong.append(request.url) if not request.url.startswith(("blob:", address)) else None,
        )
        page.goto(path)
        return page

    yield opened
    for context in contexts:
        context.close()
    assert wrong == []


def _is_fault(message, failing):
    # the browser reports what the page explains
    explained = "Failed to load resource" in message.text if failing else "status of 422" in message.text
    return message.type in ("error", "warning") and not explained
