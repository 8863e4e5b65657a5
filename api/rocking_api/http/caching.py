"""Cache headers: immutable under a URL that names a version, else a short time, then revalidation by ETag."""

from __future__ import annotations

import hashlib

from fastapi import Request, Response

SHORT = "max-age=60"  # for responses that change only with the data sets or the service
IMMUTABLE = "public, max-age=31536000, immutable"  # under a URL that names the sha256 of its content
REVALIDATE = "no-cache"  # may be stored, but must be revalidated


def validators(sha256: str, control: str = REVALIDATE) -> dict[str, str]:
    """Headers that identify a version."""
    return {"ETag": f'"{sha256}"', "Cache-Control": control}


def not_modified(request: Request, sha256: str, control: str = REVALIDATE) -> Response | None:
    """304 if the client has this version (If-None-Match: a list, weak tags, or *)."""
    requested = request.headers.get("if-none-match")
    if requested is None:
        return None
    known = [tag.strip().removeprefix("W/") for tag in requested.split(",")]
    if f'"{sha256}"' in known or "*" in known:
        return Response(status_code=304, headers=validators(sha256, control))
    return None


def revalidated(request: Request, response: Response) -> Response:
    """The response with an ETag of its body, or 304 in its place.

    Without Cache-Control it may be stored for a short time. It is unchanged if it must not be stored, has an ETag, is
    an error, or is streamed.
    """
    body = getattr(response, "body", None)
    if body is None or response.status_code != 200:
        return response
    headers = dict(response.raw_headers)
    control = headers.get(b"cache-control", SHORT.encode()).decode()
    if control == "no-store" or b"etag" in headers:
        return response
    digest = hashlib.sha256(body).hexdigest()
    unchanged = not_modified(request, digest, control)
    if unchanged is None:
        response.raw_headers.append((b"etag", f'"{digest}"'.encode()))
        if b"cache-control" not in headers:
            response.raw_headers.append((b"cache-control", control.encode()))
        return response
    return unchanged
