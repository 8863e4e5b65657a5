"""Random requests, valid and hostile, to all routes: no 5xx but 503 and 504, no slow answer, every error a problem.

A service in this process is asked. Request k of a seed is the same each time.
"""

import asyncio
import hashlib
import io
import json
import logging
import random
import re
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote, unquote_to_bytes, urlencode

from rocking_api.app import create_app
from rocking_api.settings import Settings

from rocking._excitation.pulses import PULSE_NAMES
from tests.api.conftest import Example, examples_of, texts
from tests.excitation.record_fuzzer import FILES

GRANTED = 1.0
"""Time limit of a request of heavy work [s]."""

SLOW = 5.0
"""Largest time of a response other than 503 and 504 [s]."""

SLOW_HEALTH, BATCH = 1.0, 25
"""Largest time of /health [s], asked after so many requests. It takes milliseconds but while kernels are loaded."""

KINDS = {"example": 76, "dataset": 20, "page": 6, "nowhere": 2, "record": 12, "long": 8, "table": 8, "step": 8}
"""Kinds of requests, and how often they are sent."""

EXTREMES = [f"{sign}1e{power}" for power in (-300, -30, -12, -6, 6, 12, 30, 300) for sign in ("", "-")]
EXTREMES += ["0", "nan", "1" + "0" * 400]
A_NUMBER = re.compile(r"-?\d+(\.\d+)?(e-?\d+)?")

