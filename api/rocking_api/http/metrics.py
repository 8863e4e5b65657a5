"""Counts and times for Prometheus: /metrics."""

from __future__ import annotations

from functools import cache

from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.process_collector import ProcessCollector

from rocking_api.execution.executor import BoundedExecutor

CONTENT_TYPE = CONTENT_TYPE_LATEST

BUCKETS = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0)
"""Upper ends of the classes of latency [s]: a point takes a millisecond, a batch a second, a curve some."""


class Metrics:
    """What one application has done since it began.

    Parameters
    ----------
    executor : BoundedExecutor
        Whose running and waiting requests are told.
    """

    def __init__(self, executor: BoundedExecutor) -> None:
        self.registry = CollectorRegistry()
        self._requests = Counter(
            "rocking_requests", "Requests answered.", ["method", "route", "status"], registry=self.registry
        )
        self._seconds = Histogram(
            "rocking_request_seconds",
            "Time from the request's headers to the last byte of the answer.",
            ["route"],
            buckets=BUCKETS,
            registry=self.registry,
        )
        self._request = cache(self._requests.labels)  # to find them again costs more than to count
        self._time = cache(self._seconds.labels)
        self._points = Counter(
            "rocking_points", "Blocks answered, by a data set or by the solver.", ["source"], registry=self.registry
        )
        running = Gauge("rocking_heavy_running", "Requests of heavy work that are worked on.", registry=self.registry)
        waiting = Gauge("rocking_heavy_waiting", "Requests of heavy work that wait.", registry=self.registry)
        running.set_function(lambda: executor.running)
        waiting.set_function(lambda: executor.waiting)
        ProcessCollector(registry=self.registry)  # memory, processor time, open files

    def request(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a request; `route` is its pattern, so that names of data sets do not make series of their own."""
        self._request(method, route, status).inc()
        self._time(route).observe(seconds)

    def points(self, source: str, count: int) -> None:
        """Count blocks that "cube" or "solver" answered."""
        if count:
            self._points.labels(source).inc(count)

    def text(self) -> bytes:
        """In Prometheus' text format."""
        return generate_latest(self.registry)
