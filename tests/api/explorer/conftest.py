"""The service on a free port of this machine, and a browser that visits it."""

import asyncio
import os
import socket
import threading

import pytest
import uvicorn
from playwright.sync_api import expect, sync_playwright
from rocking_api.app import create_app
from rocking_api.settings import Settings
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse

from tests.api.explorer.chromium import HOW, find

VARYING = (b"accept", b"accept-encoding", b"content-type", b"if-none-match", b"range")
"""Headers that an answer depends on."""

LIMIT = 30_000  # [ms] for any one thing to appear: the machine may be busy

expect.set_options(timeout=LIMIT)


class Service(uvicorn.Server):
    """The service of a results folder on a port of its own; it can be late, busy, or stopped and started again."""

    def __init__(self, results):
        self.results = results
        self.delay = 0.0  # of answers under /v1, and to forms [s]
        self.refusals = 0  # times that it is busy instead
        self.kept = {}  # messages of answers, by request
        with socket.create_server(("127.0.0.1", 0)) as probe:
            self.port = probe.getsockname()[1]
        self.address = f"http://127.0.0.1:{self.port}"
        self.start()

    def start(self):
        self.app = create_app(Settings(results=self.results))
        config = uvicorn.Config(self, port=self.port, ws="none", log_level="error", timeout_graceful_shutdown=1)
        super().__init__(config)
        self.listens, self.answers = threading.Event(), asyncio.Event()
        self.answers.set()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()
        assert self.listens.wait(60)

    async def startup(self, sockets=None):
        await super().startup(sockets)
        self.loop = asyncio.get_running_loop()
        self.listens.set()

    def stop(self):
        self.should_exit = True
        self.thread.join(timeout=60)

    def hold(self):
        """Answer no more requests under /v1, and no forms, until `release`."""
        self.loop.call_soon_threadsafe(self.answers.clear)

    def release(self):
        self.loop.call_soon_threadsafe(self.answers.set)

    async def __call__(self, scope, receive, send):
        if scope["type"] == "http" and (scope["path"].startswith("/v1/") or scope["method"] == "POST"):
            if self.refusals:
                self.refusals -= 1
                await JSONResponse({"detail": "busy"}, 503, {"Retry-After": "1"})(scope, receive, send)
                return
            await asyncio.sleep(self.delay)
            await self.answers.wait()
            if not scope["path"].startswith(("/v1/datasets", "/v1/suites")):
                await self._answer_once(scope, receive, send)
                return
        await self.app(scope, receive, send)

    async def _answer_once(self, scope, receive, send):
        """Answer as when the same was asked before: the pages of most tests begin with the same requests."""
        try:
            body = await Request(scope, receive).body()
        except ClientDisconnect:
            return
        headers = tuple(one for one in scope["headers"] if one[0] in VARYING)
        request = (scope["method"], scope["path"], scope["query_string"], headers, body)
        for message in self.kept.get(request, ()):
            await send(message)
        if request in self.kept:
            return
        messages, whole = [], [{"type": "http.request", "body": body, "more_body": False}]

        async def received():
            return whole.pop() if whole else await receive()

        async def sent(message):
            messages.append(message)
            await send(message)

        await self.app(scope, received, sent)
        if messages and messages[0]["status"] < 500 and messages[-1].get("body") and not messages[-1].get("more_body"):
            self.kept[request] = messages


@pytest.fixture(scope="package")
def running_service(results):
    service = Service(results)
    yield service
    service.stop()


@pytest.fixture
def service(running_service):
    yield running_service
    running_service.delay, running_service.refusals = 0.0, 0
    if running_service.thread.is_alive():
        running_service.release()
    else:
        running_service.start()


@pytest.fixture(scope="package")
def address(running_service):
    return running_service.address


@pytest.fixture(scope="package")
def browser():
    if os.environ.get("ROCKING_NO_BROWSER"):
        pytest.skip("ROCKING_NO_BROWSER is set")
    found = find()
    if found is None:
        pytest.skip(HOW)
    with sync_playwright() as playwright:
        environment = {**os.environ, **found.environment}
        browser = playwright.chromium.launch(executable_path=found.path, args=list(found.flags), env=environment)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def context_of(browser, address):
    """Contexts of the browser by their options: pages of one context share what is loaded once."""
    made = {}

    def context(**options):
        key = repr(sorted(options.items()))
        if key not in made:
            made[key] = browser.new_context(base_url=address, locale="en-GB", **options)
            made[key].set_default_timeout(LIMIT)
        return made[key]

    yield context
    for one in made.values():
        one.close()


@pytest.fixture
def open_page(context_of, address):
    """Opens a page of the service; afterwards, its console has no message, and no other host was asked."""
    wrong, pages = [], []

    def opened(path="/", *, failing=False, width=1280, height=720, motion="reduce", **options):
        page = context_of(**options).new_page()
        pages.append(page)
        page.set_viewport_size({"width": width, "height": height})
        page.emulate_media(color_scheme="light", reduced_motion=motion)  # an animation occupies a processor
        page.on("pageerror", lambda error: wrong.append(str(error)))
        known = "Failed to load resource" if failing else "status of 422"  # which the page explains
        page.on("console", lambda message: known in message.text or wrong.append(message.text))
        page.on("request", lambda request: request.url.startswith(("blob:", address)) or wrong.append(request.url))
        page.goto(path)
        return page

    yield opened
    for page in pages:
        page.close()
    assert wrong == []
