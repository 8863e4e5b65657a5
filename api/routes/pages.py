"""The pages: `/` and `/docs`, which load nothing from outside."""

from __future__ import annotations

from pathlib import Path

from fastapi import APIRouter
from fastapi.responses import FileResponse

STATIC = Path(__file__).parents[1] / "static"

# styles inside elements and data: images are what swagger-ui needs
_POLICY = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'"

router = APIRouter(include_in_schema=False)


@router.get("/")
async def get_landing_page() -> FileResponse:
    """A first question, and the way to everything else."""
    return _page("index.html")


@router.get("/docs")
async def get_documentation() -> FileResponse:
    """The OpenAPI description, readable."""
    return _page("docs.html")


def _page(name: str) -> FileResponse:
    return FileResponse(STATIC / name, media_type="text/html", headers={"Content-Security-Policy": _POLICY})