PAGES = [
    *("/", "/docs", "/openapi.json", "/health", "/ready", "/metrics", "/v1/datasets", "/v1/datasets.zip", "/static/"),
    "/static/explorer/main.js",
]
HOSTILE = [
    *("", " ", "nan", "-inf", "1e400", "-1e400", "1e-320", "0", "-0.0", "1", "-1", "true", "null", "[]", "0x10", "1_0"),
    *("9" * 400, "-" + "9" * 400, "9" * 4301, "1" + "0" * 308, "1.7976931348623157e308", "5e-324", "\u0661", "1,5"),
    *("\x00", "%00", "../../etc/passwd", "a" * 256, "a" * 5000),
    *( "\ud7ff", "\U0001f600", "' OR 1=1 --", "<script>", "\r\nX: y"),
]  # fmt: skip
RECORDS = [content for content, _ in FILES]
BLOCK = {"width": "0.5", "height": "2.0"}
STEPS = [
    *("0", "5e-324", "1e-300", "1e-12", "2e-8", "1e-4", "1e4", "1e12", "1e300", "1.7976931348623157e308", "1e400"),
    "nan",
]
UNITS = ["9**9**9 m", "9**16000000/9**16000000 m", "2 m", "m*m/m", "m^1", "(m)", "1e400 m", "m+m", "cm", "g", "m" * 900]
UNITS += ["*".join(["m"] * 4000), "9" * 8000, "m/" * 4000, "(" * 8000]
FRAGMENTS = [
    *("a", "a ", " ", "(", "[a", "a:b ", "1", "1,", " g", "unit:", '"', "=", ";", "\t", "1e", "NPTS ", "width [m],"),
]
METHODS = ["HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "get", "X" * 50]
HEADERS = {
    "accept": ["text/csv", "application/x-netcdf", "application/json;q=0", "*/*", ",".join(["text/csv"] * 500), ""],
    "accept-encoding": ["gzip", "gzip;q=nan", "br", "identity", "*"],
    "range": ["bytes=0-3", "bytes=-7", "bytes=5-2", "bytes=0-0,9-12", "bytes=" + "0-1," * 200, "bytes=99999999-", "x"],
    "if-range": ['"other"', "Sat, 21 Nov 2026 00:00:00 GMT", "\x80"],
    "if-none-match": ["*", '"a"', 'W/"a", "b"', '"' + "a" * 9000],
    "content-type": ["application/json", "text/csv", "application/x-netcdf", "text/csv; charset=x", "a/b", ""],
    "content-encoding": ["gzip", "identity", "br"],
    "content-length": ["-1", "9" * 400, "1e3", "\u00b2".encode().decode("latin-1"), "3"],
    "x-request-id": ["abc", "a" * 999, "\x80\x81"],
    "origin": ["null", "https://example.org"],
    "host": ["[::::", "x"],
}


class Sent(NamedTuple):
    """A request."""

    method: str
    path: str
    query: str
    headers: list[tuple[str, str]]
    body: bytes
    leaves: bool

    def __str__(self):
        target = f"{self.path}?{self.query}" if self.query else self.path
        return f"{self.method} {target[:300]} {str(self.headers)[:300]} {self.body[:100]!r}"


class Received(NamedTuple):
    """A response."""

    status: int
    headers: dict[str, str]
    body: bytes
    seconds: float


def request(seed: int, k: int, names: list[str], examples: list[Example]) -> Sent:
    """Request k of a seed; `names` are those of the data sets, `examples` those of the description."""
    draw = random.Random(f"{seed} {k}")
    kind = draw.choices([*KINDS], [*KINDS.values()])[0]
    method, query, body, headers = "GET", "", b"", []
    if kind == "example":
        example = draw.choice(examples)
        method, path, query, body = example.method, example.url, *_changed(draw, example)
        headers = [("content-type", example.media_type)] if example.media_type else []
    elif kind in ("record", "long", "table", "step"):
        method, (path, query, body) = "POST", _file(draw, kind)
        headers.append(("content-type", "text/csv"))
    elif kind == "dataset":
        path = "/v1/datasets/" + _name(draw, names)
        if draw.random() < 0.2:
            query = "sha256=" + draw.choice(["0" * 64, "", "x" * 300, "%00"])
    elif kind == "page":
        path = draw.choice(PAGES)
    else:
        path = "/" + quote(draw.choice(HOSTILE), safe="/%")
    if draw.random() < 0.06:
        method = draw.choice(METHODS)
    chosen = draw.sample(list(HEADERS), draw.choices([0, 1, 2, 4], [5, 3, 2, 1])[0])
    headers += [(name, draw.choice(HEADERS[name])) for name in chosen]
    return Sent(method, path, query, headers, body, leaves=draw.random() < 0.03)


def _changed(draw: random.Random, example: Example) -> tuple[str, bytes]:
    """Query and body of an example: with an extreme number, another pulse, a part that is hostile, or damaged."""
    given = [*texts(example.query).items()]
    body = bytearray(example.body.encode())
    change = draw.choice(["none", "number", "number", "pulse", "hostile", "damaged"])
    if change == "number" and (places := [*A_NUMBER.finditer(example.body)]) and (draw.random() < 0.5 or not given):
        start, end = draw.choice(places).span()
        body[start:end] = draw.choice(EXTREMES).encode()
    elif change == "number":
        given = _replaced(draw, given, EXTREMES, A_NUMBER)
    elif change == "pulse":
        given = _replaced(draw, given, [sign + name for name in PULSE_NAMES for sign in ("", "-")], re.compile("sine"))
    elif change == "hostile":
        more = [draw.choice(given), (draw.choice(HOSTILE), "1")] if given else []
        given = [*_replaced(draw, given[draw.randrange(2) :], HOSTILE, re.compile(".*")), *more[: draw.randrange(3)]]
    for _ in range(draw.randrange(1, 5) if change == "damaged" and body else 0):
        body[draw.randrange(len(body))] = draw.randrange(256)
    return urlencode(given, errors="surrogatepass"), bytes(body)


Query = list[tuple[str, str]]


def _replaced(draw: random.Random, given: Query, others: list[str], kind: re.Pattern[str]) -> Query:
    """A query of which one value of a kind is another one."""
    places = [place for place, (_, value) in enumerate(given) if kind.fullmatch(value)]
    chosen = draw.choice(places) if places else None
    return [(name, draw.choice(others) if place == chosen else value) for place, (name, value) in enumerate(given)]


def _name(draw: random.Random, names: list[str]) -> str:
    hostile = draw.choice(HOSTILE)
    name = draw.choice([*names, hostile, "spectra/sine/" + hostile, "a/" * 600 + "b", "a" * 256])
    suffix = draw.choice(["", ".nc", ".nc", ".zarr/.zmetadata", ".zarr/peak_rotation/0.0.0", ".zarr/" + hostile])
    return quote(name + suffix, safe="/%", errors="surrogatepass")


def _file(draw: random.Random, kind: str) -> tuple[str, str, bytes]:
    """Path, query and body of a record or of a table of blocks."""
    if kind == "table":
        body = f"name,width [{draw.choice(UNITS)}],height [m],peak_acceleration [g],period [s]\na,1,4,0.4,1\n"
        path, given = "/v1/blocks/response", {"pulse": "sine"}
    else:
        body = draw.choice(RECORDS).decode("latin-1")
        path = "/v1/records/" + draw.choice(["response", "response", "history", "scales", "pulse"])
        given = BLOCK | ({"unit": "g"} if draw.random() < 0.5 else {})
    if kind == "step":
        given = BLOCK | {"unit": "g", "time_step": draw.choice(STEPS)}
        body = "0.1\n0.5\n-0.3\n"
        if draw.random() < 0.5:
            body = f"dt: {given.pop('time_step')}\n{body}"
    if kind == "long" or (kind == "table" and draw.random() < 0.5):
        place = draw.randrange(len(body) + 1)
        fragment = "".join(draw.choices(FRAGMENTS, k=draw.randint(1, 3)))
        body = body[:place] + fragment * (draw.choice([2_000, 8_000, 60_000]) // len(fragment)) + body[place:]
    return path, urlencode(given), body.encode("latin-1")


async def exchange(
    app, sent: Sent, started: Callable[[], object] = lambda: None, body: io.BytesIO | None = None
) -> Received:
    """Send a request to the application as uvicorn would; something may happen once the response has started."""
    scope = {
        "type": "http",
        "asgi": {"version": "3.0", "spec_version": "2.3"},
        "http_version": "1.1",
        "method": sent.method,
        "scheme": "http",
        "path": unquote_to_bytes(sent.path).decode("utf-8", "replace"),
        "raw_path": sent.path.encode(),
        "root_path": "",
        "query_string": sent.query.encode("latin-1"),
        "headers": [(name.encode(), value.encode("latin-1")) for name, value in [("host", "a"), *sent.headers]],
        "client": ("127.0.0.1", 1),
        "server": ("127.0.0.1", 80),
        "state": {},
    }
    parts = [sent.body[:50], sent.body[50:]]
    status, headers, body = 0, {}, io.BytesIO() if body is None else body

    async def receive():
        if parts:
            return {"type": "http.request", "body": parts.pop(0), "more_body": bool(parts)}
        await asyncio.sleep(0.01 if sent.leaves else 3600)
        return {"type": "http.disconnect"}

    async def send(message):
        nonlocal status, headers
        if message["type"] == "http.response.start":
            status = message["status"]
            headers = {name.decode(): value.decode("latin-1") for name, value in message["headers"]}
            started()
        else:
            body.write(message.get("body", b""))

    began = time.monotonic()
    await app(scope, receive, send)
    return Received(status, headers, body.getvalue(), time.monotonic() - began)


def fault(sent: Sent, got: Received) -> str | None:
    """Faults of a response."""
    if sent.leaves:
        return None  # the client has disconnected
    if got.status == 0:
        return "no answer"
    if got.status >= 500 and got.status not in (503, 504):
        return "5xx"
    if got.seconds > SLOW and got.status not in (503, 504):
        return f"took {got.seconds:.1f} s"
    if got.headers.get("x-content-type-options") != "nosniff" or "x-request-id" not in got.headers:
        return "a header is missing"
    whole = sent.method != "HEAD"
    if whole and int(got.headers.get("content-length", len(got.body))) != len(got.body):
        return "another length than declared"
    if got.status >= 400 and got.headers.get("content-type") != "application/problem+json":
        return "not a problem"
    if whole and got.headers.get("content-encoding") is None and "json" in got.headers.get("content-type", ""):
        content = json.loads(got.body, parse_constant=lambda name: f"not JSON: {name}")
        if got.status >= 400 and content["status"] != got.status:
            return "another status than said"
        if "not JSON" in str(content):
            return "NaN or Infinity in JSON"
    digest = f'"{hashlib.sha256(got.body).hexdigest()}"'
    if whole and got.status == 200 and "repr-digest" in got.headers and got.headers["etag"] != digest:
        return "another digest than declared"
    return None


async def ask_all(results: Path, seed: int, first: int, count: int, together: int = 4) -> tuple[Counter, list[str]]:
    """Statuses and faults of the responses, and errors that the service logged."""
    app = create_app(Settings(results=results, max_seconds=GRANTED, max_samples=2000, access_log=False))
    names, examples = app.state.service.cubes.catalogue.names(), [*examples_of(app.openapi())]
    statuses: Counter = Counter()
    faults: list[str] = []
    left = iter(range(first, first + count))

    class Errors(logging.Handler):
        def emit(self, record):
            faults.append(self.format(record))

    async def client():
        for k in left:
            sent = request(seed, k, names, examples)
            try:
                got = await exchange(app, sent)
                wrong = fault(sent, got)
            except Exception as error:  # noqa: BLE001  (whatever gets out of the application)
                got, wrong = Received(0, {}, b"", 0.0), repr(error)
            statuses["left" if sent.leaves else str(int(got.status))] += 1
            if wrong is not None:
                faults.append(f"{seed} {k}: {wrong}; {got.status} {got.body[:200]!r} for {sent}")
            if k % BATCH == 0:
                before = time.process_time()
                health = await exchange(app, Sent("GET", "/health", "", [], b"", leaves=False))
                seconds = min(health.seconds, time.process_time() - before)  # not while other processes computed
                if health.status != 200 or seconds > SLOW_HEALTH:
                    faults.append(f"{seed} {k}: /health {health.status} after {seconds:.1f} s, at {sent}")

    logged = Errors(logging.ERROR)
    logging.getLogger("rocking.service").addHandler(logged)
    try:
        async with app.router.lifespan_context(app):
            await asyncio.gather(*(client() for _ in range(together)))
    finally:
        logging.getLogger("rocking.service").removeHandler(logged)
    return statuses, faults
