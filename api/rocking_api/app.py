"""The application: `create_app(settings)`. Nothing happens on import."""

from __future__ import annotations

import logging
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

import anyio
from fastapi import FastAPI
from prometheus_client import CollectorRegistry, ProcessCollector
from prometheus_fastapi_instrumentator import Instrumentator
from starlette.middleware.cors import CORSMiddleware
from starlette.middleware.gzip import DEFAULT_EXCLUDED_CONTENT_TYPES, GZipMiddleware

from rocking_api.extension import extensions
from rocking_api.http.errors import RESPONSES, add_handlers
from rocking_api.http.limits import Limit, RequestLimits
from rocking_api.models.answer import VERSION
from rocking_api.models.pulses import MAX_BODY
from rocking_api.routers import (
    blocks,
    curves,
    datasets,
    guide,
    health,
    overturning,
    pages,
    pulses,
    records,
    response,
    suites,
)
from rocking_api.service import Service
from rocking_api.settings import Settings

LOG = logging.getLogger("rocking.service")

ROUTES = (response, blocks, records, curves, overturning, pulses, suites, datasets, health, pages)

MAX_JSON = 2 * 1024 * 1024
"""Largest JSON body with blocks [bytes], fifty thousand of them: it takes 0.05 s of the event loop."""

COMPRESSED = ("application/x-netcdf", "application/octet-stream", "application/zip")
"""Contents that are not compressed again; a compressed response has no ranges."""


def create_app(settings: Settings, when_ready: Callable[[], None] = lambda: None) -> FastAPI:
    """Build the service over the results folder of the settings, which need not exist.

    `when_ready` is called once the compiled solver is loaded.
    """
    app = FastAPI(
        title="rocking",
        version=VERSION,
        summary="Does the block overturn, and how far does it rock?",
        description="Response of the free-standing rigid block to pulses and to recorded ground motions, each number "
        "with its source, of pulses with its error bound. Errors are problem+json (RFC 9457).",
        contact={"name": "The rocking developers"},
        license_info={"name": "BSD-3-Clause", "identifier": "BSD-3-Clause"},
        servers=[{"url": "/", "description": "this service"}],
        docs_url=None,  # a page of its own, without scripts of other hosts
        redoc_url=None,
        redirect_slashes=False,
        lifespan=_lifespan,
        responses=RESPONSES,
        telemetry={"tracing": False, "metrics": False, "logs": False},  # without an exporter, 3 % of a short request
    )
    app.state.service = Service(settings)
    app.state.when_ready = when_ready
    app.add_middleware(
        GZipMiddleware, minimum_size=2000, exclude_content_types=(*DEFAULT_EXCLUDED_CONTENT_TYPES, *COMPRESSED)
    )
    if settings.cors_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=list(settings.cors_origins),
            allow_methods=["GET", "HEAD", "POST"],
            expose_headers=["ETag", "Content-Range", "Accept-Ranges", "Retry-After"],
        )
    limits = {
        "/v1/response": Limit(min(MAX_JSON, settings.max_body_bytes), settings.max_body_bytes),
        "/v1/blocks/response": Limit(MAX_JSON, blocks.MAX_BODY),
        "/v1/records/": Limit(settings.max_record_bytes, settings.max_record_bytes),
    }
    registry = CollectorRegistry()  # of this application
    ProcessCollector(registry=registry)  # memory, processor time, open files
    Instrumentator(excluded_handlers=["/metrics"], registry=registry).instrument(app).expose(app, tags=["health"])
    add_handlers(app)
    pages.add_error_pages(app)
    for module in ROUTES:
        app.include_router(module.router)
    for extension in extensions():
        limits |= extension.body_limits
        for router in extension.routers:
            app.include_router(router)
        if extension.static is not None:
            app.mount(f"/static/{extension.name}", pages.PageFiles(directory=extension.static))
    app.mount("/static", pages.PageFiles(directory=pages.STATIC))
    app.mount("/guide", guide.GuideFiles(settings))
    app.add_middleware(
        RequestLimits, limits=limits, default=Limit(MAX_BODY, MAX_BODY), seconds=settings.arrival_seconds
    )
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    """Load the solver in the background, so that the first request need not wait for it."""
    service: Service = app.state.service
    async with anyio.create_task_group() as background:
        background.start_soon(_load_kernels, service, app.state.when_ready)
        background.start_soon(_warn_without_cubes, service)
        background.start_soon(service.dataset_checker.watch)
        yield
        background.cancel_scope.cancel()


async def _load_kernels(service: Service, when_ready: Callable[[], None]) -> None:
    await service.kernels.load()
    when_ready()


async def _warn_without_cubes(service: Service) -> None:
    names = await service.read(lambda _: service.cubes.catalogue.names())
    if not any(name.startswith("spectra/") for name in names):
        LOG.warning("no spectrum cubes in %s; the solver is used instead", service.settings.results)
