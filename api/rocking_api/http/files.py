"""Files over HTTP: sha256 as ETag, conditional requests, byte ranges."""

from __future__ import annotations

import base64
import os
from functools import partial
from typing import Any

import anyio.to_thread
from fastapi import Request, Response
from fastapi.responses import FileResponse
from starlette.types import Message, Receive, Scope, Send

from rocking._datasets.catalogue import DataFile, DatasetFile
from rocking._datasets.netcdf import sha256_of
from rocking_api.http.caching import REVALIDATE, not_modified, validators
from rocking_api.http.errors import problem_response


def file_response(request: Request, file: DataFile, product: DatasetFile, control: str = REVALIDATE) -> Response:
    """The open file of a data set, whole or in ranges; closed at the end. `control` is its Cache-Control header."""
    unchanged = not_modified(request, product.sha256, control)
    if unchanged is not None:
        file.close()
        return unchanged
    digest = base64.b64encode(bytes.fromhex(product.sha256)).decode()
    headers = {**validators(product.sha256, control), "Repr-Digest": f"sha-256=:{digest}:"}  # RFC 9530
    filename = product.name.replace("/", "-") + ".nc"
    return VersionedFileResponse(
        file, product.sha256, headers=headers, media_type="application/x-netcdf", filename=filename
    )


class VersionedFileResponse(FileResponse):
    """A file of one version: the bytes sent are those that were hashed, or the response is aborted.

    The bytes come from the open descriptor, so that replacing the file has no effect. A file that is written to while
    it is sent is hashed again before more of it is sent. Refusals (400 for a malformed Range, 416 for one outside the
    file) are problem+json.
    """

    def __init__(self, file: DataFile, sha256: str, **options: Any) -> None:
        descriptor = file.fileno()
        super().__init__(f"/dev/fd/{descriptor}", stat_result=os.fstat(descriptor), **options)
        self._file = file
        self._sha256 = sha256

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        refusal: Response | None = None

        async def watched(message: Message) -> None:
            nonlocal refusal
            if message["type"] == "http.response.start" and message["status"] in (400, 416):
                refusal = _refusal(message["status"], dict(message["headers"]), scope)
            if refusal is None:
                if not self._file.is_unchanged():
                    await anyio.to_thread.run_sync(partial(_check, self._file, self._sha256))
                await send(message)

        with self._file:
            await super().__call__(_with_strong_range(scope, self._sha256), receive, watched)
        if refusal is not None:
            await refusal(scope, receive, send)


def _check(file: DataFile, sha256: str) -> None:
    if sha256_of(file.content()) != sha256:
        raise RuntimeError(f"{file.name}: was written to while it was sent")


def _with_strong_range(scope: Scope, sha256: str) -> Scope:
    """The request, without its Range if If-Range is not the digest: a date does not identify bytes."""
    conditions = [value for name, value in scope["headers"] if name == b"if-range"]
    if all(value == f'"{sha256}"'.encode() for value in conditions):
        return scope
    return without_range(scope)


def without_range(scope: Scope) -> Scope:
    """The same request for the whole file."""
    return {**scope, "headers": [header for header in scope["headers"] if header[0] != b"range"]}


def _refusal(status: int, headers: dict[bytes, bytes], scope: Scope) -> Response:
    requested = next((value.decode("latin-1") for name, value in scope["headers"] if name == b"range"), "")
    extent = headers.get(b"content-range", b"").decode("latin-1")
    allowed = f"bytes 0 to {int(extent.rpartition('/')[2]) - 1}" if extent else "bytes=FIRST-LAST"
    detail = f"the range `{requested}` cannot be served"
    kept = {"Content-Range": extent} if extent else None
    return problem_response(status, detail, kept, parameter="Range", value=requested, allowed=allowed)
