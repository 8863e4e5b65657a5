"""What the routes share: settings, data sets, and a place for heavy work outside the event loop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, TypeVar

import anyio.to_thread
from anyio import CapacityLimiter
from fastapi import Depends, Request

from api.settings import Settings
from api.zarr_view import ZarrViews
from rocking.lookup_atlas import Atlas

T = TypeVar("T")


@dataclass
class Service:
    """One per application, made in `create_app`."""

    settings: Settings
    atlas: Atlas
    zarr_views: ZarrViews
    limiter: CapacityLimiter = field(init=False)

    def __post_init__(self) -> None:
        self.limiter = CapacityLimiter(self.settings.max_workers)

    async def off_loop(self, work: Callable[[], T]) -> T:
        """Run work of more than a millisecond in a thread, at most `max_workers` at once."""
        return await anyio.to_thread.run_sync(work, limiter=self.limiter)


async def _service(request: Request) -> Service:  # async: a plain function would cost a thread hop per request
    found: Service = request.app.state.service
    return found


ServiceDep = Annotated[Service, Depends(_service)]
