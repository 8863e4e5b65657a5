"""Prometheus metrics: /metrics."""

from __future__ import annotations

from functools import cache

from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.process_collector import ProcessCollector

from rocking_api.execution.executor import BoundedExecutor

CONTENT_TYPE = CONTENT_TYPE_LATEST

BUCKETS = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0)
"""Bucket bounds of the latency [s]: a point takes a millisecond, a batch a second, a curve several."""


class Metrics:
    """Metrics of one application.

    Parameters
    ----------
    executor : BoundedExecutor
        Executor whose running and waiting requests are reported.
    """

    def __init__(self, executor: BoundedExecutor) -> None:
        self.registry = CollectorRegistry()
        self._requests = Counter(
            "rocking_requests", "Requests answered.", ["method", "route", "status"], registry=self.registry
        )
        self._seconds = Histogram(
            "rocking_request_seconds",
            "Time from the headers of the request to the last byte of the response.",
            ["route"],
            buckets=BUCKETS,
            registry=self.registry,
        )
        self._request = cache(self._requests.labels)  # looking labels up costs more than counting
        self._time = cache(self._seconds.labels)
        self._points = Counter(
            "rocking_points", "Blocks computed, by a data set or by the solver.", ["source"], registry=self.registry
        )
        self._source = cache(self._points.labels)
        running = Gauge("rocking_heavy_running", "Requests of heavy work being computed.", registry=self.registry)
        waiting = Gauge("rocking_heavy_waiting", "Requests of heavy work that wait.", registry=self.registry)
        running.set_function(lambda: executor.running)
        waiting.set_function(lambda: executor.waiting)
        ProcessCollector(registry=self.registry)  # memory, processor time, open files

    def request(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a request; `route` is its pattern, so that names of data sets do not create time series."""
        self._request(method, route, status).inc()
        self._time(route).observe(seconds)

    def points(self, source: str, count: int) -> None:
        """Count blocks by source, "cube" or "solver"."""
        if count:
            self._source(source).inc(count)

    def text(self) -> bytes:
        """In the text format of Prometheus."""
        return generate_latest(self.registry)
