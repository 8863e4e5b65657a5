"""What the routes share: settings, data sets, counts, and places for work outside the event loop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, TypeVar

import anyio.to_thread
from anyio import CapacityLimiter
from fastapi import Depends, Request

from rocking.lookup.collection import CubeCollection
from rocking_api.dataset_checker import Inspection
from rocking_api.execution.batching import Together
from rocking_api.execution.executor import BoundedExecutor, Work
from rocking_api.execution.kernels import Kernels
from rocking_api.http.in_flight import InFlight
from rocking_api.http.metrics import Metrics
from rocking_api.http.zarr_view import ZarrViews
from rocking_api.models.params import Question
from rocking_api.settings import Settings

T = TypeVar("T")


@dataclass
class Service:
    """One per application, made in `create_app`."""

    settings: Settings
    atlas: CubeCollection
    zarr_views: ZarrViews
    together: Together = field(init=False)
    kernels: Kernels = field(init=False)
    executor: BoundedExecutor = field(init=False)
    metrics: Metrics = field(init=False)
    inspection: Inspection = field(init=False)
    reader: CapacityLimiter = field(init=False)
    reader_of_large: CapacityLimiter = field(init=False)
    in_flight: InFlight = field(init=False)

    def __post_init__(self) -> None:
        settings = self.settings
        # a thread of its own: a question about one block does not wait behind heavy work
        alone = BoundedExecutor(1, settings.max_queue, settings.max_seconds)
        self.together = Together(self.atlas, alone)
        self.kernels = Kernels(settings.max_seconds)
        self.executor = BoundedExecutor(settings.max_workers, settings.max_queue, settings.max_seconds)
        self.metrics = Metrics(self.executor)
        self.inspection = Inspection(self.atlas)
        self.reader = CapacityLimiter(settings.max_workers)
        self.reader_of_large = CapacityLimiter(1)
        self.in_flight = InFlight(settings.max_bytes_in_flight)

    async def off_loop(self, question: Question, work: Work[T], request: Request) -> T:
        """Have heavy work done for a request, its body read, see `BoundedExecutor.run`.

        Raises
        ------
        InvalidArgumentError
            At once, if the question is out of range.
        """
        question.check()
        await self.kernels.wait()
        return await self.executor.run(work, request)

    async def reading(self, work: Callable[[], T], large: bool = False) -> T:
        """Have files and bodies read: this does not wait behind heavy work. Large bodies are read one at a time."""
        return await anyio.to_thread.run_sync(work, limiter=self.reader_of_large if large else self.reader)


async def _service(request: Request) -> Service:  # async: a plain function would cost a thread hop per request
    found: Service = request.app.state.service
    return found


ServiceDep = Annotated[Service, Depends(_service)]
