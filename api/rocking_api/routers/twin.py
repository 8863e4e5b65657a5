"""GET and POST of one endpoint: the same parameters in the query, or in a JSON body, where the pulse may be samples."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any, get_type_hints

from fastapi import APIRouter, Request

from rocking_api.http.body import body_form
from rocking_api.models.bodies import twin_of
from rocking_api.models.pulses import MAX_BODY, with_samples
from rocking_api.service import ServiceDep


def pair(
    router: APIRouter, path: str, summary: str, tag: str = "curves", **about: Any
) -> Callable[[Callable[..., Awaitable[Any]]], Any]:
    """A decorator that adds an endpoint of parameters, request and service as GET and as POST, described by `about`."""

    def add(endpoint: Callable[..., Awaitable[Any]]) -> Callable[..., Awaitable[Any]]:
        kind = get_type_hints(endpoint)["params"]

        async def post(request: Request, service: ServiceDep) -> Any:
            """The same with the parameters in a JSON body, where `pulse` may be an object with the samples."""
            form = body_form(request, ("json",))
            params, _ = await service.read(request, kind, form, with_samples(kind), MAX_BODY)
            return await endpoint(params, request, service)

        router.add_api_route(path, endpoint, methods=["GET"], summary=summary, tags=[tag], **about)
        said = f"{summary}, under a pulse given by samples"
        router.add_api_route(
            path, post, methods=["POST"], summary=said, tags=[tag], openapi_extra=twin_of(kind), **about
        )
        return endpoint

    return add
