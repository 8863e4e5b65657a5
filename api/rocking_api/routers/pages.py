"""The pages for a browser, from the folder `templates`; they load nothing from other hosts."""

from __future__ import annotations

import json
import os
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from fastapi import APIRouter, FastAPI, Request, Response
from fastapi.responses import HTMLResponse
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from rocking_api.http.errors import FULL, KINDS, OTHERS, PROBLEMS
from rocking_api.settings import Settings, has_data

STATIC = Path(__file__).parents[1] / "static"

TEMPLATES = Environment(
    loader=FileSystemLoader(STATIC.with_name("templates")),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)

PULSES = {
    "sine": "One full sine",
    "cosine": "One full cosine",
    "half_sine": "Half a sine",
    "rectangular": "Rectangular",
    "c1": "Type C1, 1.5 cycles",
    "c2": "Type C2, 2.5 cycles",
    "ricker": "Ricker wavelet",
    "ricker_antisymmetric": "Ricker wavelet, antisymmetric",
    "mavroeidis_papageorgiou": "Mavroeidis and Papageorgiou",
}
"""What pages and scripts call the pulses."""

TEMPLATES.globals["pulses"] = PULSES

POLICY = "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
# swagger-ui needs styles inside elements and data: images
_SWAGGER_POLICY = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'"
# the report of an assessment has its styles inside
REPORT_POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
NO_CACHE = {"Cache-Control": "no-cache"}  # revalidated by ETag: no page mixes two versions


@dataclass(frozen=True)
class Page:
    """A page: its address, its word in the navigation, its title, its template and its policy."""

    path: str
    label: str
    title: str
    template: str
    policy: str = POLICY
    exists: Callable[[Settings], bool] = lambda _: True  # whether it has something to show


PAGES = (
    Page("/", "Explorer", "Does the block overturn?", "explorer.html"),
    Page("/objects", "Objects", "Which objects overturn?", ""),  # objects_page.py
    Page("/object", "One object", "In which direction does it overturn?", ""),  # object_page.py
    Page("/records", "Records", "A block under a record", "records.html"),
    Page("/suites", "Suites", "Suites of records", "suites.html", exists=lambda own: (own.results / "suites").is_dir()),
    Page("/datasets", "Data sets", "Data sets", "datasets.html", exists=lambda own: has_data(own.results)),
    Page("/guide/", "Guide", "Guide", ""),  # guide.py
    Page("/docs", "API", "Routes of the API", "docs.html", _SWAGGER_POLICY),
    Page("/state", "Status", "Service status", "state.html"),
)
"""In the order of the navigation."""

router = APIRouter(include_in_schema=False)


def html(template: str, title: str, path: str = "", settings: Settings | None = None, **values: Any) -> str:
    """A page as text; `path` is its address, where the navigation has it, which leads only where something is."""
    pages = [one for one in PAGES if settings is None or one.path == path or one.exists(settings)]
    return TEMPLATES.get_template(template).render(title=title, path=path, pages=pages, **values)


def settings_of(request: Request) -> Settings:
    """The settings of the service that answers a request."""
    found: Settings = request.app.state.service.settings
    return found


def _add(page: Page) -> None:
    async def get_page(request: Request) -> Response:
        headers = {"Content-Security-Policy": page.policy, **NO_CACHE}
        return HTMLResponse(html(page.template, page.title, page.path, settings_of(request)), headers=headers)

    router.add_api_route(page.path, get_page, methods=["GET"], summary=page.title)


@router.get(PROBLEMS)
async def get_problems(request: Request) -> Response:
    """The kinds of errors, which their `type` refers to."""
    kinds = sorted((*KINDS.values(), *OTHERS, FULL), key=lambda kind: (kind.status, kind.name))
    headers = {"Content-Security-Policy": POLICY, **NO_CACHE}
    text = html("problems.html", "Kinds of errors", settings=settings_of(request), kinds=kinds)
    return HTMLResponse(text, headers=headers)


for _page in PAGES:
    if _page.template:
        _add(_page)


def add_error_pages(app: FastAPI) -> None:
    """Give errors as pages to clients that ask for HTML, by the handlers that are registered so far."""
    for kind, handler in list(app.exception_handlers.items()):
        app.add_exception_handler(kind, _with_page(handler))


def _with_page(handler: Callable[..., Any]) -> Callable[[Request, Exception], Awaitable[Response]]:
    async def handle(request: Request, error: Exception) -> Response:
        response: Response = await handler(request, error)
        response.headers.add_vary_header("Accept")
        if "text/html" not in request.headers.get("accept", "") or response.status_code < 400:
            return response
        problem = json.loads(bytes(response.body))
        text = html("error.html", problem["title"], "", settings_of(request), problem=problem, address=request.url.path)
        kept = {name: value for name, value in response.headers.items() if not name.startswith("content-")}
        return HTMLResponse(text, response.status_code, kept | {"Content-Security-Policy": POLICY})

    return handle


class PageFiles(StaticFiles):
    """Scripts, styles and libraries of the pages."""

    headers: ClassVar = NO_CACHE

    def file_response(
        self, full_path: str | os.PathLike[str], stat_result: os.stat_result, scope: Scope, status_code: int = 200
    ) -> Response:
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers.update(self.headers)
        return response
