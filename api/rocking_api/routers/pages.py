"""The pages: `/` and `/docs`, which load nothing from outside."""

from __future__ import annotations

import os
from pathlib import Path

from fastapi import APIRouter, Response
from fastapi.responses import FileResponse
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send

from rocking_api.http.files import without_range

STATIC = Path(__file__).parents[1] / "static"

_OURS = "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
# styles inside elements and data: images are what swagger-ui needs
_SWAGGER = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'"
_ASK_AGAIN = {"Cache-Control": "no-cache"}  # kept by the browser, but asked for again by ETag: no page of two versions

router = APIRouter(include_in_schema=False)


@router.get("/")
async def get_explorer() -> FileResponse:
    """The explorer: a block in metres, the map of all blocks, and how each of them rocks."""
    return _page("index.html", _OURS)


@router.get("/docs")
async def get_documentation() -> FileResponse:
    """The OpenAPI description, readable."""
    return _page("docs.html", _SWAGGER)


class _Page(FileResponse):
    """A page, always as a whole."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await super().__call__(without_range(scope), receive, send)


class PageFiles(StaticFiles):
    """Scripts, styles and libraries of the pages, always as a whole."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await super().__call__(without_range(scope), receive, send)

    def file_response(
        self, full_path: str | os.PathLike[str], stat_result: os.stat_result, scope: Scope, status_code: int = 200
    ) -> Response:
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers.update(_ASK_AGAIN)
        return response


def _page(name: str, policy: str) -> FileResponse:
    headers = {"Content-Security-Policy": policy, **_ASK_AGAIN}
    return _Page(STATIC / name, media_type="text/html", headers=headers)
