"""Files over HTTP: sha256 as ETag, conditional requests, byte ranges."""

from __future__ import annotations

import base64

from fastapi import Request, Response
from fastapi.responses import FileResponse
from starlette.types import Message, Receive, Scope, Send

from api.caching import ASK_AGAIN, not_modified, validators
from api.problems import problem
from rocking.lookup_files import Product


def file_response(request: Request, product: Product, control: str = ASK_AGAIN) -> Response:
    """The file of a data set, whole or in ranges; `control` says how long it may be kept."""
    unchanged = not_modified(request, product.sha256, control)
    if unchanged is not None:
        return unchanged
    digest = base64.b64encode(bytes.fromhex(product.sha256)).decode()
    headers = {**validators(product.sha256, control), "Repr-Digest": f"sha-256=:{digest}:"}  # RFC 9530
    filename = product.name.replace("/", "-") + ".nc"
    return _RangedFile(product.path, headers=headers, media_type="application/x-netcdf", filename=filename)


class _RangedFile(FileResponse):
    """A file whose refusals (400 for a malformed Range, 416 for one outside the file) are problem+json too."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        refusal: Response | None = None

        async def watched(message: Message) -> None:
            nonlocal refusal
            if message["type"] == "http.response.start" and message["status"] in (400, 416):
                refusal = _refusal(message["status"], dict(message["headers"]), scope)
            if refusal is None:
                await send(message)

        await super().__call__(scope, receive, watched)
        if refusal is not None:
            await refusal(scope, receive, send)


def _refusal(status: int, headers: dict[bytes, bytes], scope: Scope) -> Response:
    asked = next((value.decode("latin-1") for name, value in scope["headers"] if name == b"range"), "")
    extent = headers.get(b"content-range", b"").decode("latin-1")
    allowed = f"bytes 0 to {int(extent.rpartition('/')[2]) - 1}" if extent else "bytes=FIRST-LAST"
    detail = f"the range `{asked}` cannot be served"
    kept = {"Content-Range": extent} if extent else None
    return problem(status, detail, kept, parameter="Range", value=asked, allowed=allowed)
