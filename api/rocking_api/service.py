"""State shared by the routes: settings, data sets, threads."""

from __future__ import annotations

from typing import Annotated, TypeVar

from fastapi import Depends, Request
from starlette.staticfiles import StaticFiles

from rocking._lookup.collection import CubeCollection
from rocking_api.dataset_checker import DatasetChecker
from rocking_api.dataset_summaries import DatasetSummaries
from rocking_api.execution.helper import Helper
from rocking_api.execution.kernels import Kernels
from rocking_api.execution.work import Work, Workers
from rocking_api.settings import Settings
from rocking_api.suite_reader import SuiteReader

T = TypeVar("T")

CHEAP_BYTES = 100_000
"""Size of a body up to which a request is cheap [bytes]: it is read in some hundredths of a second."""

CHEAP_THREADS = 8  # cheap requests at a time [-]

SEARCH_SHARE = 0.2  # share of the time limit for the search along one line [-]


class Service:
    """One per application, made in `create_app`."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.cubes = CubeCollection(settings.results)
        self.files = StaticFiles(directory=settings.results, check_dir=False)
        self.kernels = Kernels(settings.max_seconds)
        self.cheap = Workers(CHEAP_THREADS, settings.max_connections, settings.max_seconds)
        self.dear = Workers(settings.max_workers, settings.max_queue, settings.max_seconds)
        self.helper = Helper()
        self.dataset_checker = DatasetChecker(self.cubes)
        self.summaries = DatasetSummaries(self.cubes.catalogue)
        self.suites = SuiteReader(self.cubes.catalogue)

    async def solve(self, work: Work[T], request: Request) -> T:
        """Run dear work of the solver in a thread, once it is loaded."""
        await self.kernels.wait()
        return await self.dear.run(work, request)

    async def solve_one(self, work: Work[T], request: Request) -> T:
        """The same for what concerns one body or a table: cheap work unless the body of the request is large."""
        await self.kernels.wait()
        return await self.read_body(work, request)

    async def read_body(self, work: Work[T], request: Request) -> T:
        """Run work that needs no solver in a thread: cheap unless the body of the request is large."""
        declared = request.headers.get("content-length", "0" if request.method == "GET" else "")
        is_small = declared.isdecimal() and int(declared[:12]) <= CHEAP_BYTES
        return await (self.cheap if is_small else self.dear).run(work, request)

    async def read(self, work: Work[T], request: Request | None = None) -> T:
        """Read files of the service in a thread."""
        return await self.cheap.run(work, request)


async def _service(request: Request) -> Service:  # async: FastAPI would run a plain function in a thread
    service: Service = request.app.state.service
    return service


ServiceDep = Annotated[Service, Depends(_service)]
