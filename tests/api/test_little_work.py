"""One request for one block is little work: calls of Python functions of the package, and processor time."""

import asyncio
import sys
import time
from collections import Counter
from pathlib import Path

import pytest
import rocking_api
from rocking_api.app import create_app
from rocking_api.settings import Settings

import rocking

ROOTS = tuple(str(Path(one.__file__).parent) for one in (rocking, rocking_api))
QUERY = b"pulse=sine&slenderness=0.413&frequency_ratio=5.1&restitution=0.85"
SCOPE = {"type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": "GET", "scheme": "http",
         "path": "/v1/response", "raw_path": b"/v1/response", "root_path": "", "client": ("127.0.0.1", 1),
         "server": ("127.0.0.1", 80), "headers": [(b"host", b"here"), (b"accept", b"*/*")]}  # fmt: skip


async def work_of(app, query):
    """Calls by file of a warm request, and its processor time [s]."""
    found = Counter()

    async def get():
        messages = []

        async def send(message):
            messages.append(message)

        await app({**SCOPE, "query_string": query, "state": {}}, asyncio.Event().wait, send)
        assert messages[0]["status"] == 200

    def count(frame, event, _):
        if event == "call" and frame.f_code.co_filename.startswith(ROOTS):
            found[frame.f_code.co_filename] += 1

    for _ in range(3):
        await get()
    sys.setprofile(count)
    try:
        await get()
    finally:
        sys.setprofile(None)
    best = float("inf")
    for _ in range(20):
        began = time.process_time()
        for _ in range(10):
            await get()
        best = min(best, (time.process_time() - began) / 10)
    return found, best


@pytest.mark.parametrize(("method", "most", "files"), [("cube", 60, 15), ("solver", 40, 15)])
def test_one_block_is_little_work(results, method, most, files):
    async def scenario():
        app = create_app(Settings(results=results))
        async with app.router.lifespan_context(app):
            await app.state.service.kernels.wait()
            return await work_of(app, QUERY + f"&method={method}".encode())

    found, seconds = asyncio.run(scenario())
    assert sum(found.values()) <= most, found
    assert len(found) <= files, found
    assert seconds < 1e-3
