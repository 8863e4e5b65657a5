"""What a client may keep: for ever under a URL that names a version, else for a while, and then it asks by ETag."""

from __future__ import annotations

import hashlib

from fastapi import Request, Response

SHORT = "max-age=60"
"""For answers that change only when data sets or the service are replaced."""

IMMUTABLE = "public, max-age=31536000, immutable"
"""Under a URL that names the sha256 of what it yields."""

ASK_AGAIN = "no-cache"
"""Kept by the client, but asked for again."""


def validators(sha256: str, control: str = ASK_AGAIN) -> dict[str, str]:
    """Headers by which a client knows a version again."""
    return {"ETag": f'"{sha256}"', "Cache-Control": control}


def not_modified(request: Request, sha256: str, control: str = ASK_AGAIN) -> Response | None:
    """304 if the client has this version already (If-None-Match: a list, weak tags, or *)."""
    asked = request.headers.get("if-none-match")
    if asked is None:
        return None
    known = [tag.strip().removeprefix("W/") for tag in asked.split(",")]
    if f'"{sha256}"' in known or "*" in known:
        return Response(status_code=304, headers=validators(sha256, control))
    return None


def revalidated(request: Request, response: Response) -> Response:
    """The response with an ETag of its body, or 304 in its place; untouched if it says itself how long it may be kept,
    is an error, or is sent piece by piece.
    """
    body = getattr(response, "body", None)
    controlled = any(name == b"cache-control" for name, _ in response.raw_headers)
    if body is None or response.status_code != 200 or controlled:
        return response
    digest = hashlib.sha256(body).hexdigest()
    unchanged = not_modified(request, digest, SHORT)
    if unchanged is None:
        response.raw_headers += [(b"etag", f'"{digest}"'.encode()), (b"cache-control", SHORT.encode())]
        return response
    return unchanged
