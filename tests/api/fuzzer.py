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
from typing import Any, NamedTuple
from urllib.parse import quote, unquote_to_bytes, urlencode

import numpy as np
import xarray as xr
from rocking_api.app import create_app
from rocking_api.settings import Settings

from rocking._excitation.pulses import PULSE_NAMES
from tests.api.conftest import POINT, QUERIES, Example, examples_of
from tests.excitation.record_files import DAMAGED, GOOD, ODD

GRANTED = 1.0
"""Time limit of a request of heavy work [s]."""

SLOW = 5.0
"""Largest time of a response other than 503 and 504 [s]."""

SLOW_HEALTH, BATCH = 1.0, 25
"""Largest time of /health [s], asked after so many requests. It takes milliseconds but while kernels are loaded."""

KINDS = {"curve": 55, "overturning": 1, "post": 16, "dataset": 20, "page": 6, "nowhere": 2, "record": 12, "long": 8}
"""Kinds of requests, and how often they are sent."""

EXTREME_KINDS = {"table": 1, "step": 1, "number": 4}
"""Tables of blocks with long headers and arithmetic in units, records with extreme steps, and any extreme number."""

EXTREMES = [f"{sign}1e{power}" for power in (-300, -30, -12, -6, 6, 12, 30, 300) for sign in ("", "-")]
EXTREMES += ["0", "nan", "1" + "0" * 400]
A_NUMBER = re.compile(r"-?\d+(\.\d+)?(e-?\d+)?")

OPTIONS = {"alpha_deg": 20.0, "method": "solver", "absolute_tolerance": 1e-3, "format": "csv", "highest": 9.0}
"""Parameters of some routes, which a query has now and then."""

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
RECORDS = [file.data for file in (*GOOD.values(), *ODD.values(), *DAMAGED.values())]
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


def request(seed: int, k: int, names: list[str], examples: list[Example], kinds: dict[str, int]) -> Sent:
    """Request k of a seed; `names` are those of the data sets, `examples` those of the description."""
    draw = random.Random(f"{seed} {k}")
    kind = draw.choices([*kinds], [*kinds.values()])[0]
    method, query, body, headers = "GET", "", b"", []
    if kind in ("curve", "overturning"):
        path = draw.choice([one for one in QUERIES if (one == "/v1/overturning") == (kind == "overturning")])
        query = _query(draw, path)
    elif kind == "post":
        method, path = "POST", "/v1/response"
        body, media_type, query = _body(draw)
        headers.append(("content-type", media_type))
    elif kind == "number":
        example = draw.choice(examples)
        method, path, media_type = example.method, example.url, example.media_type
        query, text = _with_extreme(draw, example)
        body, headers = text.encode(), [("content-type", media_type)] if media_type else []
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


def _with_extreme(draw: random.Random, example: Example) -> tuple[str, str]:
    """Query and body of an example with an extreme number in place of one of its own."""
    query, body = {name: str(value) for name, value in example.query.items()}, example.body
    numbers = [name for name, value in query.items() if A_NUMBER.fullmatch(value)]
    places = [place.span() for place in A_NUMBER.finditer(body)]
    if places and draw.random() < 0.5 + 0.5 * (not numbers):
        start, end = draw.choice(places)
        body = body[:start] + draw.choice(EXTREMES) + body[end:]
    elif numbers:
        query[draw.choice(numbers)] = draw.choice(EXTREMES)
    return urlencode(
        {name: value.lower() if value in ("True", "False") else value for name, value in query.items()}
    ), body


def _query(draw: random.Random, route: str) -> str:
    """An ordinary query with other numbers, of which some parts are left out, given twice, unknown or hostile."""
    query = QUERIES[route] | {name: value for name, value in OPTIONS.items() if draw.random() < 0.15}
    given = [(name, _value(draw, name, value)) for name, value in query.items()]
    for _ in range(draw.choices([0, 1, 2], [5, 4, 1])[0]):
        place = draw.randrange(len(given))
        match draw.randrange(5):
            case 0 if len(given) > 1:
                del given[place]
            case 1:
                given.append(given[place])
            case 2:
                given.append((draw.choice(HOSTILE), "1"))
            case _:
                given[place] = given[place][0], draw.choice(HOSTILE)
    return urlencode(given, errors="surrogatepass")


def _value(draw: random.Random, name: str, value: Any) -> str:
    """A value near the ordinary one, or far from it."""
    if name == "pulse":
        return draw.choice(["", "-"]) + draw.choice(PULSE_NAMES)
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return str(draw.choice([2, value, 10**6]))
    factor = draw.choices([1.0, draw.uniform(0.5, 1.1), 10.0 ** draw.randint(-9, 9)], [4, 4, 1])[0]
    return repr(value * factor)


def _name(draw: random.Random, names: list[str]) -> str:
    hostile = draw.choice(HOSTILE)
    name = draw.choice([*names, hostile, "spectra/sine/" + hostile, "a/" * 600 + "b", "a" * 256])
    suffix = draw.choice(["", ".nc", ".nc", ".zarr/.zmetadata", ".zarr/peak_rotation/0.0.0", ".zarr/" + hostile])
    return quote(name + suffix, safe="/%", errors="surrogatepass")


def _body(draw: random.Random) -> tuple[bytes, str, str]:
    size = draw.choice([0, 1, 3, 300])
    groups = {name: value for name, value in POINT.items() if name != "pulse"}
    columns = {name: [float(_value(draw, name, value)) for _ in range(size)] for name, value in groups.items()}
    options = {"pulse": "sine"} | {name: value for name, value in OPTIONS.items() if draw.random() < 0.1}
    form = draw.choice(["json", "csv", "nc"])
    if form == "json":
        odd = draw.choice([None, "1" * 400, [], {}, [[1]], True, 10**400, -1, "x", 1e308])
        content = columns | options | ({draw.choice([*POINT, "x"]): odd} if draw.random() < 0.3 else {})
        body, media_type, query = json.dumps(content).encode(), "application/json", ""
    else:
        media_type, query = {"csv": "text/csv", "nc": "application/x-netcdf"}[form], urlencode(options)
        if form == "csv":
            lines = [",".join(columns), *(",".join(map(repr, row)) for row in zip(*columns.values(), strict=True))]
            body = "\n".join(lines).encode()
        else:
            table = xr.Dataset({name: ("point", np.array(values)) for name, values in columns.items()})
            body = bytes(table.to_netcdf(engine="scipy"))
    if body and draw.random() < 0.3:
        damaged = bytearray(body)
        for _ in range(draw.randrange(1, 5)):
            damaged[draw.randrange(len(damaged))] = draw.randrange(256)
        body = bytes(damaged[: draw.randrange(len(damaged)) if draw.random() < 0.3 else None])
    return body, media_type, query


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


async def ask_all(
    results: Path, seed: int, first: int, count: int, kinds: dict[str, int] = KINDS, together: int = 4
) -> tuple[Counter, list[str]]:
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
            sent = request(seed, k, names, examples, kinds)
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
