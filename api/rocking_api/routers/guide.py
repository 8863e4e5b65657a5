"""The guide under `/guide/`: that of `make docs`, else the text of the package that says how to begin."""

from __future__ import annotations

from importlib.metadata import metadata
from typing import ClassVar

from fastapi.responses import HTMLResponse
from markdown_it import MarkdownIt
from starlette.responses import Response
from starlette.types import Scope

from rocking_api.routers.pages import NO_CACHE, POLICY, PageFiles, html
from rocking_api.settings import Settings

# the pages of the theme set colours by scripts and styles inside of them
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "object-src 'none'; base-uri 'none'; frame-ancestors 'none'"
)


class GuideFiles(PageFiles):
    """The files of the folder of the guide, which need not exist when the service starts."""

    headers: ClassVar = {**NO_CACHE, "Content-Security-Policy": _POLICY}

    def __init__(self, settings: Settings) -> None:
        super().__init__(directory=settings.guide, html=True, check_dir=False)
        self._settings = settings

    async def check_config(self) -> None:
        """Not refused here: the guide may be built later."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        if path == "." and not (self._settings.guide / "index.html").is_file():
            return HTMLResponse(_first_steps(self._settings), headers={"Content-Security-Policy": POLICY, **NO_CACHE})
        return await super().get_response(path, scope)


def _first_steps(settings: Settings) -> str:
    """The page with the description of the package, which every installation has."""
    text = str(metadata("rocking").json["description"])
    without_title = text.partition("\n")[2] if text.startswith("# ") else text
    body = MarkdownIt("commonmark", {"html": False}).enable("table").render(without_title)
    return html("guide.html", "First steps", "/guide/", settings, body=body, folder=settings.guide)
