"""The guide that `make docs` built, under `/guide/`."""

from __future__ import annotations

from http import HTTPStatus
from pathlib import Path
from typing import ClassVar

from starlette.exceptions import HTTPException
from starlette.responses import Response
from starlette.types import Scope

from rocking_api.routers.pages import NO_CACHE, PageFiles

# the pages of the theme set colours by scripts and styles inside of them
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "object-src 'none'; base-uri 'none'; frame-ancestors 'none'"
)


class GuideFiles(PageFiles):
    """The files of a folder, which need not exist when the service starts."""

    headers: ClassVar = {**NO_CACHE, "Content-Security-Policy": _POLICY}

    def __init__(self, directory: Path) -> None:
        super().__init__(directory=directory, html=True, check_dir=False)

    async def check_config(self) -> None:
        """Not refused here: the guide may be built later."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        if not Path(str(self.directory), "index.html").is_file():
            raise HTTPException(
                HTTPStatus.NOT_FOUND,
                "the guide is not built: `make docs` in a checkout of the sources builds it, and `ROCKING_GUIDE` names "
                f"the folder of one, which is `{self.directory}` here; its text is the folder `docs` of the sources",
            )
        return await super().get_response(path, scope)
