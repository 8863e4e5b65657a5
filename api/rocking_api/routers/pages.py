"""The pages for a browser, from the folder `templates`; they load nothing from other hosts."""

from __future__ import annotations

import json
import os
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

from fastapi import APIRouter, FastAPI, Request, Response
from fastapi.responses import HTMLResponse
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from rocking._base.units import UNITS
from rocking_api.extension import MenuEntry, extensions
from rocking_api.http.errors import FULL, KINDS, OTHERS, PROBLEMS
from rocking_api.settings import Settings, has_data

STATIC = Path(__file__).parents[1] / "static"


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


@cache
def templates() -> Environment:
    """Return the templates of the service and of the packages that extend it."""
    folders = [STATIC.with_name("templates")]
    folders += [extension.templates for extension in extensions() if extension.templates is not None]
    environment = Environment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals["pulses"] = PULSES
    environment.globals["record_units"] = [(unit, unit.replace("s2", "s²")) for unit in UNITS["m/s2"]]
    return environment


POLICY = "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
# swagger-ui needs styles inside elements and data: images
_SWAGGER_POLICY = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'"
NO_CACHE = {"Cache-Control": "no-cache"}  # revalidated by ETag: no page mixes two versions


@dataclass(frozen=True)
class Page(MenuEntry):
    """A page of the service: also its title, its template and its policy."""

    title: str = ""
    template: str = ""
    policy: str = POLICY


PAGES = (
    Page("/", "Explorer", title="Does the block overturn?", template="explorer.html"),
    Page("/records", "Records", title="A block under a record", template="records.html"),
    Page(
        "/suites",
        "Suites",
        title="Suites of records",
        template="suites.html",
        exists=lambda settings: (settings.results / "suites").is_dir(),
    ),
    Page(
        "/datasets",
        "Data sets",
        title="Data sets",
        template="datasets.html",
        exists=lambda settings: has_data(settings.results),
    ),
    Page("/guide/", "Guide", title="Guide"),  # guide.py
    Page("/docs", "API", title="Routes of the API", template="docs.html", policy=_SWAGGER_POLICY),
    Page("/state", "Status", title="Service status", template="state.html"),
)
"""In the order of the navigation."""


def menu() -> list[MenuEntry]:
    """Return the pages of the navigation; those of packages that extend the service follow the first one."""
    added = [entry for extension in extensions() for entry in extension.menu]
    return [PAGES[0], *added, *PAGES[1:]]


router = APIRouter(include_in_schema=False)


def html(template: str, title: str, path: str = "", settings: Settings | None = None, **values: Any) -> str:
    """A page as text; `path` is its address, where the navigation has it, which leads only where something is."""
    pages = [entry for entry in menu() if settings is None or entry.path == path or entry.exists(settings)]
    return templates().get_template(template).render(title=title, path=path, pages=pages, **values)


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
