"""Requests to the application without a server."""

import asyncio


async def answer_in_process(app, path, query, headers=()):
    """Status of a GET; `headers` are pairs of texts."""
    messages = []
    scope = {
        "type": "http", "asgi": {"version": "3.0", "spec_version": "2.4"}, "http_version": "1.1", "method": "GET",
        "scheme": "http", "path": path, "raw_path": path.encode(), "query_string": query.encode("latin-1"),
        "root_path": "", "client": ("127.0.0.1", 1), "server": ("127.0.0.1", 80), "state": {},
        "headers": [(b"host", b"x"), *((name.encode(), value.encode("latin-1")) for name, value in headers)],
    }  # fmt: skip

    async def send(message):
        messages.append(message)

    await app(scope, asyncio.Event().wait, send)
    return messages[0]["status"]
