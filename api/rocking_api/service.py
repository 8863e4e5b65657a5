"""State shared by the routes: settings, data sets, metrics, executors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, TypeVar

import anyio
import anyio.to_thread
from anyio import CapacityLimiter
from fastapi import Depends, Request

from rocking._lookup.collection import CubeCollection
from rocking._numba.cancellation import StopFlag
from rocking_api.dataset_checker import DatasetChecker
from rocking_api.dataset_summaries import DatasetSummaries
from rocking_api.execution.executor import BoundedExecutor, Work
from rocking_api.execution.kernels import Kernels
from rocking_api.http.body import MemoryBudget, Reservation, limited_body
from rocking_api.http.encoding import Form
from rocking_api.http.parameters import check_json, query_parameters, read_json, read_query
from rocking_api.metrics import Metrics
from rocking_api.models.params import Params
from rocking_api.models.pulses import options_of
from rocking_api.settings import Settings
from rocking_api.suite_reader import SuiteReader
from rocking_api.zarr_store import ZarrStores

B = TypeVar("B", bound=Params)
P = TypeVar("P", bound=Params)
T = TypeVar("T")

LARGE_BODY = 1_000_000
"""Bytes beyond which bodies are parsed one at a time. Smaller ones take some hundredths of a second."""

SEARCH_SHARE = 0.2  # share of the time limit for the search along one line [-]


class Service:
    """One per application, made in `create_app`."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        queue, seconds = settings.max_queue, settings.max_seconds
        self.cubes = CubeCollection(settings.results)
        self.zarr_stores = ZarrStores(self.cubes.catalogue)
        self.kernels = Kernels(seconds)
        self.metrics = Metrics()
        # a separate thread: requests for one block do not wait for heavy work
        self.single = BoundedExecutor(1, settings.max_connections, seconds)
        self.executor = BoundedExecutor(settings.max_workers, queue, seconds, self.metrics.heavy, trials=True)
        self.parser = BoundedExecutor(1, queue, seconds, trials=True)
        self.dataset_checker = DatasetChecker(self.cubes, self.metrics.damaged)
        self.summaries = DatasetSummaries(self.cubes.catalogue)
        self.suites = SuiteReader(self.cubes.catalogue)
        self.io_limiter = CapacityLimiter(settings.max_workers)
        self.memory_budget = MemoryBudget(settings.max_bytes_in_flight)
        self.turns = anyio.Lock()

    async def run_heavy(self, work: Work[T], request: Request) -> T:
        """Run heavy work for a request whose body was read, see `BoundedExecutor.run`."""
        await self.kernels.wait()
        return await self.executor.run(work, request, self.reservation(request).held)

    async def read_body(self, request: Request, limit: int, hint: str = "") -> bytes:
        """The body of a request, of at most `limit` bytes, see `limited_body`; `hint` is for larger ones."""
        allowed = limit, f"at most {limit} bytes{hint}"
        reservation = self.reservation(request)
        return await limited_body(request, allowed, self.settings.arrival_seconds, reservation, self.turns)

    def reservation(self, request: Request) -> Reservation:
        """The memory that is held for a request until its end."""
        if not hasattr(request.state, "reservation"):
            request.state.reservation = Reservation(self.memory_budget)
        found: Reservation = request.state.reservation
        return found

    async def read(
        self, request: Request, kind: type[P], form: Form, body: type[B], limit: int, hint: str = ""
    ) -> tuple[P, B | bytes]:
        """The parameters of a request, and its content: an object of JSON, or a file or list as it is.

        An object of JSON is read as `body`, which has the fields of `kind`; these may be in the query as well. Beside a
        file or a list they are in the query.
        """
        query = query_parameters(request)
        raw = await self.read_body(request, limit, hint)
        if form != "json" or (body.takes_lists and raw.lstrip()[:1] != b"{"):
            if form == "json":
                await self.run_parser(lambda stop: check_json(raw, stop), request)
            return read_query(kind, query), raw

        def parse(stop: StopFlag) -> tuple[P, B | bytes]:
            found = read_json(body, raw, query, kind, stop)
            return options_of(found, kind), found

        return await self.run_parser(parse, request)

    async def run_parser(self, work: Work[T], request: Request, large: bool = False, *, in_process: bool = False) -> T:
        """Parse a body in a thread; large bodies in a queue of their own, the smallest first.

        Those that a process of its own reads, `in_process`, follow after them; see `BoundedExecutor.run`.
        """
        held = self.reservation(request).held
        if large or in_process or held > LARGE_BODY:
            return await self.parser.run(work, request, held, is_long=in_process)
        return await self.run_io(lambda: work(StopFlag()))

    async def run_io(self, work: Callable[[], T]) -> T:
        """Read files and parse small bodies in a thread, independent of heavy work."""
        return await anyio.to_thread.run_sync(work, limiter=self.io_limiter)


async def _service(request: Request) -> Service:  # async: FastAPI would run a plain function in a thread
    found: Service = request.app.state.service
    return found


ServiceDep = Annotated[Service, Depends(_service)]
