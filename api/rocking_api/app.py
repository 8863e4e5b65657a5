"""The application: `create_app(settings)`. Nothing happens on import."""

from __future__ import annotations

import logging
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

import anyio
import anyio.to_thread
from fastapi import FastAPI
from starlette.middleware.cors import CORSMiddleware
from starlette.middleware.gzip import DEFAULT_EXCLUDED_CONTENT_TYPES, GZipMiddleware

from rocking_api.extension import extensions
from rocking_api.http.errors import RESPONSES, Problem, add_handlers
from rocking_api.http.openapi import describe
from rocking_api.http.request_log import RequestLog
from rocking_api.models.answer import VERSION
from rocking_api.models.bodies import BODIES
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

ROUTES = (
    *(response, blocks, records, curves, overturning),
    *(pulses, suites),
    *(datasets, health, pages),
)


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
        openapi_url=None,  # see `rocking_api.routers.health`
        lifespan=_lifespan,
        responses=RESPONSES,
        telemetry={"tracing": False, "metrics": False, "logs": False},  # without an exporter, 3 % of a short request
    )
    service = app.state.service = Service(settings)
    # data sets are compressed already, and a compressed response has no ranges
    binary = ("application/x-netcdf", "application/octet-stream", "application/zip")
    app.add_middleware(
        GZipMiddleware, minimum_size=2000, exclude_content_types=(*DEFAULT_EXCLUDED_CONTENT_TYPES, *binary)
    )
    if settings.cors_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=list(settings.cors_origins),
            allow_methods=["GET", "HEAD", "POST"],
            expose_headers=["ETag", "Content-Range", "Accept-Ranges", "Repr-Digest", "X-Request-ID", "Retry-After"],
        )
    app.add_middleware(RequestLog, metrics=service.metrics)
    app.state.when_ready = when_ready
    add_handlers(app)
    pages.add_error_pages(app)
    for module in ROUTES:
        app.include_router(module.router)
    for extension in extensions():
        for router in extension.routers:
            app.include_router(router)
        if extension.static is not None:
            app.mount(f"/static/{extension.name}", pages.PageFiles(directory=extension.static))
    app.mount("/static", pages.PageFiles(directory=pages.STATIC))
    app.mount("/guide", guide.GuideFiles(settings.guide))
    describe(app, lambda: [Problem, *sorted(BODIES, key=lambda body: body.__name__)])
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
    for executor in (service.executor, service.single, service.parser):
        executor.close()
    service.metrics.close()


async def _load_kernels(service: Service, when_ready: Callable[[], None]) -> None:
    await service.kernels.load()
    when_ready()


async def _warn_without_cubes(service: Service) -> None:
    names = await anyio.to_thread.run_sync(service.cubes.catalogue.names, abandon_on_cancel=True)
    if not any(name.startswith("spectra/") for name in names):
        LOG.warning("no spectrum cubes in %s; the solver is used instead", service.settings.results)
