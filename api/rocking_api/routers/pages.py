"""The pages `/`, `/records`, `/suites`, `/datasets`, `/state` and `/docs`, which load nothing from other hosts."""

from __future__ import annotations

import os
from pathlib import Path

from fastapi import APIRouter, Response
from fastapi.responses import FileResponse
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send

from rocking_api.http.files import without_range
from rocking_api.http.params_route import ParamsRoute

STATIC = Path(__file__).parents[1] / "static"

_EXPLORER_POLICY = "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
# swagger-ui needs styles inside elements and data: images
_SWAGGER_POLICY = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'"
_REVALIDATE = {"Cache-Control": "no-cache"}  # revalidated by ETag: no page mixes two versions

router = APIRouter(include_in_schema=False, route_class=ParamsRoute)


@router.get("/")
async def get_explorer() -> FileResponse:
    """The explorer: a block in metres, the map of the control space, time histories."""
    return _page("index.html", _EXPLORER_POLICY)


@router.get("/records")
async def get_records() -> FileResponse:
    """A block under the record of a file."""
    return _page("records.html", _EXPLORER_POLICY)


@router.get("/suites")
async def get_suites_page() -> FileResponse:
    """Blocks under a suite of records, as a report to print."""
    return _page("suites.html", _EXPLORER_POLICY)


@router.get("/datasets")
async def get_datasets_page() -> FileResponse:
    """The catalogue of the data sets."""
    return _page("datasets.html", _EXPLORER_POLICY)


@router.get("/state")
async def get_state_page() -> FileResponse:
    """The state of the service."""
    return _page("state.html", _EXPLORER_POLICY)


@router.get("/docs")
async def get_documentation() -> FileResponse:
    """The OpenAPI description as a page."""
    return _page("docs.html", _SWAGGER_POLICY)


class _Page(FileResponse):
    """A page, without ranges."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await super().__call__(without_range(scope), receive, send)


class PageFiles(StaticFiles):
    """Scripts, styles and libraries of the pages, without ranges."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await super().__call__(without_range(scope), receive, send)

    def file_response(
        self, full_path: str | os.PathLike[str], stat_result: os.stat_result, scope: Scope, status_code: int = 200
    ) -> Response:
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers.update(_REVALIDATE)
        return response


def _page(name: str, policy: str) -> FileResponse:
    headers = {"Content-Security-Policy": policy, **_REVALIDATE}
    return _Page(STATIC / name, media_type="text/html", headers=headers)
