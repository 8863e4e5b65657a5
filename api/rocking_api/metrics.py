"""Prometheus metrics: /metrics.

With several workers each counts into files of a folder (`PROMETHEUS_MULTIPROC_DIR`, see prometheus_client), and the one
that is asked adds them up.
"""

from __future__ import annotations

import os
import threading
from functools import cache

from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.multiprocess import MultiProcessCollector, mark_process_dead
from prometheus_client.process_collector import ProcessCollector

from rocking_api.execution.executor import BoundedExecutor

CONTENT_TYPE = CONTENT_TYPE_LATEST

BUCKETS = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0)
"""Bucket bounds of the latency [s]: a point takes a millisecond, a batch a second, a curve several."""

FOLDER = "PROMETHEUS_MULTIPROC_DIR"  # environment variable with the folder of the metrics of several workers


class Metrics:
    """Metrics of one application."""

    def __init__(self) -> None:
        own = self.registry = CollectorRegistry()
        labels = ["method", "route", "status"]
        about = "Time from the headers of the request to the last byte of the response."
        points = Counter("rocking_points", "Blocks computed, by a data set or by the solver.", ["source"], registry=own)
        # looking labels up costs more than counting
        self._request = cache(Counter("rocking_requests", "Requests answered.", labels, registry=own).labels)
        self._time = cache(Histogram("rocking_request_seconds", about, ["route"], buckets=BUCKETS, registry=own).labels)
        self._source = cache(points.labels)
        self._running, self._waiting = (
            Gauge(f"rocking_heavy_{name}", f"Requests of heavy work {text}.", registry=own, multiprocess_mode="livesum")
            for name, text in [("running", "being computed"), ("waiting", "that wait")]
        )
        self._heavy_lock = threading.Lock()
        self._damaged = Gauge(
            "rocking_dataset_damaged",
            "1 for a data set or folder that exists and cannot be used, 0 once it is repaired.",
            ["dataset"],
            registry=own,
            multiprocess_mode="mostrecent",
        )
        ProcessCollector(registry=own)  # memory, processor time, open files
        self._all_workers: CollectorRegistry | None = None
        if FOLDER in os.environ:
            self._all_workers = CollectorRegistry()
            MultiProcessCollector(self._all_workers)  # type: ignore[no-untyped-call]
            ProcessCollector(registry=self._all_workers)  # of the one that answers

    def request(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a request; `route` is its pattern, so that names of data sets do not create time series."""
        self._request(method, route, status).inc()
        self._time(route).observe(seconds)

    def points(self, source: str, count: int) -> None:
        """Count blocks by source, "cube" or "solver"."""
        if count:
            self._source(source).inc(count)

    def heavy(self, executor: BoundedExecutor) -> None:
        """Report the running and waiting requests of an executor; may be called by any thread."""
        with self._heavy_lock:  # the last call reports the last state
            self._running.set(executor.running)
            self._waiting.set(executor.waiting)

    def damaged(self, name: str, is_damaged: bool) -> None:
        """Report whether a data set is damaged."""
        self._damaged.labels(name).set(is_damaged)

    def text(self) -> bytes:
        """In the text format of Prometheus; with several workers the counts of all."""
        return generate_latest(self._all_workers or self.registry)

    def close(self) -> None:
        """Remove what a worker that ends has reported of its present state; its counts are kept."""
        if self._all_workers is not None:
            mark_process_dead(os.getpid())  # type: ignore[no-untyped-call]
