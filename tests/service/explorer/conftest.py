"""The service on a free port of this machine, and a browser that visits it."""

import os
import socket
import threading
import time

import pytest
import uvicorn
from playwright.sync_api import expect, sync_playwright

from api.app import create_app
from api.settings import Settings
from tests.service.explorer.chromium import HOW, find

LIMIT = 30_000  # [ms] for any one thing to appear: the machine may be busy

expect.set_options(timeout=LIMIT)


@pytest.fixture(scope="module")
def address(results):
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    server = uvicorn.Server(
        uvicorn.Config(create_app(Settings(results=results)), port=port, ws="none", log_level="error")
    )
    thread = threading.Thread(target=server.run)
    thread.start()
    deadline = time.monotonic() + 60
    while not server.started and time.monotonic() < deadline:
        time.sleep(0.02)
    yield f"http://127.0.0.1:{port}"
    server.should_exit = True
    thread.join(timeout=60)


@pytest.fixture(scope="module")
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


@pytest.fixture
def open_page(browser, address):
    """Opens a page of the service; afterwards, nothing may have failed in it or been asked of another host."""
    wrong, contexts = [], []

    def opened(path="/", **options):
        context = browser.new_context(base_url=address, locale="en-GB", **options)
        context.set_default_timeout(LIMIT)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda message: wrong.append(message.text) if _is_fault(message) else None)
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


def _is_fault(message):
    refusal = "status of 422" in message.text  # the browser reports what the page explains
    return message.type in ("error", "warning") and not refusal
