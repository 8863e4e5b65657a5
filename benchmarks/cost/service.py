"""Load on the service: `python -m benchmarks.cost.service [--results FOLDER] [--workers 2]`.

Measured are the start, requests for one block, one after the other on one connection, batches of a thousand to a
million blocks in binary, and the memory of all processes, pages that several share counted once (PSS). One worker is
bound to the first core, the client to the last; several workers share all cores with it. The blocks are random: 1/a
0.05 to 0.95, omega 0.5 to 12, restitution 0.85.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from benchmarks.measure import arguments, finish, progress, spread, versions

SERVER = "import os; os.sched_setaffinity(0, %s); from rocking._cli.app import app; app()"
POINT = "/v1/response?pulse={}&restitution=0.85&alpha_deg={:g}&slenderness=%.9f&frequency_ratio=%.9f"


class Service:
    """A running service."""

    def __init__(self, process: subprocess.Popen[bytes], port: int) -> None:
        self.process = process
        self.connection = HTTPConnection("127.0.0.1", port, timeout=300)

    def ask(self, path: str, body: bytes | None = None, media_type: str = "application/json") -> bytes:
        """GET, or POST with a body."""
        self.connection.request("POST" if body else "GET", path, body, {"Content-Type": media_type})
        answer = self.connection.getresponse()
        content = answer.read()
        if answer.status != 200:
            raise SystemExit(content.decode())
        return content

    def processes(self) -> list[Path]:
        """The folders in /proc of the main process and its workers."""
        main = Path(f"/proc/{self.process.pid}")
        return [main, *(main.with_name(child) for child in (main / f"task/{main.name}/children").read_text().split())]

    def memory(self) -> dict[str, float]:
        """Memory of all processes now, and the most that one has had [MB]."""
        now, most = (
            [int(re.findall(rf"{key}:\s+(\d+) kB", (one / file).read_text())[0]) / 1e3 for one in self.processes()]
            for key, file in (("Pss", "smaps_rollup"), ("VmHWM", "status"))
        )
        return {"now_MB": sum(now), "most_MB": max(most)}

    def processor_seconds(self) -> float:
        """Processor time of all processes so far [s]."""
        rows = [(one / "stat").read_text().rpartition(")")[2].split() for one in self.processes()]
        return sum(int(row[11]) + int(row[12]) for row in rows) / os.sysconf("SC_CLK_TCK")


@contextmanager
def service(results: Path, workers: int, point: str) -> Iterator[tuple[Service, dict[str, float]]]:
    """A service, and how long it took to listen and to give a first answer [s]."""
    cores = sorted(os.sched_getaffinity(0))
    server = SERVER % ({cores[0]} if workers == 1 else {*cores})
    options = ["--port", "0", "--results", str(results), "--workers", str(workers)]
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        began = time.perf_counter()
        command = [sys.executable, "-c", server, "serve", *options]
        with log.open("wb") as output, subprocess.Popen(command, stdout=output, stderr=output) as process:
            try:
                while not (listening := re.search(rb"running on http://127\.0\.0\.1:(\d+)", log.read_bytes())):
                    if process.poll() is not None:
                        raise SystemExit(log.read_text())
                    time.sleep(0.005)
                one = Service(process, int(listening[1]))
                started = time.perf_counter() - began
                os.sched_setaffinity(0, {cores[-1]} if workers == 1 else {*cores})
                one.ask(point % (0.6, 6.0))
                yield one, {"listens_s": started, "first_answer_s": time.perf_counter() - began}
            finally:
                process.terminate()
                process.wait(60)


def load(one: Service, path: str, seconds: float) -> dict[str, float]:
    """Ask for single blocks for some seconds; each has other groups, so that no response comes from a cache."""
    blocks = zip(*random_blocks(100_000).values(), strict=True)
    times, before, end = [], one.processor_seconds(), time.perf_counter() + seconds
    while (began := time.perf_counter()) < end:
        one.ask(path % next(blocks))
        times.append(1e3 * (time.perf_counter() - began))
    return {
        "questions": len(times),
        "per_second": len(times) / seconds,
        "median_ms": float(np.median(times)),
        "p99_ms": float(np.quantile(times, 0.99)),
        "processor_ms": 1e3 * (one.processor_seconds() - before) / len(times),
    }


def batches(one: Service, groups: dict[str, Any], sizes: list[int], rounds: int) -> list[dict[str, Any]]:
    """Time of batches of several sizes [points], from the first byte sent to the last received [s]."""
    path = "/v1/response?" + "&".join(f"{name}={value}" for name, value in groups.items())
    times: dict[int, list[float]] = {points: [] for points in sizes}
    for _ in range(rounds):
        for points in sizes:
            blocks = xr.Dataset({name: ("point", values) for name, values in random_blocks(points).items()})
            body = bytes(blocks.to_netcdf(engine="scipy"))
            began = time.perf_counter()
            one.ask(path, body, "application/x-netcdf")
            times[points].append(time.perf_counter() - began)
    return [{"points": points, "seconds": spread(times[points])} for points in sizes]


def random_blocks(points: int) -> dict[str, np.ndarray[Any, Any]]:
    """Return groups of random blocks (points,)."""
    random = np.random.default_rng(points)
    omega = np.exp(random.uniform(np.log(0.5), np.log(12.0), points))
    return {"slenderness": random.uniform(0.05, 0.95, points), "frequency_ratio": omega}


def main(command_line: list[str] | None = None) -> None:
    """Measure, print, write the record; `--seconds` of each load, `--rounds` of the batches."""
    asked = arguments(
        __doc__, command_line, results=Path("results"), pulse="sine", alpha_deg=0.0, workers=1, seconds=5.0,
        points=[1_000, 10_000, 100_000, 1_000_000], rounds=3,
        out=Path("results/benchmarks/service.json"),
    )  # fmt: skip
    groups = {"pulse": asked.pulse, "restitution": 0.85, "alpha_deg": asked.alpha_deg}
    point = POINT.format(asked.pulse, asked.alpha_deg)
    names = versions("rocking", "fastapi", "uvicorn", "uvloop", "httptools", "numpy")
    record: dict[str, Any] = {"versions": names, "workers": asked.workers}
    with service(asked.results, asked.workers, point) as (one, start):
        record |= {"start": start, "memory": {"at first": one.memory()}}
        progress("single blocks")
        record["points"] = load(one, point, asked.seconds)
        record["memory"]["after points"] = one.memory()
        progress("batches")
        record["batches"] = batches(one, groups, asked.points, asked.rounds)
        some = {name: values.tolist() for name, values in random_blocks(500).items()}
        answer = json.loads(one.ask("/v1/response", json.dumps(groups | some).encode()))
        record["share_by_data_sets"] = answer["source"].count("cube") / len(answer["source"])
        record["memory"]["after batches"] = one.memory()
    finish(record, asked.out, table)


def table(record: dict[str, Any]) -> str:
    """All of it as tables."""
    parts = {
        "start": pd.DataFrame([record["start"]]),
        "requests for one block": pd.DataFrame([record["points"]]),
        "batches": pd.json_normalize(record["batches"]),
        "memory": pd.DataFrame(record["memory"]).T,
    }
    shown = [f"{title}\n{part.to_string(float_format='{:.4g}'.format)}" for title, part in parts.items()]
    return "\n\n".join([*shown, f"by data sets {100 * record['share_by_data_sets']:.1f} %, the rest by the solver"])


if __name__ == "__main__":
    main()
