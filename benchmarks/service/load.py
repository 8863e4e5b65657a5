"""Concurrent requests to a server over many connections, by wrk where it is installed, else by a small client.

wrk takes far less processor time than the server; the Python client takes as much as the server, so that its result
is a lower bound. Every request has different parameters, so that no response comes from a cache.
"""

from __future__ import annotations

import asyncio
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from typing import Any

import numpy as np

LUA = """
math.randomseed({seed})
request = function()
  local s = {low} + {width} * math.random()
  local w = {first} * math.exp({octaves} * math.random())
  return wrk.format("GET", string.format("{path}", s, w))
end
done = function(summary, latency, requests)
  local e = summary.errors
  io.write(string.format("RESULT %d %d %d %d %d\\n", summary.requests, summary.duration,
    e.connect + e.read + e.write + e.status + e.timeout, latency:percentile(50), latency:percentile(99)))
end
"""

WINDOW = {"low": 0.05, "width": 0.9, "first": 0.5, "octaves": 3.178}
"""1/a from 0.05 to 0.95, omega from 0.5 to 12 [-]."""


def load(port: int, path: str, connections: int, seconds: float, core: int | None) -> dict[str, Any]:
    """Send requests for `seconds` over `connections`; `path` holds two %.9f, for 1/a and omega.

    Returns
    -------
    dict
        client, requests per second, median and 99 % quantile of the response time [ms], errors.
    """
    if shutil.which("wrk"):
        return _wrk(port, path, connections, seconds, core)
    return asyncio.run(_run_client(port, path, connections, seconds))


def _wrk(port: int, path: str, connections: int, seconds: float, core: int | None) -> dict[str, Any]:
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", suffix=".lua") as script:
        script.write(LUA.format(seed=connections, path=path, **WINDOW))
        script.flush()
        pinned = [] if core is None or not shutil.which("taskset") else ["taskset", "-c", str(core)]
        command = [*pinned, "wrk", "-t1", f"-c{connections}", f"-d{max(1, round(seconds))}s", "--timeout", "30s"]
        done = subprocess.run(
            [*command, "-s", script.name, f"http://127.0.0.1:{port}"], capture_output=True, text=True, check=True
        )
    match = re.search(r"RESULT (\d+) (\d+) (\d+) (\d+) (\d+)", done.stdout)
    assert match, done.stdout
    count, microseconds, errors, median, last = map(int, match.groups())
    return _record("wrk", connections, count, microseconds / 1e6, [median / 1e3, last / 1e3], errors)


def point_request(path: str, random: np.random.Generator) -> bytes:
    """A request for one block, at a random place of the window; `path` has places for 1/a and omega."""
    s = WINDOW["low"] + WINDOW["width"] * random.random()
    w = WINDOW["first"] * np.exp(WINDOW["octaves"] * random.random())
    return f"GET {path % (s, w)} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode()


async def send(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, request: bytes) -> bytes:
    """Send a request and read the whole response; return its head."""
    writer.write(request)
    head = await reader.readuntil(b"\r\n\r\n")
    length = re.search(rb"content-length: (\d+)", head, re.IGNORECASE)
    await reader.readexactly(int(length[1]) if length else 0)
    return head


async def _run_client(port: int, path: str, connections: int, seconds: float) -> dict[str, Any]:
    times: list[float] = []
    random = np.random.default_rng(connections)

    began = time.perf_counter()
    until = began + seconds

    errors = sum(
        await asyncio.gather(
            *(_request_until(port, lambda: point_request(path, random), until, times) for _ in range(connections))
        )
    )
    took = time.perf_counter() - began
    return _record("asyncio", connections, len(times), took, (1e3 * np.quantile(times, [0.5, 0.99])).tolist(), errors)


async def _request_until(port: int, request: Callable[[], bytes], until: float, times: list[float]) -> int:
    """Send requests over one connection; return the number of responses other than 200."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    errors = 0
    while time.perf_counter() < until:
        began = time.perf_counter()
        head = await send(reader, writer, request())
        times.append(time.perf_counter() - began)
        errors += b" 200 " not in head[:16]
    writer.close()
    return errors


def _record(
    client: str, connections: int, count: int, seconds: float, milliseconds: list[float], errors: int
) -> dict[str, Any]:
    median, last = milliseconds
    return {
        "client": client,
        "connections": connections,
        "questions": count,
        "per_second": count / seconds,
        "median_ms": median,
        "p99_ms": last,
        "errors": errors,
    }
